// The e-puck as its controller sees it: ports that a session fills and drains.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "bridges/epuck/session.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot.hpp"

namespace tandem::bridges::epuck {

struct RobotSettings {
  std::string id = "epuck";
  std::uint64_t seed = 0;
  hal::TimeNs tick_ns = 100 * hal::kNsPerMs;
  hal::TimeNs origin_ns = 0;  ///< start of the run on the link's clock; readings are stamped from there
  hal::TimeNs fresh_ns = 0;   ///< older readings are stale; 0: two ticks, at least 150 ms
  /// Names of the devices that the configuration lists; empty optional: all that the robot has.
  std::optional<std::vector<std::string>> sensors = {};
  std::optional<std::vector<std::string>> actuators = {};
};

/// Ports of one e-puck. A port that was taken, by a controller or with `require`, makes its sensor be asked for.
/// Range-and-bearing has no serial form: its reading stays absent unless somebody relays messages into it, its command
/// is kept for whoever relays it. Not thread-safe: one thread constructs, latches, steps and commits.
class EpuckRobot final : public hal::Robot {
 public:
  explicit EpuckRobot(RobotSettings settings);
  EpuckRobot(const EpuckRobot&) = delete;
  EpuckRobot& operator=(const EpuckRobot&) = delete;

  std::string_view id() const noexcept override { return settings_.id; }
  const hal::DataSheet& data_sheet() const noexcept override;
  std::uint64_t run_seed() const noexcept override { return settings_.seed; }

  /// Takes a port by its description, for those who fuse, record or inspect. The memory lives as long as the robot.
  /// @throws hal::DeviceError
  void* require(const hal::PortType& type) { return take(type); }
  /// Takes a port whatever the configuration lists; null when there is none of that name, role and layout that can be
  /// had over the serial link.
  void* find(const hal::PortType& type) noexcept;

  /// One port that was taken.
  struct PortView {
    const hal::PortType* type;
    void* data;
  };
  const std::vector<PortView>& taken() const noexcept { return taken_; }

  /// What must be asked of the robot to fill the ports that were taken.
  QuantitySet demand() const noexcept { return demand_; }
  hal::TimeNs fresh_ns() const noexcept { return settings_.fresh_ns; }
  void set_origin(hal::TimeNs origin_ns) noexcept { settings_.origin_ns = origin_ns; }

  /// Fills every reading for tick `tick` at `now` (link's clock): values, stamps, and validity by age.
  void fill(const Samples& samples, const Identity& identity, hal::Tick tick, hal::TimeNs now) noexcept;
  /// What the commands say now; wheels in m/s, not yet filtered.
  const hal::WheelSpeeds& wheels() const noexcept { return wheels_; }
  /// LEDs as commanded; speeds 0.
  Actuation lamps() const noexcept;
  /// Writes the safe value into every command.
  void make_safe() noexcept;

 protected:
  void* take(const hal::PortType& type) override;

 private:
  struct Device {
    const hal::PortType* type;
    void* data;
    QuantitySet needs;
    bool over_serial = true;
  };
  void* take(const Device& device);
  bool listed(const hal::PortType& type) const;
  void stamp(hal::Reading& reading, Quantity quantity, const Samples& samples, hal::TimeNs now) const noexcept;

  RobotSettings settings_;
  hal::Proximity proximity_;
  hal::Light light_;
  hal::Ground ground_;
  hal::Accelerometer accelerometer_;
  hal::Microphones microphones_;
  hal::Battery battery_;
  hal::Clock clock_;
  hal::WheelEncoders encoders_;
  hal::RangeAndBearing rab_;
  hal::WheelSpeeds wheels_;
  hal::RingLeds ring_;
  hal::BodyLed body_;
  hal::FrontLed front_;
  hal::RangeAndBearingSend rab_send_;
  std::vector<Device> devices_;
  std::vector<PortView> taken_;
  QuantitySet demand_{Quantity::Encoders};
};

}  // namespace tandem::bridges::epuck
