#include "hal/controller.hpp"

#include <gtest/gtest.h>
#include <stdexcept>
#include <vector>

#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"

namespace tandem::hal {
namespace {

/// A robot with wheels alone.
class WheelsOnly final : public Robot {
 public:
  std::string_view id() const noexcept override { return "ep0"; }
  const RobotKind& kind() const noexcept override { return epuck::kind(); }
  std::uint64_t run_seed() const noexcept override { return 42; }
  WheelSpeeds wheels;

 protected:
  void* take(const PortType& type) override {
    if (type.name == WheelSpeeds::kName && type.role == Role::Actuator) return &wheels;
    throw DeviceError("no device '" + std::string(type.name) + "'");
  }
};

/// Sets every number to what the test says, and notes the rest.
class Numbers final : public ParamVisitor {
 public:
  explicit Numbers(double value) : value_(value) {}
  void visit(const Param& param) override {
    if (double* const v = param.as<double>(); v != nullptr) *v = value_;
    if (const auto* const group = param.group(); group != nullptr) group->describe(group->value, *this);
  }

 private:
  double value_;
};

int alive = 0;

struct Counter : Controller {
  struct Params {
    double limit = 3.0;
    void describe(ParamVisitor& v) { v.number("limit", limit, unit::none, kAny, "Steps before it throws."); }
  };
  Counter(Robot& robot, const Params& params) : wheels(robot.actuator<WheelSpeeds>()), limit(params.limit) { ++alive; }
  ~Counter() override { --alive; }
  void step() override {
    if (++steps > limit) throw std::runtime_error("that is enough");
  }
  WheelSpeeds& wheels;
  double limit;
  int steps = 0;
};

struct Blind : Controller {
  explicit Blind(Robot& robot) { robot.sensor<Proximity>(); }
  void step() override {}
};

struct Rude : Controller {
  explicit Rude(Robot&) {}
  void step() override { throw 7; }
};

class Row : public testing::Test {
 protected:
  static constexpr std::size_t kCount = 5;
  const ControllerType& type_ = controller_type<Counter>("counter", "Counts its steps.");
  alignas(Counter) std::array<std::byte, kCount * sizeof(Counter)> memory_{};
  std::array<std::uint8_t, kCount> halted_{};
  WheelsOnly robot_;
  StepFault fault_;

  void SetUp() override {
    Numbers three(3.0);
    const auto params = type_.read_params(three);
    for (std::size_t i = 0; i < kCount; ++i)
      type_.construct(memory_.data() + i * sizeof(Counter), robot_, params.get());
  }
  void TearDown() override {
    for (std::size_t i = 0; i < kCount; ++i) type_.destroy(memory_.data() + i * sizeof(Counter));
    EXPECT_EQ(alive, 0);
  }
  Counter& at(std::size_t i) { return *std::launder(reinterpret_cast<Counter*>(memory_.data() + i * sizeof(Counter))); }
  std::size_t step(std::size_t begin = 0) {
    return type_.step_row(memory_.data(), sizeof(Counter), begin, kCount, halted_.data(), fault_);
  }
};

TEST_F(Row, StepsEveryControllerOnce) {
  EXPECT_EQ(step(), kCount);
  for (std::size_t i = 0; i < kCount; ++i) EXPECT_EQ(at(i).steps, 1);
}

TEST_F(Row, LeavesOutTheHalted) {
  halted_[2] = 1;
  EXPECT_EQ(step(), kCount);
  EXPECT_EQ(at(2).steps, 0);
  EXPECT_EQ(at(3).steps, 1);
}

TEST_F(Row, StopsAtTheOneThatThrowsAndGoesOnBehindIt) {
  at(2).limit = 0.0;
  EXPECT_EQ(step(), 2U);
  EXPECT_EQ(fault_.index, 2U);
  EXPECT_EQ(fault_.message, "that is enough");
  EXPECT_EQ(at(1).steps, 1);
  EXPECT_EQ(at(3).steps, 0);
  EXPECT_EQ(step(3), kCount);
  EXPECT_EQ(at(3).steps, 1);
}

TEST(ControllerType, KnowsItsClass) {
  const ControllerType& type = controller_type<Counter>("counter", "Counts its steps.");
  EXPECT_EQ(type.name, "counter");
  EXPECT_EQ(type.summary, "Counts its steps.");
  EXPECT_EQ(type.size, sizeof(Counter));
  EXPECT_EQ(type.align, alignof(Counter));
}

TEST(ControllerType, SpellsItsClass) {
  EXPECT_NE(controller_type<Counter>("counter", "").class_name.find("tandem::hal::"), std::string_view::npos);
  EXPECT_TRUE(controller_type<Counter>("counter", "").class_name.ends_with("::Counter"));
  EXPECT_NE(controller_type<Blind>("blind", "").class_name, controller_type<Rude>("rude", "").class_name);
}

struct Learner : Controller {
  explicit Learner(Robot& robot) : id(robot.id()) {}
  void step() override { ++learned; }
  bool reset(Robot& robot) override {
    id = robot.id();
    return true;
  }
  std::string id;
  int learned = 0;
};

TEST(ControllerType, AClassMayKeepItsObjectsOverAReset) {
  WheelsOnly robot;
  Learner learner(robot);
  learner.step();
  EXPECT_TRUE(controller_type<Learner>("learner", "").reset(&learner, robot));
  EXPECT_EQ(learner.learned, 1);
  Rude rude(robot);
  EXPECT_FALSE(controller_type<Rude>("rude", "").reset(&rude, robot)) << "by default another is made in its place";
}

TEST(ControllerType, AMissingDeviceIsAnErrorWhenItIsMade) {
  const ControllerType& type = controller_type<Blind>("blind", "");
  WheelsOnly robot;
  alignas(Blind) std::array<std::byte, sizeof(Blind)> memory{};
  Numbers any(0.0);
  EXPECT_THROW(type.construct(memory.data(), robot, type.read_params(any).get()), DeviceError);
}

TEST(ControllerType, SomethingThrownThatIsNoExceptionIsCaughtToo) {
  const ControllerType& type = controller_type<Rude>("rude", "");
  WheelsOnly robot;
  alignas(Rude) std::array<std::byte, sizeof(Rude)> memory{};
  type.construct(memory.data(), robot, nullptr);
  const std::uint8_t halted = 0;
  StepFault fault;
  EXPECT_EQ(type.step_row(memory.data(), sizeof(Rude), 0, 1, &halted, fault), 0U);
  EXPECT_EQ(fault.message, "an exception of unknown type");
  type.destroy(memory.data());
}

}  // namespace
}  // namespace tandem::hal
