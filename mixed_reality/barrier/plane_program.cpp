#include "mixed_reality/barrier/plane_program.hpp"

#include <cmath>
#include <limits>

namespace tandem::mixed_reality {
namespace {

constexpr double kSlack = 1e-9;
constexpr double kParallel = 1e-9;

}  // namespace

void PlaneProgram::add(double a_x, double a_y, double b) noexcept {
  if (count_ == kMost) {
    full_ = true;
    return;
  }
  bounds_[count_++] = {a_x, a_y, b > 0.0 ? b : 0.0};
}

bool PlaneProgram::allows(double x, double y) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (!(bounds_[i].a_x * x + bounds_[i].a_y * y <= bounds_[i].b + kSlack)) return false;
  }
  return true;
}

std::array<double, 2> PlaneProgram::nearest(double x, double y) const noexcept {
  if (full_ || !std::isfinite(x) || !std::isfinite(y)) return {};
  if (allows(x, y)) return {x, y};
  std::array<double, 2> best{};
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double at_x, double at_y) {
    const double off = (at_x - x) * (at_x - x) + (at_y - y) * (at_y - y);
    if (!(off < least) || !allows(at_x, at_y)) return;
    least = off;
    best = {at_x, at_y};
  };
  consider(0.0, 0.0);
  for (std::size_t i = 0; i < count_; ++i) {
    const Bound& p = bounds_[i];
    const double beyond = p.a_x * x + p.a_y * y - p.b;
    if (beyond > 0.0) consider(x - beyond * p.a_x, y - beyond * p.a_y);
    for (std::size_t k = i + 1; k < count_; ++k) {
      const Bound& q = bounds_[k];
      const double det = p.a_x * q.a_y - p.a_y * q.a_x;
      if (std::fabs(det) < kParallel) continue;
      consider((p.b * q.a_y - q.b * p.a_y) / det, (p.a_x * q.b - q.a_x * p.b) / det);
    }
  }
  return best;
}

}  // namespace tandem::mixed_reality
