// A plug-in that brings what no folder of the program has: a thermometer, as port, device and coupling, and a
// controller that reads it.
#include <cmath>
#include <memory>

#include "core/device/coupling.hpp"
#include "core/device/describe.hpp"
#include "hal/device/wheels.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem;

// --- what a controller sees ---

/// How warm the robot's body is.
struct Thermometer : hal::Reading {
  static constexpr std::string_view kName = "thermometer";
  static constexpr std::string_view kDoc = "Temperature of the robot's body.";
  static constexpr hal::Unit kKelvin{hal::Dim::None, "K", 1.0};

  double temperature_K = 0.0;

  void describe(hal::FieldList& f) const {
    f.add("temperature", temperature_K, kKelvin, hal::Frame::None, hal::Fusion::Real, "of the body");
  }
};

/// Drives, the slower the warmer it is.
class Basker final : public hal::Controller {
 public:
  explicit Basker(hal::Robot& robot)
      : thermometer_(robot.sensor<Thermometer>()), wheels_(robot.actuator<hal::WheelSpeeds>()) {
    robot.publish("temperature", temperature_K_);
  }
  void step() override {
    temperature_K_ = thermometer_.temperature_K;
    const double eager = temperature_K_ > 300.0 ? 300.0 / temperature_K_ : 1.0;
    wheels_.set(0.08 * eager, 0.05 * eager);
  }

 private:
  const Thermometer& thermometer_;
  hal::WheelSpeeds& wheels_;
  double temperature_K_ = 0.0;
};

// --- what the simulation keeps, and how it changes ---

constexpr double kAmbient_K = 293.0;

struct Warmth {
  static constexpr std::string_view kName = "warmth";
  static constexpr std::string_view kDoc = "What bodies have taken up from lamps.";
  double temperature_K = kAmbient_K;
  void describe(hal::FieldList& f) const { f.add("temperature", temperature_K, Thermometer::kKelvin, "of the body"); }
};

/// Lamps warm bodies, the air cools them.
class Warming final : public core::Coupling {
 public:
  explicit Warming(core::Columns& columns) : warmth_(columns.of<Warmth>()) {}

  void after_physics(core::SpaceStores& stores, double tick_s) noexcept override {
    if (warmth_.empty()) return;
    constexpr double kTakesUp_K_s = 20.0, kLoses_per_s = 0.2;
    for (std::size_t row = 0; row < stores.bodies.size(); ++row) {
      Warmth* const warmth = stores.state_of(warmth_, row);
      if (warmth == nullptr || (stores.bodies.flags[row] & core::kAlive) == 0) continue;
      double power_K_s = kLoses_per_s * (kAmbient_K - warmth->temperature_K);
      for (const core::LightSource& lamp : stores.lights) {
        if (!lamp.alive) continue;
        const double x_m = lamp.x_m - stores.bodies.x_m[row], y_m = lamp.y_m - stores.bodies.y_m[row];
        power_K_s += kTakesUp_K_s * lamp.intensity / (1.0 + x_m * x_m + y_m * y_m);
      }
      warmth->temperature_K += power_K_s * tick_s;
    }
  }

 private:
  core::Column<Warmth> warmth_;
};

constexpr core::CouplingType kWarming{
    "warming", "Lamps warm robots with thermometers.",
    [](core::Columns& columns) -> std::unique_ptr<core::Coupling> { return std::make_unique<Warming>(columns); }};

// --- the device ---

/// How well a kind's thermometer is made. Kinds without the part have one that shows what is.
struct ThermometerPart {
  static constexpr std::string_view kName = "thermometer";
  static constexpr std::string_view kDoc = "A thermometer in the body.";
  double offset_K = 0.0;
  std::string source = {};
  void describe(hal::ParamVisitor& v) {
    v.number("offset", offset_K, Thermometer::kKelvin, {-1000.0, 1000.0}, "What it shows too much.");
    v.text("source", source, "Where these figures come from.");
  }
  std::string flaw() const {
    return offset_K > 500.0 ? "shows more than anybody believes; give it a smaller offset" : "";
  }
};

struct Options {
  double offset_K = 0.0;
  void describe(hal::ParamVisitor& v) {
    v.number("offset", offset_K, Thermometer::kKelvin, hal::kAny, "What it shows too much.");
  }
};

class ThermometerSensor final : public core::Sensor {
 public:
  ThermometerSensor(double offset_K, const core::BlockColumns& columns)
      : offset_K_(offset_K), warmth_(columns.find<Warmth>()) {}

  void sense(const core::DeviceContext& context, void* ports) noexcept override {
    auto* const thermometers = static_cast<Thermometer*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      core::stamp(context, thermometers[i]);
      thermometers[i].temperature_K = warmth_[i].temperature_K + offset_K_;
    }
  }

 private:
  double offset_K_;
  const Warmth* warmth_;
};

core::BlockFactory<core::Sensor> make_thermometer(const core::Element& element, core::Problems& problems,
                                                  const core::DeviceSetup& setup) {
  const auto options = core::read_options<Options>(element, problems);
  const auto* const part = setup.kind.part<ThermometerPart>();
  const auto make = [offset_K = options.offset_K +
                                (part != nullptr ? part->offset_K : 0.0)](const core::BlockColumns& columns) {
    return std::make_unique<ThermometerSensor>(offset_K, columns);
  };
  return {make, {core::keeps<Warmth>()}};
}

void register_all(hal::Registrar& registrar) {
  static const core::DeviceType device = core::sensor_type(
      Thermometer::kName, "default", "The body's temperature, at once.", [](const auto& /*robot*/) { return true; },
      &make_thermometer, &core::describe_options<Options>);
  registrar.add(hal::port_type<Thermometer>());
  registrar.add(hal::part_type<ThermometerPart>());
  registrar.add(device);
  registrar.add(kWarming);
  registrar.add_controller<Basker>("basker", "Drives, the slower the warmer it is.");
}

}  // namespace

TANDEM_PLUGIN(register_all)
