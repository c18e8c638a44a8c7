// A body that lives elsewhere: its senses are another robot's readings, its commands become that robot's.
#pragma once
#include <vector>

#include "bridges/port_bank.hpp"
#include "bridges/thymio_emulator/body.hpp"

namespace tandem::bridges::thymio_emulator {

/// The ports that the node senses and drives.
std::vector<const hal::PortType*> body_ports();

/// What the other robot does not measure is as the defaults of BodySenses say.
class PortBody final : public EmulatedBody {
 public:
  /// `ports` must outlive this.
  explicit PortBody(SharedPorts& ports) : ports_(ports) {}

  BodySenses sense(hal::TimeNs now) override;
  void actuate(hal::TimeNs now, const BodyCommand& command) override;

 private:
  SharedPorts& ports_;
};

}  // namespace tandem::bridges::thymio_emulator
