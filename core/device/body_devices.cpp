// Sensors of a robot's own state and of the air: turn rates, sound, battery, clock.
#include "core/device/each_robot.hpp"
#include "core/device/field_ring.hpp"
#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "core/space/mechanisms.hpp"
#include "core/space/sight.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/vector.hpp"

namespace tandem::core {
namespace {

/// From W to the body.
std::array<double, 3> to_body(const std::array<double, 4>& q_WB, const std::array<double, 3>& v_W) noexcept {
  return hal::array_of(hal::quaternion_of(q_WB).conjugate() * hal::vector_of(v_W));
}

/// 0: robots of this kind have no wheels.
double wheel_base_m(const hal::RobotKind& kind) noexcept {
  return kind.drive() != nullptr ? kind.drive()->wheel_base_m : 0.0;
}

// --- gyroscope ---

struct RateNoise {
  double noise_level_rad_s = 0.0;
  double bias_rad_s = 0.0;
  static RateNoise noisy() { return {.noise_level_rad_s = 20 * 1e-3}; }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_level", noise_level_rad_s, hal::unit::rad_s, hal::kNotNegative,
             "Standard deviation about each axis.");
    v.number("bias", bias_rad_s, hal::unit::rad_s, hal::kNotNegative,
             "Largest constant error about each axis; every robot has its own.");
  }
};

/// Turn rates as the body's engine knows them; one that has no forces turns bodies as their wheels say.
class GyroscopeSensor final : public EachSensor<GyroscopeSensor, hal::Gyroscope, RateNoise> {
 public:
  using Part = hal::GyroscopePart;

  GyroscopeSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : EachSensor(setup, errors, columns), wheel_base_m_(wheel_base_m(setup.kind)) {}

  void read(const RobotAt& robot, hal::Gyroscope& port) const noexcept {
    std::array<double, 3> rate = rates(robot.context.stores, robot.row());
    if (errors_.noise_level_rad_s > 0.0) {
      const auto bits = robot.draw(Stream::GyroscopeNoise);
      const auto xy = to_normal(bits[0], bits[1]);
      rate[0] += errors_.noise_level_rad_s * xy[0];
      rate[1] += errors_.noise_level_rad_s * xy[1];
      rate[2] += errors_.noise_level_rad_s * to_normal(bits[2], bits[3])[0];
    }
    if (errors_.bias_rad_s > 0.0) {
      const auto bits = draw(robot.context.seed, robot.bodies().entity[robot.row()], Stream::GyroscopeBias, 0);
      for (std::size_t k = 0; k < 3; ++k) rate[k] += errors_.bias_rad_s * to_symmetric(bits[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) port.rate_rad_s[k] = static_cast<float>(rate[k]);
  }

 private:
  std::array<double, 3> rates(const SpaceStores& stores, std::size_t row) const noexcept {
    const Bodies& b = stores.bodies;
    const std::uint16_t number = b.region[row];
    if (b.motion.empty() || number == kNoRegion || !stores.regions[number].listed) {
      const double turn = wheel_base_m_ > 0.0 ? (b.right_m_s[row] - b.left_m_s[row]) / wheel_base_m_ : 0.0;
      return {0.0, 0.0, turn};
    }
    const std::array<double, 3>& w = b.motion[row].w_rad_s;
    if (stores.regions[number].plane) return {0.0, 0.0, w[2]};
    return to_body(b.motion[row].q_WB, w);
  }

  double wheel_base_m_;
};

// --- microphones ---

constexpr ErrorText kSoundNoise{
    "noise_level", 20 * 1e-3, hal::unit::none, {0.0, 1.0}, "Background noise, 0 to this, on each microphone."};
using SoundNoise = OneError<kSoundNoise>;

/// At most 1.
class MicrophoneSensor final : public Sensor {
 public:
  using Port = hal::Microphones;
  using Part = hal::MicrophonesPart;
  using Errors = SoundNoise;
  static constexpr std::string_view kField = "sound";

  MicrophoneSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns&)
      : ring_(*setup.fields->find(kField), setup.kind.part<Part>()->mounts), noise_(errors.amount) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    ring_.sample(context, [&](std::size_t i, const double* values) {
      const std::uint32_t entity = context.stores.bodies.entity[context.block.first_row + i];
      const auto bits = noise_ > 0.0 ? draw(context.seed, entity, Stream::MicrophoneNoise, context.tick)
                                     : std::array<std::uint32_t, 4>{};
      hal::Microphones& port = static_cast<hal::Microphones*>(ports)[i];
      stamp(context, port);
      port.count = static_cast<std::uint32_t>(ring_.size());
      for (std::size_t k = 0; k < ring_.size(); ++k)
        port.level[k] = static_cast<float>(std::min(values[k] + noise_ * to_unit(bits[k % 4]), 1.0));
    });
  }

