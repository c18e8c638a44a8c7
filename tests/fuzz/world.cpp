// Whole worlds: an experiment is made up, spoilt, read, made into a world and stepped, in every engine.
//
// An input is a recipe that picks engines, robots, objects, devices with their options, media and hooks, and then
// spoils values of the text. The promises: no crash and no hang; an error is said exactly when there is no scenario, or
// no world; everybody has a place that is a number as long as the run has not failed; a restored run, one with other
// threads, and one from the saved settings go on to the same bits.
#include "core/sim/world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <span>
#include <string>
#include <string_view>

#include "core/config/reader.hpp"
#include "core/device/device.hpp"
#include "core/sim/robot_factory.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"
#include "tests/checkout.hpp"
#include "tests/core/catalog.hpp"

namespace {

using namespace tandem;
using namespace tandem::core;

constexpr int kMostSteps = 12;
constexpr std::int64_t kMostRobots = 60;
constexpr std::size_t kMostObjects = 40;

void expect(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

class Bytes {
 public:
  explicit Bytes(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  bool done() const { return at_ >= bytes_.size(); }
  std::size_t next() { return done() ? 0 : bytes_[at_++]; }
  std::size_t below(std::size_t n) { return next() % n; }
  bool one_in(std::size_t n) { return below(n) == n - 1; }
  template <std::size_t N>
  std::string pick(const std::array<std::string_view, N>& from) {
    return std::string(from[below(N)]);
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

constexpr std::array<std::string_view, 12> kLengths = {"0.1",  "0.2",  "0.05", "1",    "0.5",   "0.005",
                                                       "1e-5", "0.02", "3",    "1000", "1e-06", "0.1 mm"};
constexpr std::array<std::string_view, 8> kPlaces = {"0", "0.3", "-0.4", "0.7", "-0.9", "1.2", "-1.3", "0.05"};
constexpr std::array<std::string_view, 6> kHeights = {"0", "0", "0", "0.1", "0.5", "1.5"};
constexpr std::array<std::string_view, 8> kMasses = {"1", "0.1", "0.01", "5", "1e-9", "1e9", "1e-5", "100"};
constexpr std::array<std::string_view, 6> kRates = {"10", "10", "1", "2", "100", "5"};
constexpr std::array<std::string_view, 14> kNasty = {"0",  "-1",   "1e-9", "1e9", "1e308", "0.001", "1000000",
                                                     "90", "true", "nan",  "x",   "1,2,3", "noisy", ""};
constexpr std::array<std::string_view, 7> kEngines = {"",
                                                      "kinematics2d",
                                                      "dynamics2d",
                                                      "dynamics3d",
                                                      "dynamics3d\" drive=\"wheels",
                                                      "particle3d",
                                                      "dynamics3d\" flight=\"rotors"};

/// What an experiment says of a robot's kind.
struct Kind {
  std::string_view name, controller;
};
constexpr std::array<Kind, 3> kKinds = {{{"e-puck", "everything"}, {"foot-bot", "puppet"}, {"eye-bot", "eye_puppet"}}};

const hal::RobotKind& kind_of(const Kind& kind) {
  return *test::catalog().find<hal::RobotKind>(kind.name);
}

/// <sensors> or <actuators> with all devices of a kind of robot, some of them with an implementation and an option.
std::string devices(Bytes& r, const Kind& kind, hal::Role role) {
  std::string text;
  std::vector<std::string_view> seen;
  for (const DeviceType* type : test::catalog().all<DeviceType>()) {
    if (type->role != role || !type->fits(kind_of(kind))) continue;
    if (std::find(seen.begin(), seen.end(), type->device) != seen.end()) continue;
    seen.push_back(type->device);
    text += "<" + std::string(type->device);
    if (r.one_in(4)) {
      std::vector<const DeviceType*> all;
      for (const DeviceType* t : test::catalog().all<DeviceType>()) {
        if (t->role == role && t->device == type->device) all.push_back(t);
      }
      const DeviceType& chosen = *all[r.below(all.size())];
      text += " implementation=\"" + std::string(chosen.implementation) + "\"";
      if (r.one_in(2)) {
        Element options;
        ElementWriter writer(options);
        chosen.describe(writer);
        if (!options.attributes.empty()) {
          const auto& option = options.attributes[r.below(options.attributes.size())];
          if (option.name != "medium" && option.name != "implementation")
            text += " " + option.name + "=\"" + r.pick(kNasty) + "\"";
        }
      }
    }
    text += "/>";
  }
  return text;
}

std::string controllers(Bytes& r) {
  std::string text = "<controllers>";
  for (const Kind& kind : kKinds) {
    const std::string name(kind.controller);
    text += "<" + name + " id=\"" + std::string(kind.name) + "\" library=\"test_controllers\"><sensors>" +
            devices(r, kind, hal::Role::Sensor) + "</sensors><actuators>" + devices(r, kind, hal::Role::Actuator) +
            "</actuators>";
    if (kind.name == "e-puck") text += "<params left=\"0.05\" right=\"0.04\"/>";
    text += "</" + name + ">";
  }
  return text + "</controllers>";
}

std::string engine(Bytes& r, const std::string& id, const std::string& inside) {
  const std::string kind = r.pick(kEngines);
  if (kind.empty()) return "<kinematics2d id=\"" + id + "\">" + inside + "</kinematics2d>";
  std::string text = "<" + kind.substr(0, kind.find('"')) + " id=\"" + id + "\"" +
                     (kind.find('"') == std::string::npos ? "" : kind.substr(kind.find('"') + 1) + "\"");
  const std::string name = kind.substr(0, kind.find('"'));
  if (r.one_in(4) && inside.empty()) text += " regions=\"2x2\"";
  if (r.one_in(3)) {
    Element options;
    ElementWriter writer(options);
    test::engine_type(name).describe(writer);
    if (!options.attributes.empty()) {
      const auto& option = options.attributes[r.below(options.attributes.size())];
      const bool there = text.find(" " + option.name + "=") != std::string::npos;
      const bool costly = option.name.find("iterations") != std::string::npos;
      if (!there)
        text += " " + option.name + "=\"" + (costly ? std::to_string(1 + r.below(20)) : r.pick(kNasty)) + "\"";
    }
  }
  return text + ">" + inside + "</" + name + ">";
}

std::string engines(Bytes& r) {
  switch (r.below(5)) {
    case 0:
      return "";
    case 1: {  // two, side by side
      const std::string west =
          "<boundaries><sides><vertex point=\"-2,-2\"/><vertex point=\"0,-2\" gate=\"east\"/><vertex point=\"0,2\"/>"
          "<vertex point=\"-2,2\"/></sides></boundaries>";
      const std::string east =
          "<boundaries><sides><vertex point=\"0,-2\"/><vertex point=\"2,-2\"/><vertex point=\"2,2\"/>"
          "<vertex point=\"0,2\" gate=\"west\"/></sides></boundaries>";
      const std::string first = engine(r, "west", west);
      return "<physics_engines>" + first + engine(r, "east", east) + "</physics_engines>";
    }
    case 2: {  // one above the other
      const std::string ground = engine(r, "ground", "");
      return "<physics_engines>" + ground + "<particle3d id=\"air\"/></physics_engines>";
    }
    default:
      return "<physics_engines>" + engine(r, "all", "") + "</physics_engines>";
  }
}

std::string place(Bytes& r) {
  const std::string x = r.pick(kPlaces);
  const std::string y = r.pick(kPlaces);
  return x + "," + y + "," + r.pick(kHeights);
}

std::string thing(Bytes& r, int number, bool distributed) {
  const std::string id = "t" + std::to_string(number);
  const std::string body =
      distributed ? "" : "<body position=\"" + place(r) + "\" orientation=\"" + std::to_string(r.next()) + ",0,0\"/>";
  const std::string leds = r.one_in(4) ? "<leds><led offset=\"0.1,0,0.1\" color=\"red\"/></leds>" : "";
  const std::string movable = r.one_in(2) ? " movable=\"true\" mass=\"" + r.pick(kMasses) + "\"" : "";
  switch (r.below(6)) {
    case 0: {
      const std::string x = r.pick(kLengths);
      const std::string y = r.pick(kLengths);
      return "<box id=\"" + id + "\" size=\"" + x + "," + y + "," + r.pick(kLengths) + "\"" + movable + ">" + body +
             leds + "</box>";
    }
    case 1: {
      const std::string radius = r.pick(kLengths);
      return "<cylinder id=\"" + id + "\" radius=\"" + radius + "\" height=\"" + r.pick(kLengths) + "\"" + movable +
             ">" + body + leds + "</cylinder>";
    }
    case 2:
      return distributed ? "<light id=\"" + id + "\"/>" : "<light id=\"" + id + "\" position=\"" + place(r) + "\"/>";
    default: {
      const std::string kind(kKinds[r.below(kKinds.size())].name);
      return "<" + kind + " id=\"" + id + "\">" + body + "<controller config=\"" + kind + "\"/></" + kind + ">";
    }
  }
}

std::string arena(Bytes& r) {
  static constexpr std::array<std::string_view, 6> kSizes = {"4,4,3", "4,4,3",       "4,4,3",
                                                             "2,8,1", "0.5,0.5,0.5", "1000,3,3"};
  static constexpr std::array<std::string_view, 3> kEscapes = {"stop", "remove", "error"};
  std::string text = "<arena size=\"" + r.pick(kSizes) + "\" escape=\"" + r.pick(kEscapes) + "\">";
  if (r.one_in(4)) text += "<floor source=\"loop_functions\" pixels_per_meter=\"5\"/>";
  const std::size_t things = 1 + r.below(7);
  for (std::size_t i = 0; i < things; ++i) {
    const bool many = r.one_in(4);
    const std::string one = thing(r, static_cast<int>(i), many);
    text += !many ? one
                  : "<distribute><position method=\"uniform\" min=\"-1.5,-1.5,0\" max=\"1.5,1.5," + r.pick(kHeights) +
                        "\"/><orientation method=\"uniform\" min=\"0,0,0\" max=\"360,0,0\"/><entity quantity=\"" +
                        std::to_string(r.below(20)) + "\" max_trials=\"20\">" + one + "</entity></distribute>";
  }
  return text + "</arena>";
}

std::string experiment(Bytes& r) {
  std::string text = "<tandem><framework><experiment length=\"10\" random_seed=\"" + std::to_string(1 + r.below(3)) +
                     "\" ticks_per_second=\"" + r.pick(kRates) + "\"/></framework>";
  text += controllers(r) + engines(r) + arena(r);
  if (r.one_in(3))
    text += "<loop_functions library=\"test_hooks\" label=\"shepherd\" controller=\"e-puck\" movable=\"true\"/>";
  if (r.one_in(3)) text += "<loop_functions library=\"test_hooks\" label=\"painter\" shade=\"0.2\"/>";
  if (r.one_in(4)) text += "<media><led id=\"l\"/><range_and_bearing id=\"b\" check_occlusions=\"false\"/></media>";
  return text + "</tandem>";
}

/// Replaces the value of some attribute, or takes an element without others in it away.
void spoil(std::string& text, Bytes& r) {
  const std::size_t at = (r.next() * 256 + r.next()) % text.size();
  const std::size_t quote = text.find("=\"", at);
  if (quote == std::string::npos) return;
  const std::size_t end = text.find('"', quote + 2);
  if (r.one_in(5)) {
    const std::size_t last = text.find("/>", at);
    const std::size_t first = last == std::string::npos ? last : text.rfind('<', last);
    if (first != std::string::npos) text.erase(first, last + 2 - first);
    return;
  }
  text.replace(quote + 2, end - quote - 2, r.one_in(2) ? r.pick(kNasty) : r.pick(kLengths));
}

hal::PluginLoader& loader() {
  static hal::PluginLoader one({std::string(test::kBuildDir) + "/lib"}, test::catalog());
  return one;
}

/// Whether it is small enough to be tried.
bool bounded(const Scenario& s) {
  std::int64_t robots = 0;
  std::int64_t objects = 0;
  for (const RobotItem& item : s.robots) robots += item.distribute ? item.distribute->quantity : 1;
  for (const ObjectItem& item : s.objects) objects += item.distribute ? item.distribute->quantity : 1;
  for (const LightItem& item : s.lights) objects += item.distribute ? item.distribute->quantity : 1;
  const auto trials = [](const auto& items) {
    return std::all_of(items.begin(), items.end(),
                       [](const auto& item) { return !item.distribute || item.distribute->max_trials <= 1000; });
  };
  const Element& floor = s.fields.at(0);  // of five pixels a metre where hooks paint it
  const double pixels = 25.0 * s.arena_size[0] * s.arena_size[1];
  const bool painted = *floor.attribute("source") == "loop_functions";
  return robots <= kMostRobots && objects <= static_cast<std::int64_t>(kMostObjects) && trials(s.robots) &&
         trials(s.objects) && trials(s.lights) && (!painted || pixels <= 1e5 || pixels > 1e8);
}

/// Commands from the recipe, for robots whose controllers leave them to others.
void command(Space& space, Bytes& r) {
  static constexpr std::array<double, 6> kValues = {0.0, 0.1, -0.2, 1.0, 1e9, NAN};
  const auto value = [&] { return kValues[r.below(kValues.size())]; };
  for (std::size_t i = 0; i < space.robot_count() && !r.done(); ++i) {
    const RobotId robot = space.robot(i);
    if (auto* wheels = space.port<hal::WheelSpeeds>(robot)) wheels->set(value(), value());
    if (auto* speed = space.port<hal::QuadrotorSpeed>(robot)) speed->set(value(), value(), value(), value());
    if (auto* gripper = space.port<hal::GripperDrive>(robot)) gripper->aperture_rad = r.one_in(2) ? 1.0 : value();
    if (r.one_in(8)) space.set_halted(robot, r.one_in(2));
    if (r.one_in(16)) space.set_pose(robot, Pose::at(value(), value(), value()));
    if (r.one_in(16)) space.remove_robot(robot);
  }
}

void check_places(const World& world) {
  if (world.state() == RunState::Failed) {
    if (std::getenv("TANDEM_FUZZ_SHOW") != nullptr) std::fprintf(stderr, "%s\n", world.failure().c_str());
    expect(!world.failure().empty(), "a failed run says why");
    return;
  }
  const Space& space = world.space();
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const Pose pose = space.pose(space.robot(i));
    expect(std::isfinite(pose.x_m + pose.y_m + pose.z_m + pose.cos_h + pose.sin_h), "robots are somewhere");
  }
  for (const Object& o : space.objects())
    expect(!o.alive || std::isfinite(o.x_m + o.y_m + o.z_low_m + o.cos_h + o.sin_h), "objects are somewhere");
}

std::uint64_t stepped(World& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step();
  check_places(world);
  return world.state_hash();
}

std::unique_ptr<World> made(const Scenario& scenario, std::int64_t threads) {
  WorldOptions options;
  options.threads = threads;
  Problems problems;
  auto world = World::make(scenario, loader(), options, problems);
  expect((world != nullptr) != has_errors(problems), "an error is said exactly when there is no world");
  for (const Problem& p : problems) expect(!p.message.empty(), "problems are said");
  return world;
}

void try_out(const std::string& text, Bytes& r) {
  Problems problems;
  const auto scenario = read_experiment_text(text, "fuzz.xml", {}, test::catalog(), problems);
  expect(scenario.has_value() != has_errors(problems), "an error is said exactly when there is no scenario");
  if (std::getenv("TANDEM_FUZZ_SHOW") != nullptr) {
    std::fprintf(stderr, "%s\n", text.c_str());
    for (const Problem& p : problems) std::fprintf(stderr, "%s\n", to_text(p).c_str());
  }
  if (!scenario || !bounded(*scenario)) return;
  const auto world = made(*scenario, 0);
  if (!world) return;
  const int steps = 1 + static_cast<int>(r.below(kMostSteps));
  const std::size_t also = r.below(8);
  world->start();
  const std::uint64_t first = stepped(*world, steps);
  if (also == 0) {
    const auto other = made(*scenario, 3);
    other->start();
    expect(stepped(*other, steps) == first, "threads make no difference");
  }
  if (also == 1) {
    Problems again;
    const auto saved =
        read_experiment_text(effective_settings(world->scenario()), "saved.xml", {}, test::catalog(), again);
    expect(saved.has_value(), "saved settings read back");
    const auto other = made(*saved, 0);
    expect(other != nullptr, "saved settings make a world");
    other->start();
    expect(stepped(*other, steps) == first, "saved settings give the same bits");
  }
  if (also == 2) {
    const auto kept = world->snapshot();
    expect(kept.ok(), "these controllers can be copied");
    const std::uint64_t later = stepped(*world, 3);
    expect(world->restore(kept.value()).ok(), "a snapshot is taken back");
    expect(stepped(*world, 3) == later, "a restored run goes on alike");
  }
  for (int i = 0; i < 3 && !r.done(); ++i) {
    command(world->space(), r);
    (void)stepped(*world, 2);
  }
  world->finish();
}

}  // namespace

/// Hooks bring copies of core's type information along: that is no violation of the one-definition rule.
extern "C" const char* __asan_default_options() {  // NOLINT(bugprone-reserved-identifier)
  return "detect_odr_violation=0";
}
/// Where ODE gives up it loses some bytes of its own.
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "leak:libode";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes recipe({data, size});
  const std::size_t spoils = recipe.below(4);
  std::string text = experiment(recipe);
  for (std::size_t i = 0; i < spoils; ++i) spoil(text, recipe);
  try_out(text, recipe);
  return 0;
}
