// Sensors against a ray caster of its own, a lamp at a known distance, and the body's own motion.
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <stdexcept>

#include "core/sim/world.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "validate/compared.hpp"
#include "validate/parts.hpp"
#include "validate/sensor_tables.hpp"
#include "validate/standing.hpp"

namespace tandem::validate {
namespace {

constexpr double kGrown_m = 1e-7;  // rays that a solid so much larger or smaller would change pass by an edge
constexpr double kSame_m = 1e-6;   // largest difference of a distance

void compare_proximity(const core::Space& space, const Things& things, std::size_t i, Compared& all) {
  const core::RobotId robot = space.robot(i);
  const auto* const part = space.kind(robot).part<hal::ProximityPart>();
  const auto* const read = space.port<hal::Proximity>(robot);
  const core::Pose pose = space.pose(robot);
  for (std::size_t k = 0; k < part->mounts.size(); ++k) {
    const hal::Mount& m = part->mounts[k];
    const double x = pose.x_m + pose.cos_h * m.x_m - pose.sin_h * m.y_m;
    const double y = pose.y_m + pose.sin_h * m.x_m + pose.cos_h * m.y_m;
    const auto far = [&](const Solids& solids) {
      return cast(solids, x, y, pose.z_m + m.z_m, pose.heading_rad() + m.bearing_rad, part->range_m, i + 1);
    };
    if (std::abs(far(things.smaller) - far(things.larger)) > 10.0 * kSame_m)
      ++all.edges;
    else
      all.add(std::abs(static_cast<double>(read->distance_m[k]) - far(things.exact)), kSame_m);
  }
}

/// Whether a message of `from` should be heard by `to`; nothing where it passes by an edge.
std::optional<bool> heard(const core::Space& space, const Things& things, std::size_t from, std::size_t to) {
  const auto* const board = space.kind(space.robot(from)).part<hal::RangeAndBearingPart>();
  const core::Pose a = space.pose(space.robot(from)), b = space.pose(space.robot(to));
  const double apart = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
  if (std::abs(apart - board->range_m) < kSame_m) return std::nullopt;
  if (apart > board->range_m) return false;
  const double direction = std::atan2(b.y_m - a.y_m, b.x_m - a.x_m);
  const auto free = [&](const Solids& solids) {
    return cast(solids, a.x_m, a.y_m, a.z_m + board->height_m, direction, apart, from + 1, to + 1) >= apart;
  };
  const bool is = free(things.exact);
  if (is != free(things.smaller) || is != free(things.larger)) return std::nullopt;
  return is;
}

struct Messages {
  Compared places, numbers;
};

void compare_messages(const core::Space& space, const Things& things, const std::vector<std::size_t>& boards,
                      std::size_t to, Messages& all) {
  const auto* const read = space.port<hal::RangeAndBearing>(space.robot(to));
  const core::Pose at = space.pose(space.robot(to));
  std::size_t expected = 0;
  bool edge = false;
  for (const std::size_t from : boards) {
    if (from == to) continue;
    const auto one = heard(space, things, from, to);
    edge |= !one.has_value();
    expected += one.value_or(false) ? 1 : 0;
  }
  if (edge)
    ++all.numbers.edges;
  else
    all.numbers.add(std::abs(static_cast<double>(read->count + read->dropped) - static_cast<double>(expected)), 0.0);
  for (std::size_t k = 0; k < read->count; ++k) {
    const std::size_t from = read->message(k)[0];
    const core::Pose other = space.pose(space.robot(from));
    const double apart = std::hypot(other.x_m - at.x_m, other.y_m - at.y_m);
    const double bearing = std::atan2(other.y_m - at.y_m, other.x_m - at.x_m) - at.heading_rad();
    const double off = std::remainder(static_cast<double>(read->bearing_rad[k]) - bearing, 2.0 * M_PI);
    all.places.add(std::hypot(static_cast<double>(read->range_m[k]) - apart, apart * off), 3.0 * kSame_m);
  }
}

Table rays(Depth depth) {
  Compared footbots, epucks;
  Messages messages;
  const std::uint64_t worlds = depth == Depth::Short ? 3 : 40;
  for (std::uint64_t seed = 1; seed <= worlds; ++seed) {
    const auto opened = open_experiment("among_things.xml", seed);
    core::World& world = opened->world();
    core::Space& space = world.space();
    std::vector<std::size_t> boards;
    for (std::size_t i = 0; i < space.robot_count(); ++i)
      if (space.port<hal::RangeAndBearingSend>(space.robot(i)) != nullptr) boards.push_back(i);
    for (int tick = 0; tick < 3; ++tick) {  // a message that is written before a step is heard in one of the next
      for (const std::size_t i : boards)
        space.port<hal::RangeAndBearingSend>(space.robot(i))->say(static_cast<std::uint8_t>(i));
      world.step();
    }
    const Things things(space, kGrown_m);
    for (std::size_t i = 0; i < space.robot_count(); ++i)
      compare_proximity(space, things, i,
                        space.port<hal::RangeAndBearing>(space.robot(i)) != nullptr ? footbots : epucks);
    for (const std::size_t i : boards) compare_messages(space, things, boards, i, messages);
  }
  std::vector<Row> rows = {compared_row("proximity, foot-bot", footbots, 1e6, "µm", "at most 1 µm"),
                           compared_row("proximity, e-puck", epucks, 1e6, "µm", "at most 1 µm")};
  for (Row& row : scanner_rows(depth)) rows.push_back(std::move(row));
  rows.push_back(compared_row("range and bearing: number of messages", messages.numbers, 1.0, "messages", "equal"));
  rows.push_back(compared_row("range and bearing: place of the sender", messages.places, 1e6, "µm", "at most 3 µm"));
  rows.push_back(floor_row(depth));
  return {"Rays",
          fmt::format(
              "{} worlds of 40 foot-bots and 80 e-pucks at rest among boxes, cylinders and walls; each reading against "
              "the ray caster; distance scanners and ground sensors in worlds of their own. Rays that change when "
              "solids grow by 0.1 µm pass by an edge and are left out.",
              worlds),
          {"sensor", "readings", "largest difference"},
          std::move(rows)};
}

/// A reading and what it should be.
Row reading_row(const std::string& what, double read, double expected, double most, const std::string& unit) {
  return {{what, fmt::format("{:.4g} {}", expected, unit), fmt::format("{:.4g} {}", read, unit)},
          fmt::format("within {:g} {}", most, unit),
          verdict_of(std::abs(read - expected) <= most)};
}

Row lamp_row() {
  const auto opened = open_experiment("lamp.xml", 1);
  core::World& world = opened->world();
  core::Space& space = world.space();
  const core::RobotId robot = space.find_robot("fb");
  const hal::Mount& m = space.kind(robot).part<hal::LightPart>()->mounts.front();
  core::LightSource lamp = space.lights().front();
  const double heading = space.pose(robot).heading_rad() + m.bearing_rad;  // 1 m before the sensor, at its height
  const core::Pose pose = space.pose(robot);
  lamp.x_m = pose.x_m + pose.cos_h * m.x_m - pose.sin_h * m.y_m + std::cos(heading);
  lamp.y_m = pose.y_m + pose.sin_h * m.x_m + pose.cos_h * m.y_m + std::sin(heading);
  lamp.z_m = m.z_m;
  space.set_light(0, lamp);
  world.step();
  world.step();
  return reading_row("light, facing a lamp of intensity 1 at 1 m",
                     static_cast<double>(space.port<hal::Light>(robot)->level[0]), 1.0, 1e-3, "");
}

/// What a foot-bot feels that starts, drives and turns. Its wheels push with 1.5 N, it weighs 1.6 kg.
void add_felt(Table& table, const std::string& engine) {
  constexpr double kPush_m_s2 = 1.5 / 1.6, kBase_m = 0.14;
  const auto opened = open_experiment("felt.xml", 1, {{"{engine}", engine}});
  core::World& world = opened->world();
  core::Space& space = world.space();
  const core::RobotId robot = space.find_robot("fb");
  const auto& felt = *space.port<hal::Accelerometer>(robot);
  const auto& turned = *space.port<hal::Gyroscope>(robot);
  const auto steps = [&](int ticks, double left, double right) {
    for (int i = 0; i < ticks; ++i) {
      space.port<hal::WheelSpeeds>(robot)->set(left, right);
      world.step();
    }
  };
  steps(5, 0.0, 0.0);
  table.rows.push_back(
      reading_row(engine + ": accelerometer up, at rest", static_cast<double>(felt.force_m_s2[2]), 9.81, 0.02, "m/s²"));
  steps(2, 0.25, 0.25);
  table.rows.push_back(reading_row(engine + ": accelerometer forward, at the start",
                                   static_cast<double>(felt.force_m_s2[0]), kPush_m_s2, 0.05, "m/s²"));
  steps(20, 0.25, 0.25);
  table.rows.push_back(reading_row(engine + ": accelerometer forward, at a steady speed",
                                   static_cast<double>(felt.force_m_s2[0]), 0.0, 0.01, "m/s²"));
  steps(2, 0.0, 0.0);
  table.rows.push_back(reading_row(engine + ": accelerometer forward, braking", static_cast<double>(felt.force_m_s2[0]),
                                   -kPush_m_s2, 0.05, "m/s²"));
  steps(30, 0.1, 0.15);
  const double rate = 0.05 / kBase_m;
  table.rows.push_back(
      reading_row(engine + ": gyroscope, in a curve", static_cast<double>(turned.rate_rad_s[2]), rate, 0.002, "rad/s"));
  table.rows.push_back(reading_row(engine + ": accelerometer left, in a curve", static_cast<double>(felt.force_m_s2[1]),
                                   0.125 * rate, 0.005, "m/s²"));
}

}  // namespace

Part sensor_part(Depth depth) {
  Part part{"Sensors against references of their own",
            "What the sensors of simulated robots should read follows from where everything is."};
  Table single{"Single readings", "", {"reading", "reference", "read"}, {}};
  try {
    part.tables.push_back(rays(depth));
    part.tables.push_back(camera_table(depth));
    single.rows.push_back(lamp_row());
    for (const char* engine : {"dynamics2d", "dynamics3d"}) add_felt(single, engine);
  } catch (const std::runtime_error& wrong) {
    single.rows.push_back({{wrong.what(), "", ""}, "", Verdict::NotMade});
  }
  part.tables.push_back(std::move(single));
  return part;
}

}  // namespace tandem::validate
