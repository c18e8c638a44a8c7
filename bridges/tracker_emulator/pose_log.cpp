#include "bridges/tracker_emulator/pose_log.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hal/json/json.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::bridges::tracker_emulator {
namespace {

constexpr hal::TimeNs kKept_ns = 10 * hal::kNsPerSecond;

}  // namespace

void PoseLog::follow() {
  if (!file_.is_open()) file_.open(path_);
  if (!file_.is_open()) return;
  std::array<char, 16384> read;
  for (;;) {
    file_.clear();
    file_.read(read.data(), read.size());
    const std::streamsize count = file_.gcount();
    if (count <= 0) return;
    for (std::streamsize i = 0; i < count; ++i) {
      const char c = read[static_cast<std::size_t>(i)];
      if (c != '\n') {
        line_ += c;
        continue;
      }
      take(line_);
      line_.clear();
    }
  }
}

void PoseLog::take(const std::string& line) {
  if (line.find("\"event\":\"pose\"") == std::string::npos) return;
  const auto parsed = hal::parse_json_object(line);
  if (!parsed.ok()) return;
  const hal::Json& json = parsed.value();
  if (!json.contains("t_ns") || !json.contains("x_m") || !json.contains("y_m") || !json.contains("heading_rad")) return;
  const char* const when = json.contains("taken_t_ns") ? "taken_t_ns" : "t_ns";
  const TruePose pose{hal::whole_of(json, when), hal::number_of(json, "x_m"), hal::number_of(json, "y_m"),
                      hal::number_of(json, "heading_rad")};
  if (!poses_.empty() && pose.at_ns <= poses_.back().at_ns) return;
  if (!first_) first_ = pose;
  const bool rests = pose.x_m == first_->x_m && pose.y_m == first_->y_m && pose.heading_rad == first_->heading_rad;
  if (!rests && !first_moved_ns_) first_moved_ns_ = pose.at_ns;
  poses_.push_back(pose);
  while (poses_.front().at_ns < pose.at_ns - kKept_ns) poses_.pop_front();
}

std::optional<TruePose> PoseLog::at(hal::TimeNs time_ns) const {
  if (poses_.empty() || poses_.front().at_ns > time_ns) return {};
  const auto next = std::upper_bound(poses_.begin(), poses_.end(), time_ns,
                                     [](hal::TimeNs t, const TruePose& pose) { return t < pose.at_ns; });
  if (next == poses_.end()) return poses_.back();
  const TruePose& a = *std::prev(next);
  const TruePose& b = *next;
  const double part = static_cast<double>(time_ns - a.at_ns) / static_cast<double>(b.at_ns - a.at_ns);
  const double turn_rad = std::remainder(b.heading_rad - a.heading_rad, 2.0 * std::numbers::pi);
  return TruePose{time_ns, a.x_m + part * (b.x_m - a.x_m), a.y_m + part * (b.y_m - a.y_m),
                  a.heading_rad + part * turn_rad};
}

}  // namespace tandem::bridges::tracker_emulator
