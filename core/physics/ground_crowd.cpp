#include "core/physics/ground_crowd.hpp"

#include <algorithm>
#include <cmath>

#include "core/physics/walls.hpp"
#include "core/space/object_index.hpp"

namespace tandem::core {
namespace {

constexpr double kTouch_m = 2.5e-4;  // how deep a robot stays in what it is pushed out of: solvers see that they touch

constexpr double kUpright = 0.02;  // components of the attitude across the axis of one that leans by 2 degrees

bool stands(const SpaceStores& stores, std::size_t row) noexcept {
  const Bodies& b = stores.bodies;
  if ((b.flags[row] & kAlive) == 0 || stores.kind_of_row(row).flies()) return false;
  if (!std::isfinite(b.x_m[row] + b.y_m[row] + stores.base_m(row))) return false;
  if (b.motion.empty()) return true;
  const auto& q_WB = b.motion[row].q_WB;
  return std::fabs(q_WB[1]) + std::fabs(q_WB[2]) < kUpright;
}

}  // namespace

void GroundCrowd::moves(std::size_t region) {
  mine_.resize(std::max(mine_.size(), region + 1), 0);
  mine_[region] = 1;
}

void GroundCrowd::start(const SpaceStores& stores) {
  const Bodies& b = stores.bodies;
  start_x_m_.assign(b.x_m.begin(), b.x_m.end());
  start_y_m_.assign(b.y_m.begin(), b.y_m.end());
  if (firm_.capacity() >= b.size()) return;
  for (auto* a : {&row_, &near_others_}) a->reserve(b.size());
  for (auto* a : {&x_m_, &y_m_, &z_m_, &radius_m_, &height_m_, &slack_m_, &push_x_m_, &push_y_m_}) a->reserve(b.size());
  firm_.reserve(b.size());
  pairs_.reserve(b.size());
  crowd_.reserve(b.size());
}

double GroundCrowd::overlap_at_borders(const SpaceStores& stores) {
  row_.clear();
  for (std::size_t region = 0; region < mine_.size(); ++region) {
    if (mine_[region] == 0) continue;
    for (const BodyKey key : stores.regions[region].mirrored) {
      if (!key.is_object() && stands(stores, key.index())) row_.push_back(static_cast<std::uint32_t>(key.index()));
    }
  }
  if (row_.empty()) return 0.0;
  std::sort(row_.begin(), row_.end());
  row_.erase(std::unique(row_.begin(), row_.end()), row_.end());
  gather(stores);
  std::fill(slack_m_.begin(), slack_m_.end(), 0.0);
  pairs_.find({x_m_, y_m_, z_m_, radius_m_, height_m_, slack_m_});
  double deepest = 0.0;
  for (std::uint32_t i = 0; i < row_.size(); ++i) {
    for (const std::uint32_t k : pairs_.of(i)) deepest = std::max(deepest, overlap(stores, i, k));
  }
  return deepest;
}

double GroundCrowd::settle(SpaceStores& stores) {
  row_.clear();
  for (std::size_t row = 0; row < stores.bodies.size(); ++row) {
    if (stands(stores, row)) row_.push_back(static_cast<std::uint32_t>(row));
  }
  gather(stores);
  hold_joined(stores);
  const double left = crowd_.settle(
      row_.size(), [&](bool back) -> const std::vector<std::uint32_t>& { return find(back); },
      [&](const std::vector<std::uint32_t>& who) { push(stores, who); },
      [&](const std::vector<std::uint32_t>& who) { return move(stores, who); },
      [&](std::uint32_t i, double share) {
        if (firm_[i] != 0) return;
        const double x_m = start_x_m_[row_[i]];
        const double y_m = start_y_m_[row_[i]];
        x_m_[i] = x_m + share * (x_m_[i] - x_m);
        y_m_[i] = y_m + share * (y_m_[i] - y_m);
      },
      [&](std::uint32_t i) { return pairs_.of(i); });
  write_back(stores);
  return left;
}

/// Reads the robots of `row_`.
void GroundCrowd::gather(const SpaceStores& stores) {
  const Bodies& b = stores.bodies;
  const std::size_t n = row_.size();
  firm_.resize(n);
  for (auto* a : {&x_m_, &y_m_, &z_m_, &radius_m_, &height_m_, &slack_m_, &push_x_m_, &push_y_m_}) a->resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::uint32_t row = row_[i];
    x_m_[i] = b.x_m[row];
    y_m_[i] = b.y_m[row];
    z_m_[i] = stores.base_m(row);
    radius_m_[i] = static_cast<double>(b.radius_m[row]);
    height_m_[i] = stores.kind_of_row(row).body.height_m;
    const std::uint16_t region = b.region[row];
    firm_[i] = region >= mine_.size() || mine_[region] == 0 || stores.led_or_held(row) ? 1 : 0;
  }
}

