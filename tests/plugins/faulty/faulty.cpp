// Parts with one fault each, for `tandem plugin check` to find. "blameless" has none.
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <unistd.h>
#include <vector>

#include "bridges/bridge_type.hpp"
#include "core/device/coupling.hpp"
#include "core/device/describe.hpp"
#include "core/physics/solver.hpp"
#include "hal/plugin.hpp"
#include "hal/robot/epuck.hpp"

namespace {

using namespace tandem;

// --- sensors, each with a port of its own ---

enum class Fault { None, HiddenState, Allocation, Threads, Chance, NoStamp, NotFinite, NoText, LooseState };

constexpr std::string_view name_of(Fault fault) {
  constexpr std::string_view kNames[] = {"blameless", "hidden_state", "allocation", "threads",    "chance",
                                         "no_stamp",  "not_finite",   "no_text",    "loose_state"};
  return kNames[static_cast<int>(fault)];
}

template <Fault kFault>
struct Port : hal::Reading {
  static constexpr std::string_view kName = name_of(kFault);
  static constexpr std::string_view kDoc = "A number.";
  double value = 0.0;
  void describe(hal::FieldList& f) const {
    f.add("value", value, hal::unit::none, hal::Frame::None, hal::Fusion::Real,
          kFault == Fault::NoText ? "" : "a number");
  }
};

struct Kept {
  static constexpr std::string_view kName = "loose_state";
  static constexpr std::string_view kDoc = "Counts, and does not say all.";
  std::uint32_t described = 0, loose = 0, loose_too = 0, last = 0;
  void describe(hal::FieldList& f) const {
    f.add("described", described, hal::unit::none, "how often it was read");
    f.add("last", last, hal::unit::none, "the same");
  }
};

std::atomic<int> readings{0};  // of the whole process

template <Fault kFault>
class FaultySensor final : public core::Sensor {
 public:
  explicit FaultySensor(Kept* kept) : kept_(kept) {}
  void sense(const core::DeviceContext& context, void* ports) noexcept override {
    for (std::size_t i = 0; i < context.block.used; ++i) {
      Port<kFault>& port = static_cast<Port<kFault>*>(ports)[i];
      if (kFault != Fault::NoStamp) core::stamp(context, port);
      port.value = static_cast<double>(context.tick);
      if (kFault == Fault::HiddenState) port.value = ++count_;
      if (kFault == Fault::Allocation) port.value = static_cast<double>(std::vector<int>(100 + i).size());
      if (kFault == Fault::Threads) port.value = ::gettid() == ::getpid() ? 1.0 : 2.0;
      if (kFault == Fault::Chance) port.value = readings++;
      if (kFault == Fault::NotFinite) port.value = std::numeric_limits<double>::quiet_NaN();
      if (kFault == Fault::LooseState) {
        ++kept_[i].described;
        ++kept_[i].last;
        kept_[i].loose_too = ++kept_[i].loose;
      }
    }
  }

