// A body that lives elsewhere: its senses are another robot's readings, its commands become that robot's.
#pragma once
#include <vector>

#include "bridges/epuck_emulator/body.hpp"
#include "bridges/port_bank.hpp"

namespace tandem::bridges::epuck_emulator {

/// The ports that the firmware senses and drives.
std::vector<const hal::PortType*> body_ports();

class PortBody final : public EmulatedBody {
 public:
  /// `ports` must outlive this.
  explicit PortBody(SharedPorts& ports) : ports_(ports) {}

  BodySenses sense(hal::TimeNs now) override;
  void actuate(hal::TimeNs now, const BodyCommand& command) override;

 private:
  SharedPorts& ports_;
};

}  // namespace tandem::bridges::epuck_emulator