void GroundCrowd::hold_joined(const SpaceStores& stores) {
  for (const Joint& joint : stores.joints) {
    if (!joint.alive) continue;
    for (const BodyKey body : {joint.a, joint.b}) {
      const auto found = std::lower_bound(row_.begin(), row_.end(), static_cast<std::uint32_t>(body.index()));
      if (!body.is_object() && found != row_.end() && *found == body.index())
        firm_[static_cast<std::size_t>(found - row_.begin())] = 1;
    }
  }
}

/// Those that give no way are among them: how deep others are in them counts.
const std::vector<std::uint32_t>& GroundCrowd::find(bool back) {
  for (std::size_t i = 0; i < row_.size(); ++i)
    slack_m_[i] =
        CrowdPasses::kSlack_m + (back ? std::hypot(x_m_[i] - start_x_m_[row_[i]], y_m_[i] - start_y_m_[row_[i]]) : 0.0);
  pairs_.find({x_m_, y_m_, z_m_, radius_m_, height_m_, slack_m_});
  near_others_.clear();
  for (std::uint32_t i = 0; i < row_.size(); ++i) {
    if (!pairs_.of(i).empty()) near_others_.push_back(i);
  }
  return near_others_;
}

/// Of two robots, in parts of the narrower one's diameter; 0 where neither is in the other's way.
double GroundCrowd::overlap(const SpaceStores& stores, std::uint32_t i, std::uint32_t k) const {
  const double dx = x_m_[i] - x_m_[k];
  const double dy = y_m_[i] - y_m_[k];
  const double touch = radius_m_[i] + radius_m_[k];
  const double d2 = dx * dx + dy * dy;
  if (d2 >= touch * touch || (!stores.bodies.motion.empty() && !stores.side_by_side(row_[i], row_[k]))) return 0.0;
  return CrowdPasses::overlap(touch - std::sqrt(d2), radius_m_[i], radius_m_[k]);
}

void GroundCrowd::push(const SpaceStores& stores, const std::vector<std::uint32_t>& who) {
  for (const std::uint32_t i : who) {
    push_x_m_[i] = push_y_m_[i] = 0.0;
    for (const std::uint32_t k : pairs_.of(i)) {
      const double deep = overlap(stores, i, k);
      if (deep == 0.0) continue;
      crowd_.note(i, deep);
      const double dx = x_m_[i] - x_m_[k];
      const double dy = y_m_[i] - y_m_[k];
      const double d = std::hypot(dx, dy);
      const double share = (radius_m_[i] + radius_m_[k] - d) * (firm_[k] != 0 ? 1.0 : 0.5);
      push_x_m_[i] += d > 0.0 ? dx / d * share : (i < k ? -share : share);  // two on one spot part along x
      push_y_m_[i] += d > 0.0 ? dy / d * share : 0.0;
    }
  }
}

/// @returns the longest way.
double GroundCrowd::move(const SpaceStores& stores, const std::vector<std::uint32_t>& who) {
  double longest_m = 0.0;
  for (const std::uint32_t i : who) {
    if (firm_[i] != 0 || (push_x_m_[i] == 0.0 && push_y_m_[i] == 0.0)) continue;
    const double x_m = x_m_[i];
    const double y_m = y_m_[i];
    x_m_[i] += push_x_m_[i];
    y_m_[i] += push_y_m_[i];
    leave_objects(stores, i);
    const auto [wx, wy] = out_of_walls(stores.regions[stores.bodies.region[row_[i]]], x_m_[i], y_m_[i], radius_m_[i]);
    x_m_[i] += wx;
    y_m_[i] += wy;
    longest_m = std::max(longest_m, std::hypot(x_m_[i] - x_m, y_m_[i] - y_m));
  }
  return longest_m;
}

/// Objects come after robots, and always win. What a robot stands on or under is not in its way.
void GroundCrowd::leave_objects(const SpaceStores& stores, std::uint32_t i) {
  stores.for_each_object_near(x_m_[i], y_m_[i], [&](const Object& object) {
    if (!plane_ && (object.z_high_m <= z_m_[i] + kTouch_m || object.z_low_m >= z_m_[i] + height_m_[i])) return;
    double nx = 0.0;
    double ny = 0.0;
    const double gap_m = signed_distance(object, x_m_[i], y_m_[i], nx, ny) - radius_m_[i] + kTouch_m;
    if (gap_m >= 0.0) return;
    x_m_[i] -= nx * gap_m;
    y_m_[i] -= ny * gap_m;
  });
}

void GroundCrowd::write_back(SpaceStores& stores) const {
  for (std::size_t i = 0; i < row_.size(); ++i) {
    if (firm_[i] != 0) continue;
    stores.bodies.x_m[row_[i]] = x_m_[i];
    stores.bodies.y_m[row_[i]] = y_m_[i];
  }
}

}  // namespace tandem::core
