// What a robot offers its controller beside its devices.
#include "hal/robot.hpp"

#include <array>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/robot/epuck.hpp"

namespace tandem::hal {
namespace {

using testing::ElementsAre;

class Named final : public Robot {
 public:
  Named(std::string id, std::uint64_t run_seed) : id_(std::move(id)), run_seed_(run_seed) {}
  std::string_view id() const noexcept override { return id_; }
  const RobotKind& kind() const noexcept override { return epuck::kind(); }
  std::uint64_t run_seed() const noexcept override { return run_seed_; }

  std::vector<PublishedField> shown;
  std::vector<const void*> members;

 protected:
  void* take(const PortType&) override { throw DeviceError("none"); }
  void show(PublishedField field, const void* member) override {
    shown.push_back(std::move(field));
    members.push_back(member);
  }

 private:
  std::string id_;
  std::uint64_t run_seed_;
};

TEST(Robot, TellsOfItsPartsAndWhichItIsBuiltWithout) {
  const Named robot("a", 1);
  EXPECT_EQ(&robot.part<DifferentialDrive>(), epuck::kind().drive());
  EXPECT_EQ(&robot.part<ProximityPart>(), epuck::kind().part<ProximityPart>());
  try {
    robot.part<TurretPart>();
    FAIL() << "an e-puck has no turret";
  } catch (const DeviceError& e) {
    EXPECT_THAT(e.what(), testing::StartsWith("needs the part 'turret', which the robot 'e-puck' is built without"));
  }
}

TEST(Robot, HasChanceOfItsOwnBySeedAndId) {
  const auto first = [](const Robot& robot) { return robot.random()(); };
  EXPECT_EQ(first(Named("a", 1)), first(Named("a", 1)));
  EXPECT_NE(first(Named("a", 1)), first(Named("b", 1)));
  EXPECT_NE(first(Named("a", 1)), first(Named("a", 2)));
  EXPECT_NE(Named("a", 1).random(1)(), first(Named("a", 1)));
}

TEST(Robot, PublishedMembersAreDescribed) {
  enum class Mode : std::uint8_t { Rest, Search, Bring };
  struct {
    double range_m = 0.25;
    Mode mode = Mode::Search;
    std::array<std::int32_t, 3> counts{1, 2, 3};
    bool lost = true;
  } controller;
  Named robot("a", 1);
  robot.publish("range", controller.range_m, unit::m, "How far it looks.");
  robot.publish("mode", controller.mode, {"rest", "search", "bring"});
  robot.publish("counts", controller.counts);
  robot.publish("lost", controller.lost);
  ASSERT_EQ(robot.shown.size(), 4U);
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < 4; ++i) {
    robot.shown[i].offset = static_cast<std::size_t>(static_cast<const std::byte*>(robot.members[i]) -
                                                     reinterpret_cast<const std::byte*>(&controller));
    texts.push_back(text_of(robot.shown[i], &controller));
  }
  EXPECT_THAT(texts, ElementsAre("0.25 m", "search", "[1 2 3]", "1"));
  EXPECT_EQ(value_of(robot.shown[1], &controller), 1.0);
  EXPECT_EQ(value_of(robot.shown[2], &controller, 2), 3.0);
  controller.mode = static_cast<Mode>(9);
  EXPECT_EQ(text_of(robot.shown[1], &controller), "9") << "a value without a word";
  EXPECT_EQ(size_of(robot.shown[2]), 12U);
  EXPECT_EQ(robot.shown[0].doc, "How far it looks.");
}

struct Kept final : RobotLog::Sink {
  TimeNs now = 0;
  std::vector<std::string> texts;
  TimeNs now_ns() const noexcept override { return now; }
  void write(std::uint32_t robot, Severity severity, std::string_view text, std::uint32_t left_out) noexcept override {
    EXPECT_EQ(severity, Severity::Warning);
    texts.push_back(message_of("r" + std::to_string(robot), now / kNsPerSecond, text, left_out));
  }
};

TEST(RobotLog, NamesRobotAndTick) {
  Kept kept;
  kept.now = 12 * kNsPerSecond;
  RobotLog log(kept, 3);
  log.warning("no light");
  EXPECT_THAT(kept.texts, ElementsAre("robot 'r3' at tick 12: no light"));
  RobotLog().warning("nobody hears this");
}

TEST(RobotLog, LeavesOutWhatIsTooMuchAndSaysSo) {
  Kept kept;
  RobotLog log(kept, 0);
  for (int second = 0; second < 100; ++second) {  // 20 a second
    for (int i = 0; i < 20; ++i) log.warning("again");
    kept.now += kNsPerSecond;
  }
  EXPECT_GE(kept.texts.size(), 100U);
  EXPECT_LE(kept.texts.size(), 100U + RobotLog::kBurst);
  EXPECT_EQ(kept.texts.back(), "robot 'r0' at tick 99: again (19 messages before it were left out)");
  kept.texts.clear();
  kept.now += 1000 * kNsPerSecond;  // silence fills the bucket again
  for (int i = 0; i < 20; ++i) log.warning("later");
  EXPECT_EQ(kept.texts.size(), static_cast<std::size_t>(RobotLog::kBurst));
}

TEST(RobotLog, GoesOnWhenTheRunGoesBack) {
  Kept kept;
  RobotLog log(kept, 0);
  kept.now = 1000 * kNsPerSecond;
  for (int i = 0; i < 20; ++i) log.warning("late");
  kept.now = 0;
  kept.texts.clear();
  log.warning("early");
  EXPECT_THAT(kept.texts, ElementsAre("robot 'r0' at tick 0: early (10 messages before it were left out)"));
}

}  // namespace
}  // namespace tandem::hal
