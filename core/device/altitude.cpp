#include "core/device/altitude.hpp"

#include <algorithm>

#include "core/space/sight.hpp"

namespace tandem::core {
namespace {

constexpr double kWithin_m = 0.01;  // that bodies may be in one another
constexpr double kNoBottom_m = -1e9;

bool covers(const Object& o, double x_m, double y_m) noexcept {
  const double dx = x_m - o.x_m;
  const double dy = y_m - o.y_m;
  if (o.kind == Object::Kind::Cylinder) return dx * dx + dy * dy <= o.radius_m * o.radius_m;
  return std::fabs(o.cos_h * dx + o.sin_h * dy) <= o.half_x_m && std::fabs(o.cos_h * dy - o.sin_h * dx) <= o.half_y_m;
}

/// From a point straight up (1) or down (-1) to an object that leans; infinite: it is not there.
double straight_to(const SpaceStores& stores, const Object& o, const std::array<double, 3>& from_m,
                   double up) noexcept {
  return meets_at(o, attitude_of(o, turn_of(stores, o)), from_m, {0.0, 0.0, up});
}

/// Calls `see(low_m, high_m)` for every other body over or under the middle of this one.
template <class See>
void each_body_in_line(const SpaceStores& stores, std::size_t row, See&& see) noexcept {
  if (stores.body_index.size() == 0) return;  // before the first step
  const Bodies& b = stores.bodies;
  stores.body_index.for_each_near(b.x_m[row], b.y_m[row], widest_body_m(stores), [&](const IndexEntry& o) {
    const double dx = o.x_m - b.x_m[row];
    const double dy = o.y_m - b.y_m[row];
    const auto radius_m = static_cast<double>(o.radius_m);
    if (o.row() == row || dx * dx + dy * dy > radius_m * radius_m) return;
    const double low_m = stores.base_m(o.row());
    see(low_m, low_m + stores.kind_of_row(o.row()).body.height_m);
  });
}

/// Calls `use(z_m)` for what objects there are below (`upwards` -1) or above (1) a place of the row's body, at
/// `from_m`.
template <class Use>
void each_object_in_line(const SpaceStores& stores, std::size_t row, double from_m, double upwards, const Use& use) {
  if (stores.objects.empty()) return;
  const double x_m = stores.bodies.x_m[row], y_m = stores.bodies.y_m[row];
  const bool lean = anything_may_lean(stores);
  stores.for_each_object_near(x_m, y_m, [&](const Object& o) {
    if (!o.alive) return;
    if (lean && leans(turn_of(stores, o)))
      use(from_m + upwards * straight_to(stores, o, {x_m, y_m, from_m}, upwards));
    else if (covers(o, x_m, y_m))
      use(upwards < 0.0 ? o.z_high_m : o.z_low_m);
  });
}

}  // namespace

double ceiling_m(const SpaceStores& stores, std::size_t row) noexcept {
  const std::uint16_t region = stores.bodies.region[row];
  return region == kNoRegion ? stores.max_z_m : std::min(stores.max_z_m, stores.regions[region].top_m);
}

double room_below_m(const SpaceStores& stores, std::size_t row, bool bodies) noexcept {
  const double base_m = stores.base_m(row);
  const std::uint16_t region = stores.bodies.region[row];
  double highest_m = 0.0;
  if (region != kNoRegion && stores.regions[region].bottom_m > kNoBottom_m) highest_m = stores.regions[region].bottom_m;
  const auto consider = [&](double top_m) {
    if (top_m <= base_m + kWithin_m) highest_m = std::max(highest_m, top_m);
  };
  each_object_in_line(stores, row, base_m + kWithin_m, -1.0, consider);
  if (bodies) each_body_in_line(stores, row, [&](double, double high_m) { consider(high_m); });
  return std::max(0.0, base_m - highest_m);
}

double room_above_m(const SpaceStores& stores, std::size_t row) noexcept {
  const double top_m = stores.base_m(row) + stores.kind_of_row(row).body.height_m;
  double lowest_m = ceiling_m(stores, row);
  const auto consider = [&](double low_m) {
    if (low_m >= top_m - kWithin_m) lowest_m = std::min(lowest_m, low_m);
  };
  each_object_in_line(stores, row, top_m - kWithin_m, 1.0, consider);
  each_body_in_line(stores, row, [&](double low_m, double) { consider(low_m); });
  return std::max(0.0, lowest_m - top_m);
}

}  // namespace tandem::core
