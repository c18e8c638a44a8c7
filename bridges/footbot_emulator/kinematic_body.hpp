// A foot-bot's body with a little world of its own.
#pragma once
#include <optional>
#include <utility>

#include "bridges/emulation/wheeled_body.hpp"
#include "bridges/footbot_emulator/body.hpp"

namespace tandem::bridges::footbot_emulator {

/// Turret, scanner and claws turn at their speeds. There is nothing to grip: claws that were opened are busy for a
/// second, try their grip, and are closed again.
class KinematicBody final : public WheeledBodyOf<EmulatedBody, hal::footbot::kind> {
 public:
  using WheeledBodyOf::WheeledBodyOf;

  BodySenses sense(hal::TimeNs now) override;
  void actuate(hal::TimeNs now, const BodyCommand& command) override;
  std::vector<Heard> take_heard() override { return std::exchange(heard, {}); }

  /// What the radio is to hear next.
  std::vector<Heard> heard;

 private:
  void look(BodySenses& senses) const override;
  void turn_devices(hal::TimeNs now);
  void turn_devices(hal::TimeNs until, double dt_s);

  std::optional<hal::TimeNs> devices_at_;
  double turret_rad_ = 0.0;
  double scanner_rad_ = 0.0;
  double gripper_rad_ = 0.0;
  hal::TimeNs grip_tried_at_ = 0;
  bool trying_grip_ = false;
  bool gave_up_ = false;  // the claws were closed again
};

}  // namespace tandem::bridges::footbot_emulator
