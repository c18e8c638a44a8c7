// Getting a flying robot into the air, keeping it there while nothing is known, and bringing it down.
#pragma once
#include "hal/device/body_sensors.hpp"
#include "hal/device/flight.hpp"
#include "hal/robot.hpp"

namespace tandem::controllers {

/// Gives a robot's flight tasks for a behaviour that steers it by velocity or by places. Takes the devices
/// `flight_task`, `flight_state`, `positioning` and `clock`.
///
/// The behaviour steers while `ready()`; otherwise it is to leave its commands at their safe values, and the robot
/// hovers, rises or stands.
class Aloft {
 public:
  explicit Aloft(hal::Robot& robot);

  /// Call once a step. Lets the robot take off where it stands. False: it is not in the air yet or any more; its own
  /// fail-safe has taken over; or what is known of its state or place is missing or older than half a second.
  bool ready() noexcept;
  /// From now on it lands, or stays down.
  void land() noexcept { landing_ = true; }
  /// Whether it was to land and stands.
  bool down() const noexcept;

  /// Where it is; only while `ready()`.
  const hal::Positioning& place() const noexcept { return place_; }
  const hal::FlightState& state() const noexcept { return state_; }
  const hal::Clock& clock() const noexcept { return clock_; }
  /// Heading in W; only while `ready()`.
  double heading_rad() const noexcept;

 private:
  bool knows(const hal::Reading& reading) const noexcept;

  hal::FlightTask& task_;
  const hal::FlightState& state_;
  const hal::Positioning& place_;
  const hal::Clock& clock_;
  bool landing_ = false;
};

}  // namespace tandem::controllers
