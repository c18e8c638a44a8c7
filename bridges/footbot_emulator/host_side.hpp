// The way from the robot's bus to its host: an adapter, the kernel's CAN, or the switch on the robot's board.
#pragma once
#include <memory>
#include <poll.h>
#include <string>
#include <vector>

#include "bridges/emulation/event_log.hpp"
#include "bridges/footbot_emulator/message.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::footbot_emulator {

/// Nothing here blocks.
class HostSide {
 public:
  virtual ~HostSide() = default;
  /// What is to be waited for.
  virtual void add_polls(std::vector<pollfd>& polls) const = 0;
  /// Takes in what the host has sent, or a part of it; adds the frames that go onto the bus. Errors: the way is gone
  /// for good.
  virtual hal::Status take(hal::TimeNs now, std::vector<Frame>& to_bus) = 0;
  /// A frame of a module has passed on the bus.
  virtual void show(const Frame& frame, hal::TimeNs now) = 0;
  /// Sends what could not go at once.
  virtual void flush(hal::TimeNs now) = 0;
  /// For people: what a host opens.
  virtual const std::string& path() const = 0;
};

/// "pty:NAME" or "serial:DEVICE@1000000": an slcan adapter. "can:INTERFACE": the kernel's CAN.
/// "tcp-listen:PORT", on this computer alone, or "tcp-listen:ADDRESS:PORT" (0.0.0.0 for all of its networks): messages
/// over TCP; port 0 is any that is free. Errors: other links, and what cannot be opened.
hal::Result<std::unique_ptr<HostSide>> open_host_side(const std::string& link, const EventSink& sink);

hal::Result<std::unique_ptr<HostSide>> open_adapter(const std::string& link, const EventSink& sink);
hal::Result<std::unique_ptr<HostSide>> open_socketcan(const std::string& interface, const EventSink& sink);
hal::Result<std::unique_ptr<HostSide>> open_switch(const std::string& endpoint, const EventSink& sink);

}  // namespace tandem::bridges::footbot_emulator
