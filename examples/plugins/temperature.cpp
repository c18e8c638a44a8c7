// A robot with a thermometer: the field that it measures, port, device, robot, and a controller that looks for warmth.
#include "core/device/describe.hpp"
#include "core/device/field_ring.hpp"
#include "core/field/point_field.hpp"
#include "core/scenario/field_type.hpp"
#include "hal/device/wheels.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem;

constexpr hal::Unit kCelsius{hal::Dim::None, "degC", 1.0};

// --- the field: <temperature ambient="18" stove="1,1,0" heat="60"/> in <arena> ---

struct Stove {
  double ambient_C = 18.0, heat_C = 60.0;
  std::array<double, 3> p_W{};
  void describe(hal::ParamVisitor& v) {
    v.number("ambient", ambient_C, kCelsius, {-50.0, 100.0}, "Far from the stove.");
    v.number("heat", heat_C, kCelsius, {0.0, 1000.0}, "By how much it is warmer at the stove.");
    v.vector("stove", p_W, hal::unit::m, "Where the stove stands.");
  }
};

class TemperatureField final : public core::PointField<TemperatureField> {
 public:
  using Params = Stove;
  TemperatureField(const Stove& stove, const core::FieldArea&) : stove_(stove) {}
  double at(const core::SpaceStores&, double x_m, double y_m, double) const noexcept override {
    const double dx = x_m - stove_.p_W[0], dy = y_m - stove_.p_W[1];
    return stove_.ambient_C + stove_.heat_C / (1.0 + dx * dx + dy * dy);
  }

 private:
  Stove stove_;
};

constexpr core::FieldType kField =
    core::field_type<TemperatureField>("temperature", "Temperature of the air: a stove warms it.");

// --- what the robot is built with, and what its controller reads ---

struct ThermometerPart {
  static constexpr std::string_view kName = "thermometer";
  static constexpr std::string_view kDoc = "Measures the temperature of the air.";
  double ahead_m = 0.0;  // of the robot's axis
  std::string source = {};
  void describe(hal::ParamVisitor& v) {
    v.number("ahead", ahead_m, hal::unit::m, hal::kAny, "How far it sits before the robot's axis.");
    v.text("source", source, "Where these figures come from.");
  }
};

struct Thermometer : hal::Reading {
  static constexpr std::string_view kName = "thermometer";
  static constexpr std::string_view kDoc = "Temperature of the air.";
  double temperature_C = 0.0;
  void describe(hal::FieldList& f) const {
    f.add("air", temperature_C, kCelsius, hal::Frame::None, hal::Fusion::Real, "its temperature at the sensor");
  }
};

// --- the device: fills the ports of a block of robots ---

struct Noise {
  double noise_C = 0.0;
  void describe(hal::ParamVisitor& v) {
    v.number("noise", noise_C, kCelsius, hal::kNotNegative, "Standard deviation of the reading.");
  }
};

class ThermometerSensor final : public core::Sensor {
 public:
  ThermometerSensor(const core::Field& field, const hal::Mount& mount, double noise_C)
      : ring_(field, {&mount, 1}), noise_C_(noise_C) {}
  void sense(const core::DeviceContext& context, void* ports) noexcept override {
    ring_.sample(context, [&](std::size_t i, const double* value) {
      Thermometer& port = static_cast<Thermometer*>(ports)[i];
      core::stamp(context, port);
      const std::uint32_t entity = context.stores.bodies.entity[context.block.first_row + i];
      const std::uint64_t seed = core::own_seed(context.seed, "thermometer");
      const auto bits = core::draw(seed, entity, core::Stream::Plugin, context.tick);
      port.temperature_C = *value + noise_C_ * core::to_normal(bits[0], bits[1])[0];
    });
  }

 private:
  core::FieldRing ring_;
  double noise_C_;
};

core::BlockFactory<core::Sensor> make_thermometer(const core::Element& element, core::Problems& problems,
                                                  const core::DeviceSetup& setup) {
  const auto options = core::read_options<Noise>(element, problems);
  const core::Field* const field = setup.field("temperature", element, problems);
  const hal::Mount mount{.x_m = setup.kind.part<ThermometerPart>()->ahead_m, .z_m = 0.05};
  return [=](const core::BlockColumns&) { return std::make_unique<ThermometerSensor>(*field, mount, options.noise_C); };
}

// --- a controller: turns while it gets colder ---

class SeekWarmth final : public hal::Controller {
 public:
  explicit SeekWarmth(hal::Robot& robot)
      : thermometer_(robot.sensor<Thermometer>()), wheels_(robot.actuator<hal::WheelSpeeds>()) {}
  void step() override {
    wheels_.set(thermometer_.temperature_C >= before_C_ ? 0.1 : 0.03, 0.1);
    before_C_ = thermometer_.temperature_C;
  }

 private:
  const Thermometer& thermometer_;
  hal::WheelSpeeds& wheels_;
  double before_C_ = 0.0;
};

hal::RobotKind gardener() {
  hal::RobotKind kind;
  kind.name = "gardener";
  kind.summary = "A small robot on wheels with a thermometer.";
  kind.body = {.radius_m = 0.06, .height_m = 0.1, .mass_kg = 0.5, .source = "the drawing of its plate"};
  kind.locomotion = hal::DifferentialDrive{.wheel_radius_m = 0.02,
                                           .wheel_base_m = 0.1,
                                           .max_speed_m_s = 0.2,
                                           .force_N = 2.0,
                                           .torque_Nm = 0.1,
                                           .source = "data sheet of its motors"};
  kind.add(ThermometerPart{.ahead_m = 0.05, .source = "the drawing of its plate"});
  return kind;
}

void register_all(hal::Registrar& registrar) {
  static const hal::RobotKind robot = gardener();
  static const core::DeviceType device =
      core::sensor_type(Thermometer::kName, "default", "The temperature, with noise where asked for.",
                        &core::has<ThermometerPart>, &make_thermometer, &core::describe_options<Noise>);
  registrar.add(kField);
  registrar.add(hal::part_type<ThermometerPart>());  // so that files can give it to other robots
  registrar.add(hal::port_type<Thermometer>());
  registrar.add(device);
  registrar.add(robot);
  registrar.add_controller<SeekWarmth>("seek_warmth", "Looks for the warmest place.");
}

}  // namespace

TANDEM_PLUGIN(register_all)