 private:
  int count_ = 0;
  Kept* kept_;
};

struct NoOptions {
  void describe(hal::ParamVisitor&) {}
};

template <Fault kFault>
void add_sensor(hal::Registrar& registrar) {
  static const core::DeviceType type = core::sensor_type(
      Port<kFault>::kName, "default", "Has a fault.", [](const hal::RobotKind&) { return true; },
      [](const core::Element& element, core::Problems& problems,
         const core::DeviceSetup&) -> core::BlockFactory<core::Sensor> {
        core::read_options<NoOptions>(element, problems);
        const auto make = [](const core::BlockColumns& columns) {
          return std::make_unique<FaultySensor<kFault>>(columns.find<Kept>());
        };
        if (kFault == Fault::LooseState) return {make, {core::keeps<Kept>()}};
        return make;
      },
      &core::describe_options<NoOptions>);
  registrar.add(hal::port_type<Port<kFault>>());
  registrar.add(type);
}

// --- commands ---

/// Lets through what is no number.
struct Unlimited : hal::Command {
  static constexpr std::string_view kName = "unlimited";
  static constexpr std::string_view kDoc = "A number.";
  double value = 0.0;
  using LimitedBy = hal::RobotKind;
  hal::Limited limit(const hal::RobotKind&) noexcept {
    if (!(value > 1.0)) return hal::kPassed;
    value = 1.0;
    return hal::kClamped;
  }
  void describe(hal::FieldList& f) const {
    f.add("value", value, hal::unit::none, hal::Frame::None, hal::Fusion::Real, "a number");
  }
};

class Ignoring final : public core::Actuator {
 public:
  void act(const core::DeviceContext&, core::SpaceStores&, const void*) noexcept override {}
};

const core::DeviceType& unlimited_type() {
  static const core::DeviceType type = core::actuator_type(
      Unlimited::kName, "default", "Does nothing.", [](const hal::RobotKind&) { return true; },
      [](const core::Element& element, core::Problems& problems,
         const core::DeviceSetup&) -> core::BlockFactory<core::Actuator> {
        core::read_options<NoOptions>(element, problems);
        return [](const core::BlockColumns&) { return std::make_unique<Ignoring>(); };
      },
      &core::describe_options<NoOptions>);
  return type;
}

// --- a coupling that moves robots that it has nothing to do with ---

class Meddling final : public core::Coupling {
 public:
  void after_physics(core::SpaceStores& stores, double /*tick_s*/) noexcept override {
    if (stores.bodies.size() > 0) stores.bodies.left_m[0] += 0.001;
  }
};
constexpr core::CouplingType kMeddling{
    "meddling", "Turns a wheel of the first robot.",
    [](core::Columns&) -> std::unique_ptr<core::Coupling> { return std::make_unique<Meddling>(); }};

// --- an engine that moves robots whose pose is set from outside ---

class Pusher final : public core::Solver {
 public:
  void load(const core::SolverContext&) override {}
  void advance(const core::SolverContext& context) override {
    for (const core::BodyKey body : context.region.owned) {
      if (!body.is_object()) context.stores.bodies.x_m[body.index()] += 0.001;
    }
  }
};

const core::EngineType& pusher() {
  static const core::EngineType type = [] {
    core::EngineType t;
    t.kind = "pusher";
    t.summary = "Pushes everybody east.";
    t.read = [](const core::Element&, core::Problems&) -> std::shared_ptr<const void> {
      return std::make_shared<int>(0);
    };
    t.describe = [](hal::ParamVisitor&) {};
    t.make_solver = [](const std::shared_ptr<const void>&, const core::SpaceStores&, const core::Region&,
                       double) -> std::unique_ptr<core::Solver> { return std::make_unique<Pusher>(); };
    t.make = &core::make_solvers;
    return t;
  }();
  return type;
}

// --- a bridge whose robots nobody can stop ---

const hal::RobotKind& runaway() {
  static const hal::RobotKind kind = [] {
    hal::RobotKind made = hal::epuck::kind();
    made.name = "runaway";
    made.summary = "";  // another fault
    return made;
  }();
  return kind;
}

const bridges::BridgeType kBridge{.name = "runaway",
                                  .summary = "anything",
                                  .make = [](const bridges::BridgeRequest&, const hal::Log&) -> bridges::MadeBridge {
                                    return hal::Error{"there is none"};
                                  },
                                  .check = [](const bridges::BridgeRequest&) { return hal::Status{}; }};

void register_all(hal::Registrar& registrar) {
  add_sensor<Fault::None>(registrar);
  add_sensor<Fault::HiddenState>(registrar);
  add_sensor<Fault::Allocation>(registrar);
  add_sensor<Fault::Threads>(registrar);
  add_sensor<Fault::Chance>(registrar);
  add_sensor<Fault::NoStamp>(registrar);
  add_sensor<Fault::NotFinite>(registrar);
  add_sensor<Fault::NoText>(registrar);
  add_sensor<Fault::LooseState>(registrar);
  registrar.add(hal::port_type<Unlimited>());
  registrar.add(unlimited_type());
  registrar.add(kMeddling);
  core::register_engine(registrar, pusher());
  registrar.add(runaway());
  registrar.add(kBridge);
}

}  // namespace

TANDEM_PLUGIN(register_all)
