// A body that lives elsewhere: its senses are another robot's readings, its commands become that robot's.
#pragma once
#include <vector>

#include "bridges/footbot_emulator/body.hpp"
#include "bridges/port_bank.hpp"

namespace tandem::bridges::footbot_emulator {

/// The ports that the modules sense and drive.
std::vector<const hal::PortType*> body_ports();

/// What the other robot does not measure is as the defaults of BodySenses say.
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

}  // namespace tandem::bridges::footbot_emulator
