#include "mixed_reality/replay/deviation.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::mixed_reality {

void Deviation::note(hal::Tick tick, const core::Pose& a, const core::Pose& b) {
  const double rad = std::atan2(a.sin_h * b.cos_h - a.cos_h * b.sin_h, a.cos_h * b.cos_h + a.sin_h * b.sin_h);
  all_.push_back({tick, std::hypot(a.x_m - b.x_m, a.y_m - b.y_m, a.z_m - b.z_m), rad});
}

double Deviation::rms_m() const noexcept {
  double sum = 0.0;
  for (const At& at : all_) sum += at.m * at.m;
  return all_.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(all_.size()));
}

double Deviation::rms_rad() const noexcept {
  double sum = 0.0;
  for (const At& at : all_) sum += at.rad * at.rad;
  return all_.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(all_.size()));
}

double Deviation::max_m() const noexcept {
  double most = 0.0;
  for (const At& at : all_) most = std::max(most, at.m);
  return most;
}

double Deviation::max_within_m(hal::Tick ticks) const noexcept {
  double most = 0.0;
  for (const At& at : all_) {
    if (at.tick < all_.front().tick + ticks) most = std::max(most, at.m);
  }
  return most;
}

hal::Json Deviation::json(std::int64_t ticks_per_second) const {
  hal::Json every = hal::Json::array();
  hal::Tick max_at = 0;
  double most = -1.0;
  for (const At& at : all_) {
    if ((at.tick - all_.front().tick) % ticks_per_second == 0) every.push_back(at.m);
    if (at.m <= most) continue;
    most = at.m;
    max_at = at.tick;
  }
  return {{"robot", robot_},  {"ticks", all_.size()},  {"rms_m", rms_m()},   {"rms_rad", rms_rad()},
          {"max_m", max_m()}, {"max_at_tick", max_at}, {"last_m", last_m()}, {"every_second_m", std::move(every)}};
}

}  // namespace tandem::mixed_reality
