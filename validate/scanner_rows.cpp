// Distance scanners against the ray caster: rays from the robot's axis, head by head and measurement by measurement.
#include <algorithm>
#include <cmath>

#include "core/sim/world.hpp"
#include "hal/device/distance_scanner.hpp"
#include "validate/compared.hpp"
#include "validate/sensor_tables.hpp"

namespace tandem::validate {
namespace {

constexpr double kGrown_m = 1e-7, kSame_m = 1e-6;
constexpr double kTurn_rad_s = 1.7, kTick_s = 0.1;
constexpr std::size_t kSamples = 6;  // of a head in a tick: 60 a second
constexpr double kHeight_m = 0.1232;

/// Heads look forward, left, back and right, and see short distances and long ones by turns.
struct Head {
  double bearing_rad, min_m, max_m;
};
constexpr std::array<Head, 4> kHeads = {
    {{0.0, 0.04, 0.30}, {M_PI / 2, 0.20, 1.50}, {M_PI, 0.04, 0.30}, {-M_PI / 2, 0.20, 1.50}}};

void compare(const core::Space& space, const Things& things, std::size_t i, double turned_before_rad,
             std::vector<Echo>& all) {
  const auto& read = *space.port<hal::DistanceScanner>(space.robot(i));
  const core::Pose pose = space.pose(space.robot(i));
  for (std::size_t head = 0; head < kHeads.size(); ++head)
    for (std::size_t k = 0; k < kSamples; ++k) {
      const Head& h = kHeads[head];
      const double at =
          turned_before_rad + kTurn_rad_s * kTick_s * static_cast<double>(k + 1) / kSamples + h.bearing_rad;
      const auto far = [&](const Solids& solids) {
        return std::clamp(cast(solids, pose.x_m, pose.y_m, kHeight_m, pose.heading_rad() + at, h.max_m, i + 1), h.min_m,
                          h.max_m);
      };
      const double is = far(things.exact);
      const std::size_t n = head * kSamples + k;
      all.push_back(
          {static_cast<double>(read.distance_m[n]), is,
           n < read.count ? std::abs(std::remainder(static_cast<double>(read.angle_rad[n]) - at, 2.0 * M_PI)) : NAN,
           std::abs(far(things.smaller) - far(things.larger)) > kSame_m, is > h.min_m + 0.02 && is < h.max_m - 0.02});
    }
}

}  // namespace

std::vector<Echo> echoes(const std::string& implementation, std::uint64_t seed, int ticks) {
  const auto opened = open_experiment("scanned.xml", seed, {{"{scanner}", implementation}});
  core::World& world = opened->world();
  core::Space& space = world.space();
  const auto step = [&] {
    for (std::size_t i = 0; i < space.robot_count(); ++i)
      space.port<hal::ScannerDrive>(space.robot(i))->turn(kTurn_rad_s);
    world.step();
  };
  step();
  step();
  const Things things(space, kGrown_m);
  std::vector<Echo> all;
  for (int tick = 0; tick < ticks; ++tick) {
    step();
    const double turned_rad = kTurn_rad_s * kTick_s * static_cast<double>(tick + 2);
    for (std::size_t i = 0; i < space.robot_count(); ++i) compare(space, things, i, turned_rad, all);
  }
  return all;
}

std::vector<Row> scanner_rows(Depth depth) {
  Compared distances, angles;
  for (std::uint64_t seed = 1; seed <= (depth == Depth::Short ? 2U : 10U); ++seed)
    for (const Echo& echo : echoes("ideal", seed, 10)) {
      angles.add(echo.off_rad, 1e-6);
      if (echo.edge)
        ++distances.edges;
      else
        distances.add(std::abs(echo.read_m - echo.is_m), kSame_m);
    }
  return {compared_row("distance scanner, foot-bot: distances", distances, 1e6, "µm", "at most 1 µm"),
          compared_row("distance scanner, foot-bot: angles at a steady turn", angles, 1e6, "µrad", "at most 1 µrad")};
}

}  // namespace tandem::validate
