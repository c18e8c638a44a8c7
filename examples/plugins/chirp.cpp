// A medium: robots chirp, and hear how loud others are, the less the farther they are. Two devices work in it.
#include <algorithm>
#include <cmath>

#include "core/device/describe.hpp"
#include "core/medium/medium.hpp"
#include "hal/device/wheels.hpp"
#include "hal/elementary.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem;

constexpr double kHeard_m = 1.0;  // farther chirps are lost in the noise
constexpr double kNear_m = 0.1;   // at this distance half of it is left

// --- what controllers command and read ---

struct Chirper : hal::Command {
  static constexpr std::string_view kName = "chirper";
  static constexpr std::string_view kDoc = "How loud the robot chirps.";
  float loudness = 0.0F;

  using LimitedBy = hal::RobotKind;  // no part of theirs: all robots chirp alike
  hal::Limited limit(const hal::RobotKind&) noexcept {
    if (loudness >= 0.0F && loudness <= 1.0F) return hal::kPassed;
    if (!std::isfinite(loudness)) {
      *this = {};
      return hal::kNotFinite;
    }
    loudness = std::clamp(loudness, 0.0F, 1.0F);
    return hal::kClamped;
  }
  void describe(hal::FieldList& f) const {
    f.add("loudness", loudness, hal::unit::none, hal::Frame::None, hal::Fusion::Real, "0 silent; 1 loud");
  }
};

struct ChirpSensor : hal::Reading {
  static constexpr std::string_view kName = "chirps";
  static constexpr std::string_view kDoc = "The loudest chirp of another robot.";
  float loudness = 0.0F, bearing_rad = 0.0F;
  std::uint32_t heard = 0;
  void describe(hal::FieldList& f) const {
    f.add("loudness", loudness, hal::unit::none, hal::Frame::None, hal::Fusion::Real, "of the loudest, as it arrives");
    f.add("bearing", bearing_rad, hal::unit::rad, hal::Frame::Body, hal::Fusion::Real, "from where it comes");
    f.add("heard", heard, hal::unit::none, hal::Frame::None, hal::Fusion::Real, "robots that are heard");
  }
};

// --- the medium: every robot that chirps has a row, which it writes in every tick ---

class ChirpMedium final : public core::RowMedium<float> {
 public:
  static constexpr std::string_view kKind = "chirps";
};

constexpr core::MediumType kMedium{ChirpMedium::kKind, "Chirps, heard by distance.", [](hal::ParamVisitor&) {},
                                   []() -> std::unique_ptr<core::Medium> { return std::make_unique<ChirpMedium>(); }};

// --- the devices ---

struct Options {
  std::string medium;
  void describe(hal::ParamVisitor& v) { v.text("medium", medium, "Id of the <chirps> medium."); }
};

class ChirpActuator final : public core::Actuator {
 public:
  explicit ChirpActuator(ChirpMedium& medium) : medium_(medium) {}
  void act(const core::DeviceContext& context, core::SpaceStores&, const void* ports) noexcept override {
    float* const rows = medium_.publish(context.block);
    if (rows == nullptr) return;  // nobody listens
    for (std::size_t i = 0; i < context.block.used; ++i)
      rows[i] = core::obeys(context, i) ? static_cast<const Chirper*>(ports)[i].loudness : 0.0F;
  }

 private:
  ChirpMedium& medium_;
};

class ChirpListener final : public core::Sensor {
 public:
  explicit ChirpListener(const ChirpMedium& medium) : medium_(medium) {}
  void sense(const core::DeviceContext& context, void* ports) noexcept override {
    const core::Bodies& b = context.stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      ChirpSensor& port = static_cast<ChirpSensor*>(ports)[i];
      port.loudness = port.bearing_rad = 0.0F;
      port.heard = 0;
      core::stamp(context, port);
      // By rows of the index: an order that depends on the bodies alone, not on threads.
      context.stores.body_index.for_each_near(b.x_m[row], b.y_m[row], kHeard_m, [&](const core::IndexEntry& other) {
        const double dx = other.x_m - b.x_m[row], dy = other.y_m - b.y_m[row];
        const double distance_m = hal::hypot(dx, dy);
        const float sent = medium_.of(other.row());
        if (other.row() == row || sent <= 0.0F || distance_m > kHeard_m) return;
        ++port.heard;
        const auto arrives = static_cast<float>(sent / (1.0 + distance_m / kNear_m));
        if (arrives <= port.loudness) return;
        port.loudness = arrives;
        const double c = b.cos_h[row], s = b.sin_h[row];
        port.bearing_rad = static_cast<float>(hal::atan2(c * dy - s * dx, c * dx + s * dy));
      });
    }
  }

 private:
  const ChirpMedium& medium_;
};

core::BlockFactory<core::Actuator> make_chirper(const core::Element& element, core::Problems& problems,
                                                const core::DeviceSetup& setup) {
  core::read_options<Options>(element, problems);
  core::BlockFactory<core::Actuator> factory = [&medium = setup.medium_as<ChirpMedium>()](const core::BlockColumns&) {
    return std::make_unique<ChirpActuator>(medium);
  };
  factory.publishes = true;
  return factory;
}

core::BlockFactory<core::Sensor> make_listener(const core::Element& element, core::Problems& problems,
                                               const core::DeviceSetup& setup) {
  core::read_options<Options>(element, problems);
  core::BlockFactory<core::Sensor> factory = [&medium = setup.medium_as<ChirpMedium>()](const core::BlockColumns&) {
    return std::make_unique<ChirpListener>(medium);
  };
  factory.listens = true;
  factory.reach_m = kHeard_m;
  return factory;
}

// --- a controller: robots turn towards the loudest ---

class Gather final : public hal::Controller {
 public:
  explicit Gather(hal::Robot& robot)
      : chirper_(robot.actuator<Chirper>()),
        chirps_(robot.sensor<ChirpSensor>()),
        wheels_(robot.actuator<hal::WheelSpeeds>()) {}
  void step() override {
    chirper_.loudness = 1.0F;
    const double turn = chirps_.heard == 0 ? 0.01 : 0.02 * static_cast<double>(chirps_.bearing_rad);
    wheels_.set(0.05 - turn, 0.05 + turn);
  }

 private:
  Chirper& chirper_;
  const ChirpSensor& chirps_;
  hal::WheelSpeeds& wheels_;
};

void register_all(hal::Registrar& registrar) {
  const auto any_robot = [](const hal::RobotKind&) { return true; };
  static const core::DeviceType chirper = core::in_medium(
      ChirpMedium::kKind, core::actuator_type(Chirper::kName, "default", "Chirps in every tick.", any_robot,
                                              &make_chirper, &core::describe_options<Options>));
  static const core::DeviceType listener = core::in_medium(
      ChirpMedium::kKind, core::sensor_type(ChirpSensor::kName, "default", "Hears the chirps of others.", any_robot,
                                            &make_listener, &core::describe_options<Options>));
  registrar.add(kMedium);
  registrar.add(hal::port_type<Chirper>());
  registrar.add(hal::port_type<ChirpSensor>());
  registrar.add(chirper);
  registrar.add(listener);
  registrar.add_controller<Gather>("gather", "Drives to the loudest neighbour.");
}

}  // namespace

TANDEM_PLUGIN(register_all)
