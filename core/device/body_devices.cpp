// Sensors of a robot's own state and of the air: turn rates, sound, battery, clock.
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
class GyroscopeSensor final : public Sensor {
 public:
  using Port = hal::Gyroscope;
  using Part = hal::GyroscopePart;
  using Errors = RateNoise;

  GyroscopeSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns&)
      : wheel_base_m_(wheel_base_m(setup.kind)),
        noise_rad_s_(errors.noise_level_rad_s),
        bias_rad_s_(errors.bias_rad_s) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* gyroscopes = static_cast<hal::Gyroscope*>(ports);
    const Bodies& b = context.stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      std::array<double, 3> rate = rates(context.stores, row);
      if (noise_rad_s_ > 0.0) {
        const auto bits = draw(context.seed, b.entity[row], Stream::GyroscopeNoise, context.tick);
        const auto xy = to_normal(bits[0], bits[1]);
        rate[0] += noise_rad_s_ * xy[0];
        rate[1] += noise_rad_s_ * xy[1];
        rate[2] += noise_rad_s_ * to_normal(bits[2], bits[3])[0];
      }
      if (bias_rad_s_ > 0.0) {
        const auto bits = draw(context.seed, b.entity[row], Stream::GyroscopeBias, 0);
        for (std::size_t k = 0; k < 3; ++k) rate[k] += bias_rad_s_ * to_symmetric(bits[k]);
      }
      stamp(context, gyroscopes[i]);
      for (std::size_t k = 0; k < 3; ++k) gyroscopes[i].rate_rad_s[k] = static_cast<float>(rate[k]);
    }
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
  double noise_rad_s_;
  double bias_rad_s_;
};

// --- microphones ---

struct SoundNoise {
  double noise_level = 0.0;
  static SoundNoise noisy() { return {.noise_level = 20 * 1e-3}; }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_level", noise_level, hal::unit::none, {0.0, 1.0},
             "Background noise, 0 to this, on each microphone.");
  }
};

/// At most 1.
class MicrophoneSensor final : public Sensor {
 public:
  using Port = hal::Microphones;
  using Part = hal::MicrophonesPart;
  using Errors = SoundNoise;
  static constexpr std::string_view kField = "sound";

  MicrophoneSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns&)
      : ring_(*setup.fields->find(kField), setup.kind.part<Part>()->mounts), noise_(errors.noise_level) {}

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

struct ChargeNoise {
  double noise_range = 0.0;
  static ChargeNoise noisy() { return {.noise_range = 10 * 1e-3}; }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_range", noise_range, hal::unit::none, {0.0, 1.0}, "Uniform noise of +-this on the charge reading.");
  }
};

/// ARGoS' three discharge models: a part a tick, a part a metre and a radian moved, or both.
class BatterySensor final : public Sensor {
 public:
  using Port = hal::Battery;
  using Part = hal::BatteryPart;
  using Errors = ChargeNoise;
  static void prepare(BlockFactory<Sensor>& factory, const DeviceSetup& setup, const Errors&) {
    factory.columns = {keeps(ChargeState{setup.item->battery.start_charge})};
  }

  BatterySensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : config_(setup.item->battery),
        noise_(errors.noise_range),
        full_V_(setup.kind.part<hal::BatteryPart>()->full_V),
        empty_V_(setup.kind.part<hal::BatteryPart>()->empty_V),
        wheel_base_m_(wheel_base_m(setup.kind)),
        charges_(columns.find<ChargeState>()) {
    by_time_ = config_.model != "motion";
    by_motion_ = config_.model != "time";
  }

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* batteries = static_cast<hal::Battery*>(ports);
    const Bodies& b = context.stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      double used = by_time_ ? config_.delta : 0.0;
      if (by_motion_) {
        const Way way = wheel_base_m_ > 0.0 ? rolled(b, row) : flown(b, row);
        used += context.tick_s * (config_.pos_delta * way.speed_m_s + config_.orient_delta * way.turn_rad_s);
      }
      double& charge = charges_[i].charge;
      charge = std::max(0.0, charge - used);
      double read = config_.full_charge > 0.0 ? charge / config_.full_charge : 0.0;
      if (noise_ > 0.0) {
        const auto bits = draw(context.seed, b.entity[row], Stream::BatteryNoise, context.tick);
        read += noise_ * (2.0 * to_unit(bits[0]) - 1.0);
      }
      read = std::min(std::max(read, 0.0), 1.0);
      hal::Battery& port = batteries[i];
      port.taken_ns = context.now_ns;
      port.validity = hal::Validity::Fresh;
      port.charge = static_cast<float>(read);
      port.supply_V = static_cast<float>(empty_V_ + read * (full_V_ - empty_V_));
    }
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
  double noise_;
  double full_V_, empty_V_, wheel_base_m_;
  ChargeState* charges_;
  bool by_time_ = true;
  bool by_motion_ = false;
};

// --- clock ---

struct ClockNoise {
  double jitter_s = 0.0;
  static ClockNoise noisy() { return {.jitter_s = 1000 * 1e-6}; }
  void describe(hal::ParamVisitor& v) {
    v.number("jitter", jitter_s, hal::unit::ms, {0.0, 1.0},
             "Standard deviation of the time that is read; ticks stay exact.");
  }
};

class ClockSensor final : public Sensor {
 public:
  using Port = hal::Clock;
  using Errors = ClockNoise;

  ClockSensor(const DeviceSetup&, const Errors& errors, const BlockColumns&) : jitter_s_(errors.jitter_s) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* clocks = static_cast<hal::Clock*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      hal::Clock& port = clocks[i];
      port.taken_ns = context.now_ns;
      port.validity = hal::Validity::Fresh;
      port.tick = context.tick;
      port.now_ns = context.now_ns;
      port.tick_s = context.tick_s;
      if (jitter_s_ > 0.0) {
        const std::uint32_t entity = context.stores.bodies.entity[context.block.first_row + i];
        const auto bits = draw(context.seed, entity, Stream::ClockNoise, context.tick);
        port.now_ns += static_cast<hal::TimeNs>(std::llround(1e9 * jitter_s_ * to_normal(bits[0], bits[1])[0]));
      }
    }
  }

 private:
  double jitter_s_;
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
