// A plug-in with a robot on which things move: a mast that turns, a boom that slides out of it, a hook, two lamps.
#include <cmath>
#include <memory>

#include "core/device/coupling.hpp"
#include "core/device/describe.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem;

struct CranePart {
  static constexpr std::string_view kName = "crane";
  static constexpr std::string_view kDoc = "A mast with a boom.";
  double reach_m = 0.0;
  std::string source = {};
  void describe(hal::ParamVisitor& v) {
    v.number("reach", reach_m, hal::unit::m, hal::kNotNegative, "Of the boom.");
    v.text("source", source, "Where these figures come from.");
  }
  void appear(const hal::RobotKind& kind, hal::Appearance& look) const {
    const double h = kind.body.height_m;
    look.joints.push_back({.name = "boom",
                           .slides = true,
                           .axis = {1.0, 0.0, 0.0},
                           .by = {"crane", "places", 1},
                           .scale = 0.5,
                           .on = "mast"});
    look.joints.push_back({.name = "mast", .at_m = {0.02, 0.0, 0.0}, .by = {"crane", "places", 0}});
    look.links.push_back({.name = "arm", .low_m = {0.0, -0.01, h}, .high_m = {reach_m, 0.01, h + 0.02}, .on = "boom"});
    look.links.push_back({.name = "hook",
                          .shape = "cylinder",
                          .low_m = {reach_m - 0.02, -0.01, h - 0.02},
                          .high_m = {reach_m, 0.01, h},
                          .on = "boom",
                          .held = {"crane", "load", 0, true, 7.0}});
    look.lamps.push_back({.at_m = {0.0, 0.0, h + 0.02}, .on = "mast", .by = {"actuator crane", "lamp"}});
    look.lamps.push_back({.at_m = {reach_m, 0.0, h}, .on = "boom", .by = {"crane", "works"}, .color = "#ff8800"});
    look.upper = "mast";
  }
};

struct CraneDrive : hal::Command {
  static constexpr std::string_view kName = "crane";
  static constexpr std::string_view kDoc = "Where mast and boom are to be.";
  static constexpr bool kAnyValueIsSafe = true;
  double mast_rad = 0.0, boom_m = 0.0;
  std::array<std::uint8_t, 3> lamp{};
  void describe(hal::FieldList& f) const {
    f.add("mast", mast_rad, hal::unit::rad, hal::Frame::Body, hal::Fusion::Real, "angle");
    f.add("boom", boom_m, hal::unit::m, hal::Frame::Body, hal::Fusion::Real, "length");
    f.add("lamp", lamp, hal::unit::none, hal::Frame::Body, hal::Fusion::Real, "r, g, b");
  }
};

struct CraneState {
  static constexpr std::string_view kName = "crane";
  static constexpr std::string_view kDoc = "Where cranes are.";
  std::array<double, 2> places{};
  std::uint32_t load = 7;  // 7: none
  bool works = false;
  void describe(hal::FieldList& f) const {
    f.add("places", places, hal::unit::none, "of mast and boom");
    f.add("load", load, hal::unit::none, "what hangs on the hook; 7: nothing");
    f.add("works", works, hal::unit::none, "it moves");
  }
};

class CraneActuator final : public core::Actuator {
 public:
  explicit CraneActuator(CraneState* cranes) : cranes_(cranes) {}
  void act(const core::DeviceContext& context, core::SpaceStores&, const void* ports) noexcept override {
    const auto* const drives = static_cast<const CraneDrive*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      CraneState& crane = cranes_[i];
      crane.works = core::obeys(context, i) && drives[i].mast_rad != crane.places[0];
      if (crane.works) crane.places = {drives[i].mast_rad, drives[i].boom_m};
      crane.load = crane.places[1] > 0.1 ? 3 : 7;
    }
  }

 private:
  CraneState* cranes_;
};

class CraneDriver final : public hal::Controller {
 public:
  explicit CraneDriver(hal::Robot& robot) : crane_(robot.actuator<CraneDrive>()) {}
  void step() override {
    crane_.mast_rad += 0.01;
    crane_.boom_m += 0.0025;
    crane_.lamp = {0x10, 0x20, 0x30};
  }

 private:
  CraneDrive& crane_;
};

hal::RobotKind crane() {
  hal::RobotKind kind;
  kind.name = "crane";
  kind.summary = "It stands, and turns its mast.";
  kind.body = {.radius_m = 0.1, .height_m = 0.1, .mass_kg = 5.0, .source = "chosen"};
  kind.add(CranePart{.reach_m = 0.2, .source = "chosen"});
  return kind;
}

void register_all(hal::Registrar& registrar) {
  static const hal::RobotKind robot = crane();
  static const core::DeviceType device = [] {
    struct None {
      void describe(hal::ParamVisitor&) {}
    };
    const auto make = [](const core::Element& element, core::Problems& problems,
                         const core::DeviceSetup&) -> core::BlockFactory<core::Actuator> {
      core::read_options<None>(element, problems);
      return {
          [](const core::BlockColumns& columns) { return std::make_unique<CraneActuator>(columns.find<CraneState>()); },
          {core::keeps<CraneState>()}};
    };
    return core::actuator_type(CraneDrive::kName, "default", "Moves mast and boom.", &core::has<CranePart>, make,
                               &core::describe_options<None>);
  }();
  registrar.add(hal::part_type<CranePart>());
  registrar.add(hal::port_type<CraneDrive>());
  registrar.add(device);
  registrar.add(robot);
  registrar.add_controller<CraneDriver>("crane_driver", "Turns the mast and moves the boom.");
}

}  // namespace

TANDEM_PLUGIN(register_all)
