// The e-puck as its controller sees it: ports that a session fills and drains.
#pragma once
#include "bridges/bridged_robot.hpp"
#include "bridges/epuck/conversation.hpp"
#include "bridges/epuck/conversions.hpp"
#include "hal/device/cliff.hpp"
#include "hal/device/selector.hpp"
#include "hal/device/time_of_flight.hpp"

namespace tandem::bridges::epuck {

/// Ports of one e-puck. A port that was taken makes its sensor be asked for. Range-and-bearing has no serial form: its
/// reading stays absent unless messages are relayed into it, its command is kept for the relay.
class EpuckRobot final : public BridgedRobot {
 public:
  explicit EpuckRobot(RobotSettings settings);

  /// What must be asked of the robot to fill the ports that were taken.
  QuantitySet demand() const noexcept;
  /// Fills every reading for tick `tick` at `now` (link's clock): values, stamps, and validity by age.
  void fill(const Samples& samples, const Identity& identity, hal::Tick tick, hal::TimeNs now) noexcept;
  /// Names of the sensors that were taken and that such answers never fill; "": there are none.
  std::string untold(const AnswerLayout& layout, const Samples& samples) const;
  /// LEDs as commanded; speeds 0.
  Actuation lamps() const noexcept;
  const Conversions& conversions() const noexcept { return conversions_; }

 private:
  void fill_time_of_flight(const RawSensors& raw, hal::TimeOfFlight& port) const noexcept;
  void fill_cliff(const RawSensors& raw, hal::Cliff& port) const noexcept;

  Conversions conversions_;
  std::uint32_t microphones_;
  double time_of_flight_range_m_;
};

}  // namespace tandem::bridges::epuck
