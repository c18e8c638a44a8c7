// A checkpoint changes no bit of the run: neither taking one nor going back to it.
#include <gtest/gtest.h>
#include <map>
#include <random>

#include "core/physics/solver.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"
#include "tests/core/footbots.hpp"

namespace tandem::core {
namespace {

constexpr int kFootbots = 3;

/// An engine with the options that make it keep the most between ticks.
struct Way {
  std::string name, kind;
  std::vector<Element::Attribute> options;
  bool slow = false;
};

std::vector<Way> ways() {
  std::vector<Way> all;
  for (const std::string& kind : test::engine_kinds()) all.push_back({kind, kind, {}});
  all.push_back(
      {"dynamics3d_wheels_rotors", "dynamics3d", {{"drive", "wheels", 100}, {"flight", "rotors", 100}}, true});
  return all;
}

class Checkpoints : public testing::TestWithParam<Way> {};

/// Crowds in four regions that push crates, heaps, foot-bots that hold and swing theirs, and eye-bots above.
Scene busy_scene(const Way& way) {
  const EngineTraits& traits = test::engine_traits(way.kind);
  Scene s(4.0, "everything");
  s.param("left", "0.11").param("right", "0.1").implementations("noisy").walls();
  s.engine(way.kind, "", way.options).split("2x2");
  s.scenario.escape = EscapePolicy::Stop;
  s.robots(way.slow ? 12 : 50, 1.2);
  if (traits.forces) {
    for (int i = 0; i < 6; ++i)
      s.box(0.25 * (i % 3) - 0.25, 0.25 * (i / 3) - 0.1, 0.1, 0.12, 0.3 * i, 0.06).movable(0.2);
    s.cylinder(-0.6, 0.02, 0.06).movable(0.1);
  }
  if (!traits.plane) {
    s.pilot("fly", {}, "noisy");
    for (int i = 0; i < 4; ++i)
      s.flyer("fly" + std::to_string(i), -1.5 + i, -1.6, 0.4).velocity({0.05, 0.1 * i, 0.02}, 0.1);
  }
  if (traits.forces) {
    const Scene footbots = footbot_scene(way.kind);
    s.scenario.controllers.push_back(footbots.scenario.controllers.back());
    s.scenario.controllers.back().id = "puppet";
    for (int i = 0; i < kFootbots; ++i) {
      add_footbot(s, "fb" + std::to_string(i), -1.5 + 1.4 * i, 1.5);
      s.scenario.robots.back().controller = s.scenario.controllers.size() - 1;
      s.box(-1.5 + 1.4 * i + hal::footbot::kind().body.radius_m + 0.06, 1.5, 0.1, 0.1, 0.0, 0.2).movable(0.15);
    }
  }
  return s;
}

/// What hooks and operators do in this tick: robots and objects come and go, are put elsewhere, and are held together.
void meddle(World& world, const EngineTraits& traits, unsigned seed) {
  Space& space = world.space();
  const auto tick = static_cast<unsigned>(world.tick());
  std::mt19937 random(seed * 1000 + tick);
  const auto below = [&random](unsigned count) { return static_cast<std::size_t>(random() % count); };
  const auto place = [&] { return -1.7 + 0.034 * static_cast<double>(below(100)); };
  const std::string name = "at" + std::to_string(tick);
  if (traits.forces && tick == 2) {
    for (int i = 0; i < kFootbots; ++i) {
      const RobotId id = space.find_robot("fb" + std::to_string(i));
      space.port<hal::GripperDrive>(id)->lock();
      space.port<hal::WheelSpeeds>(id)->set(-0.04, -0.05);
      if (i > 0) space.port<hal::TurretDrive>(id)->turn(0.3 * i);
    }
  }
  const RobotId some = space.robot(below(static_cast<unsigned>(space.robot_count())));
  switch (below(12)) {
    case 0:
      (void)space.add_robot({.id = name, .controller = "c", .pose = Pose::at(place(), place(), 0.3)});
      break;
    case 1:
      space.remove_robot(some);
      break;
    case 2:
      space.set_pose(some, Pose::at(place(), place(), 1.0));
      break;
    case 3:
    case 4: {
      Object object;
      object.id = name;
      object.x_m = place();
      object.y_m = place();
      object.half_x_m = object.half_y_m = 0.05;
      object.z_high_m = 0.1;
      object.movable = traits.forces && below(2) == 0;
      object.mass_kg = object.movable ? 0.1 : 0.0;
      (void)space.add_object(object);
      break;
    }
    case 5: {
      const ObjectId object = space.find_object("box4");
      if (space.contains(object) && below(4) == 0) space.remove_object(object);
      break;
    }
    case 6:
      if (traits.forces) {
        const Pose at = space.pose(some);
        (void)space.join(some, space.robot(below(static_cast<unsigned>(space.robot_count()))), {at.x_m, at.y_m, 0.02},
                         {.kind = static_cast<JointKind>(below(3))});
      }
      break;
    default:
      break;
  }
}

void do_tick(World& world, const Way& way, unsigned seed) {
  meddle(world, test::engine_traits(way.kind), seed);
  world.step();
}

TEST_P(Checkpoints, ChangeNoBitOfTheRun) {
  const Way& way = GetParam();
  const int ticks = way.slow ? 25 : 90;
  for (unsigned seed = 1; seed <= (way.slow ? 1U : 3U); ++seed) {
    auto plain = make(busy_scene(way));
    auto kept = make(busy_scene(way));
    ASSERT_TRUE(plain.world) << plain.all_problems();
    std::mt19937 random(seed);
    std::map<int, Snapshot> snapshots;
    std::vector<std::uint64_t> prints;
    plain->start();
    kept->start();
    for (int tick = 0; tick < ticks; ++tick) {
      if (random() % 8 == 0 || tick == 1) {
        hal::Result<Snapshot> snapshot = kept->snapshot();
        ASSERT_TRUE(snapshot.ok()) << snapshot.error().message;
        snapshots.emplace(tick, std::move(snapshot.value()));
      }
      do_tick(*plain.world, way, seed);
      do_tick(*kept.world, way, seed);
      prints.push_back(plain->state_hash());
      ASSERT_EQ(kept->state_hash(), prints.back()) << "with checkpoints, seed " << seed << " tick " << tick;
    }
    EXPECT_EQ(plain->state(), RunState::Running) << plain->failure();
    for (int time = 0; time < (way.slow ? 4 : 12); ++time) {
      const auto from = std::next(snapshots.begin(), static_cast<std::ptrdiff_t>(random() % snapshots.size()));
      ASSERT_TRUE(kept->restore(from->second).ok());
      const int past = std::min(ticks, from->first + 30);
      for (int tick = from->first; tick < past; ++tick) {
        do_tick(*kept.world, way, seed);
        ASSERT_EQ(kept->state_hash(), prints.at(static_cast<std::size_t>(tick)))
            << "from the checkpoint of tick " << from->first << ", seed " << seed << " tick " << tick;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Physics, Checkpoints, testing::ValuesIn(ways()),
                         [](const auto& way) { return way.param.name; });

}  // namespace
}  // namespace tandem::core