 private:
  FieldRing ring_;
  double noise_;
};

// --- battery ---

constexpr ErrorText kChargeNoise{
    "noise_range", 10 * 1e-3, hal::unit::none, {-1.0, 1.0}, "Uniform noise on the charge reading."};
using ChargeNoise = OneInterval<kChargeNoise>;

/// ARGoS' three discharge models: a part a tick, a part a metre and a radian moved, or both.
class BatterySensor final : public EachSensor<BatterySensor, hal::Battery, ChargeNoise, ChargeState> {
 public:
  using Part = hal::BatteryPart;
  static void prepare(BlockFactory<Sensor>& factory, const DeviceSetup& setup, const Errors&) {
    factory.columns = {keeps(ChargeState{setup.item->battery.start_charge})};
  }

  BatterySensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : EachSensor(setup, errors, columns),
        config_(setup.item->battery),
        part_(*setup.kind.part<Part>()),
        wheel_base_m_(wheel_base_m(setup.kind)),
        by_time_(config_.model != "motion"),
        by_motion_(config_.model != "time") {}

  void read(const RobotAt& robot, hal::Battery& port) const noexcept {
    double used = by_time_ ? config_.delta : 0.0;
    if (by_motion_) {
      const Way way = wheel_base_m_ > 0.0 ? rolled(robot.bodies(), robot.row()) : flown(robot.bodies(), robot.row());
      used += robot.context.tick_s * (config_.pos_delta * way.speed_m_s + config_.orient_delta * way.turn_rad_s);
    }
    double& charge = kept_[robot.i].charge;
    charge = std::max(0.0, charge - used);
    double read = config_.full_charge > 0.0 ? charge / config_.full_charge : 0.0;
    if (!errors_.amount.empty()) read += errors_.amount.at(to_symmetric(robot.draw(Stream::BatteryNoise)[0]));
    read = std::min(std::max(read, 0.0), 1.0);
    port.charge = static_cast<float>(read);
    port.supply_V = static_cast<float>(part_.empty_V + read * (part_.full_V - part_.empty_V));
  }

 private:
  struct Way {
    double speed_m_s = 0.0;
    double turn_rad_s = 0.0;
  };
  Way rolled(const Bodies& b, std::size_t row) const noexcept {
    return {std::fabs(0.5 * (b.left_m_s[row] + b.right_m_s[row])),
            std::fabs(b.right_m_s[row] - b.left_m_s[row]) / wheel_base_m_};
  }
  static Way flown(const Bodies& b, std::size_t row) noexcept {
    if (b.motion.empty()) return {};
    const Motion& m = b.motion[row];
    return {std::hypot(m.v_m_s[0], m.v_m_s[1], m.v_m_s[2]), std::fabs(m.w_rad_s[2])};
  }

  BatteryConfig config_;
  const hal::BatteryPart& part_;
  double wheel_base_m_;
  bool by_time_, by_motion_;
};

// --- clock ---

constexpr ErrorText kClockNoise{
    "jitter", 1000 * 1e-6, hal::unit::ms, {0.0, 1.0}, "Standard deviation of the time that is read; ticks stay exact."};
using ClockNoise = OneError<kClockNoise>;

class ClockSensor final : public EachSensor<ClockSensor, hal::Clock, ClockNoise> {
 public:
  using EachSensor::EachSensor;

  void read(const RobotAt& robot, hal::Clock& port) const noexcept {
    port.tick = robot.context.tick;
    port.now_ns = robot.context.now_ns;
    port.tick_s = robot.context.tick_s;
    if (errors_.amount <= 0.0) return;
    const auto bits = robot.draw(Stream::ClockNoise);
    port.now_ns += static_cast<hal::TimeNs>(std::llround(1e9 * errors_.amount * to_normal(bits[0], bits[1])[0]));
  }
};

}  // namespace

std::vector<DeviceType> body_device_types() {
  std::vector<DeviceType> types;
  add_levels<GyroscopeSensor>(types, "Turn rates of the body; noise and bias where asked for.",
                              "Turn rates of the body.",
                              "Turn rates of the body, with normal noise; bias where asked for.");
  add_levels<MicrophoneSensor>(types, "Sources around; noise where asked for.", "Sources around.",
                               "Sources around and background noise.");
  add_levels<BatterySensor>(types, "The robot's discharge model; noise where asked for.",
                            "The robot's discharge model.", "The robot's discharge model, with noise.");
  add_levels<ClockSensor>(types, "The run's time; jitter where asked for.", "The run's time.",
                          "The run's time, with jitter.");
  return types;
}

}  // namespace tandem::core
