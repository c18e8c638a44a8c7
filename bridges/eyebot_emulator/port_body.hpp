// A body that lives elsewhere: its senses are another robot's readings, its commands become that robot's.
#pragma once
#include <vector>

#include "bridges/eyebot_emulator/body.hpp"
#include "bridges/port_bank.hpp"

namespace tandem::bridges::eyebot_emulator {

/// The ports that the firmware senses and drives.
std::vector<const hal::PortType*> body_ports();

/// The other robot takes off, lands, attaches and lets go as its own tasks do; once they are done, and between them, it
/// flies with the firmware's velocities. With its motors cut it lands: simulated eye-bots do not fall. What it does not
/// measure is as the defaults of BodySenses say.
class PortBody final : public EmulatedBody {
 public:
  /// `ports` must outlive this.
  explicit PortBody(SharedPorts& ports) : ports_(ports) {}

  BodySenses sense(hal::TimeNs now) override;
  void actuate(hal::TimeNs now, const BodyCommand& command) override;
  std::vector<Heard> take_heard() override;

 private:
  SharedPorts& ports_;
  std::uint64_t heard_ = 0;  // readings that were taken
};

}  // namespace tandem::bridges::eyebot_emulator
