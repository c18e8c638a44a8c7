// A foot-bot's modules on a bus in memory, and a driver at the other end; time is turned by hand.
#pragma once
#include <functional>
#include <gtest/gtest.h>

#include "bridges/aseba/can_messages.hpp"
#include "bridges/footbot/driver.hpp"
#include "bridges/footbot/map_file.hpp"
#include "tests/bridges/aseba/fake_node.hpp"
#include "tests/bridges/can/faulty_can_link.hpp"
#include "tests/bridges/can/memory_bus.hpp"
#include "tests/checkout.hpp"

namespace tandem::bridges::footbot {

using aseba::FakeNode;
using Named = std::vector<std::pair<std::string, int>>;

inline constexpr hal::TimeNs kMs = hal::kNsPerMs;
inline constexpr hal::TimeNs kTick = 100 * kMs;

/// The variables that every module has by habit, and its own.
inline Named with_habits(Named own) {
  Named all = {{"id", 1}, {"source", 1}, {"args", 32}};
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

/// What the modules of the default map are called and have.
inline std::vector<std::pair<std::string, Named>> default_modules() {
  return {{"left motor", {{"speed", 1}, {"odo", 2}}},
          {"right motor", {{"speed", 1}, {"odo", 2}}},
          {"proximity sensors", {{"bumpers", 24}, {"ground", 12}, {"light", 24}}},
          {"distance sensors",
           {{"scan.range", 4}, {"scan.angle", 1}, {"scan.mode", 1}, {"scan.speed", 1}, {"scan.target", 1}}},
          {"turret", {{"turret.mode", 1}, {"turret.speed", 1}, {"turret.target", 1}, {"turret.angle", 1}}},
          {"gripper", {{"gripper.target", 1}, {"gripper.angle", 1}, {"gripper.busy", 1}}},
          {"leds", {{"led.red", 12}, {"led.green", 12}, {"led.blue", 12}, {"beacon", 3}}},
          {"range and bearing", {{"rab.tx", 5}}},
          {"base", {{"battery", 1}, {"acc", 3}, {"gyro", 1}}}};
}

inline FootbotMap map_of(const std::string& text) {
  hal::Problems problems;
  const auto map = bridges::footbot::read_footbot_map_text(text, "map.xml", problems);
  for (const hal::Problem& p : problems) ADD_FAILURE() << hal::to_text(p);
  return map.value_or(FootbotMap{});
}

inline const FootbotMap& default_map() {
  static const FootbotMap map = [] {
    hal::Problems problems;
    const auto read =
        bridges::footbot::read_footbot_map((std::string(test::kSourceDir) + "/configs/footbot_map.xml"), problems);
    for (const hal::Problem& p : problems) ADD_FAILURE() << hal::to_text(p);
    return read.value_or(FootbotMap{});
  }();
  return map;
}

/// The modules alone, on a bus of theirs.
class FakeModules {
 public:
  using Attach = std::function<std::unique_ptr<CanLink>()>;
  /// `attach` gives each module its own end of the bus.
  explicit FakeModules(Attach attach) : attach_(std::move(attach)) {}
  explicit FakeModules(MemoryBus& bus) : FakeModules([&bus] { return bus.attach(); }) {}

  FakeNode& add(const std::string& name, const Named& own, int id = 0) {
    const auto number = static_cast<std::uint8_t>(id != 0 ? id : static_cast<int>(nodes.size()) + 1);
    nodes.push_back(std::make_unique<FakeNode>(attach_(), number, name, with_habits(own)));
    return *nodes.back();
  }
  void add_all() {
    for (const auto& [name, own] : default_modules()) add(name, own);
  }
  FakeNode& operator[](const std::string& name) {
    for (const auto& node : nodes) {
      if (node->name == name) return *node;
    }
    ADD_FAILURE() << "no module " << name;
    return *nodes.front();
  }
  std::int16_t& word(const std::string& name, const std::string& variable, std::size_t index = 0) {
    FakeNode& node = (*this)[name];
    std::size_t address = 0;
    for (const auto& [v, words] : node.variables) {
      if (v == variable) return node.memory.at(address + index);
      address += static_cast<std::size_t>(words);
    }
    ADD_FAILURE() << name << " has no variable " << variable;
    return node.memory.front();
  }
  void work() {
    for (const auto& node : nodes) node->work();
  }

  std::vector<std::unique_ptr<FakeNode>> nodes;

 private:
  Attach attach_;
};

/// A robot, a driver, and a loop that ticks.
class Bench {
 public:
  explicit Bench(DriverSettings settings = {default_settings()}, const CanFaults& faults = {})
      : bus([this] { return now; }, 8192),
        modules(bus),
        link(attach(faults), {}, [this] { return now; }),
        driver(std::move(settings), link,
               hal::Log([this](hal::Severity, std::string_view text) { said += std::string(text) + "\n"; })) {}

  static DriverSettings default_settings() {
    DriverSettings settings;
    settings.map = default_map();
    settings.robot.id = "fb";
    return settings;
  }
  std::unique_ptr<CanLink> attach(const CanFaults& faults) {
    const bool any = faults.loss + faults.doubling + faults.reordering + faults.lateness + faults.bus_off > 0.0;
    if (!any) return bus.attach();
    return std::make_unique<FaultyCanLink>(bus.attach(), faults, [this] { return now; });
  }

  template <class T>
  const T& sensor() {
    return *static_cast<const T*>(driver.robot().require(hal::port_type<T>()));
  }
  template <class T>
  T& actuator() {
    return *static_cast<T*>(driver.robot().require(hal::port_type<T>()));
  }

  /// Time passes in steps of a millisecond; nobody ticks.
  void pass(hal::TimeNs time) {
    for (const hal::TimeNs end = now + time; now < end;) {
      now += kMs;
      driver.pump(now);
      modules.work();
    }
  }
  /// One tick: latch, `step`, commit; then the time until the next.
  template <class F>
  void tick(F&& step) {
    driver.latch(ticks++, now);
    step();
    driver.commit(now);
    modules.work();
    pass(kTick);
  }
  void tick() {
    tick([] {});
  }
  /// Ticks until the robot is in that state. False: not within `most` ticks.
  bool tick_until(RobotState state, int most = 30) {
    for (int i = 0; i < most; ++i) {
      if (driver.state() == state) return true;
      tick();
    }
    return driver.state() == state;
  }

  hal::TimeNs now = 1000 * kMs;
  hal::Tick ticks = 0;
  std::string said;
  MemoryBus bus;
  FakeModules modules;
  aseba::CanMessages link;
  FootbotDriver driver;
};

}  // namespace tandem::bridges::footbot
