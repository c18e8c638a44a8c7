// Every controller decides alike on every machine: fed the same readings, it writes the same commands, bit by bit.
//
// decisions.txt has one line a controller, or a script: its name, the fingerprint of its commands of 100,000 ticks
// (10,000 of a script), and in how many ticks they changed. Every preset compares with it, those for robots' boards as
// well. When a controller is new or is meant to behave otherwise: TANDEM_REWRITE_DECISIONS=1 ./tandem test -R decisions
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <new>
#include <regex>
#include <set>
#include <sstream>

#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/checkout.hpp"
#include "tests/controllers/decisions/made_up_robot.hpp"

namespace tandem::decisions {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kTicks = 100'000;
const fs::path kGolden = fs::path(test::kSourceDir) / "tests/controllers/decisions/decisions.txt";
// They take devices and leave them to others, or obey somebody who is not there.
const std::set<std::string> kDecideNothing = {"puppet", "footbot_puppet", "eyebot_puppet", "thymio_puppet",
                                              "footbot_manual"};

struct Decisions {
  std::uint64_t hash = 14695981039346656037U;
  std::int64_t changes = 0;

  std::string text() const {
    std::ostringstream out;
    out << std::hex << hash << std::dec << " " << changes;
    return out.str();
  }
};

/// Leaves every parameter as it is by default.
class Defaults : public hal::ParamVisitor {
 public:
  void visit(const hal::Param&) override {}
};

/// Names a script.
class NamedScript final : public Defaults {
 public:
  explicit NamedScript(std::string path) : path_(std::move(path)) {}
  void visit(const hal::Param& param) override {
    if (param.name == "script") *param.text() = path_;
  }

 private:
  std::string path_;
};

/// The robot that a controller is named after; an e-puck where it is named after none.
const hal::RobotKind& kind_for(std::string_view controller) {
  if (controller.starts_with("footbot")) return hal::footbot::kind();
  if (controller.starts_with("eyebot")) return hal::eyebot::kind();
  return hal::epuck::kind();
}

Decisions decisions_of(const hal::ControllerType& type, MadeUpRobot& robot, hal::ParamVisitor& visitor,
                       std::int64_t ticks) {
  const auto params = type.read_params(visitor);
  std::byte* memory = static_cast<std::byte*>(::operator new (type.size, std::align_val_t{type.align}));
  type.construct(memory, robot, params.get());
  Decisions decisions;
  std::uint64_t last = robot.mix_commands(0);
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    robot.sense(tick);
    const std::uint8_t running = 0;
    hal::StepFault fault;
    EXPECT_EQ(type.step_row(memory, type.size, 0, 1, &running, fault), 1U) << fault.message;
    const std::uint64_t commands = robot.mix_commands(0);
    if (commands != last) ++decisions.changes;
    last = commands;
    decisions.hash = (decisions.hash ^ commands) * 1099511628211U;
  }
  type.destroy(memory);
  ::operator delete (memory, std::align_val_t{type.align});
  return decisions;
}

Decisions decisions_of(const hal::ControllerType& type) {
  MadeUpRobot robot(kind_for(type.name));
  Defaults defaults;
  return decisions_of(type, robot, defaults, kTicks);
}

/// Of an e-puck under a script: fewer ticks, for an interpreter takes long on an emulated processor.
Decisions decisions_of(const hal::ControllerType& type, const std::string& script) {
  MadeUpRobot robot(hal::epuck::kind(), {{&hal::port_type<hal::Proximity>(), "epuck_proximity"},
                                         {&hal::port_type<hal::WheelSpeeds>(), "differential_steering"}});
  NamedScript named(std::string(test::kSourceDir) + "/" + script);
  return decisions_of(type, robot, named, kTicks / 10);
}

std::map<std::string, std::string> read_golden() {
  std::map<std::string, std::string> lines;
  std::ifstream in(kGolden);
  for (std::string line; std::getline(in, line);)
    lines[line.substr(0, line.find(' '))] = line.substr(line.find(' ') + 1);
  return lines;
}

/// The shared objects of the folder controllers/.
std::vector<std::string> libraries() {
  std::istringstream in(TANDEM_CONTROLLER_LIBRARIES);
  std::vector<std::string> names;
  for (std::string name; std::getline(in, name, ',');)
    names.push_back(std::string(test::kBuildDir) + "/lib/lib" + name + ".so");
  return names;
}

TEST(Decisions, OfEveryControllerAreThoseOfEveryOtherMachine) {
  hal::PluginLoader loader({});
  for (const std::string& library : libraries()) {
    const hal::Status opened = loader.open(library);
    ASSERT_TRUE(opened.ok()) << opened.error().message;
  }
  std::map<std::string, std::string> found;
  for (const hal::ControllerType* type : loader.catalog().all<hal::ControllerType>()) {
    if (type->name == "neural") continue;  // its policy decides
    if (type->name == "lua_controller") {
      for (const char* script : {"configs/lua/diffusion.lua", "tests/controllers/decisions/script.lua"}) {
        const Decisions decisions = decisions_of(*type, script);
        found[script] = decisions.text();
        EXPECT_GT(decisions.changes, 0) << script;
      }
      continue;
    }
    const Decisions decisions = decisions_of(*type);
    const std::string name(type->name);
    found[name] = decisions.text();
    EXPECT_EQ(decisions.changes > 0, !kDecideNothing.contains(name)) << name;
  }
  if (std::getenv("TANDEM_REWRITE_DECISIONS") != nullptr) {
    std::ofstream out(kGolden);
    for (const auto& [name, text] : found) out << name << " " << text << "\n";
    GTEST_SKIP() << kGolden << " is written anew";
  }
  EXPECT_EQ(found, read_golden()) << "left: what it is here; right: " << kGolden;
}

/// World::snapshot copies controllers: one that cannot be copied would end every run that keeps a moment.
TEST(Decisions, CanAllBeGoneBackTo) {
  hal::PluginLoader loader({});
  for (const std::string& library : libraries()) ASSERT_TRUE(loader.open(library).ok()) << library;
  int controllers = 0;
  for (const auto* type : loader.catalog().all<hal::ControllerType>()) {
    ++controllers;
    EXPECT_NE(type->copy, nullptr) << type->name << " has no copy constructor";
  }
  EXPECT_GT(controllers, 10);
}

/// Functions of the C library whose last bits differ between machines; hal/elementary.hpp has those that are needed.
TEST(Decisions, AreMadeWithoutTheCLibrarysArithmetic) {
  const std::regex forbidden(
      R"(\bstd::(sinf?|cosf?|tanf?|asinf?|acosf?|atanf?|atan2f?|sinh|cosh|tanh|exp|exp2|expm1|log|log2|log10|log1p|pow|cbrt|hypot|tgamma|lgamma|erf|normal_distribution|polar)\b)");
  for (const char* layer : {"controllers", "hal/robot", "hal/device"}) {
    for (const auto& file : fs::recursive_directory_iterator(fs::path(test::kSourceDir) / layer)) {
      if (file.path().extension() != ".cpp" && file.path().extension() != ".hpp") continue;
      std::ifstream in(file.path());
      int number = 0;
      for (std::string line; std::getline(in, line);) {
        ++number;
        EXPECT_FALSE(std::regex_search(line, forbidden))
            << file.path().string() << ":" << number << ": the last bit of this differs between machines; take it from "
            << "hal/elementary.hpp: " << line;
      }
    }
  }
}

}  // namespace
}  // namespace tandem::decisions
