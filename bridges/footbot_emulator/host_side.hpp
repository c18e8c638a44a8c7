// The way from the robot's bus to its host: an adapter, the kernel's CAN, or the switch on the robot's board.
#pragma once
#include <memory>
#include <string>

#include "bridges/emulation/event_log.hpp"
#include "bridges/emulation/item_line.hpp"
#include "bridges/footbot_emulator/message.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::footbot_emulator {

/// Hosts' frames go onto the bus; what is told has passed on it.
using HostSide = ItemLine<Frame>;

/// "pty:NAME" or "serial:DEVICE@1000000": an slcan adapter. "can:INTERFACE": the kernel's CAN.
/// "tcp-listen:PORT", on this computer alone, or "tcp-listen:ADDRESS:PORT" (0.0.0.0 for all of its networks): messages
/// over TCP; port 0 is any that is free. Errors: other links, and what cannot be opened.
hal::Result<std::unique_ptr<HostSide>> open_host_side(const std::string& link, const EventSink& sink);

hal::Result<std::unique_ptr<HostSide>> open_adapter(const std::string& link, const EventSink& sink);
hal::Result<std::unique_ptr<HostSide>> open_socketcan(const std::string& interface, const EventSink& sink);
hal::Result<std::unique_ptr<HostSide>> open_switch(const std::string& endpoint, const EventSink& sink);

}  // namespace tandem::bridges::footbot_emulator
