// Lines from an emulated robot's nodes to its hosts, which carry whole messages.
#pragma once
#include <memory>
#include <string>

#include "bridges/aseba_emulation/message.hpp"
#include "bridges/emulation/event_log.hpp"
#include "bridges/emulation/item_line.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::aseba_emulation {

using HostLine = ItemLine<Message>;

/// "tcp-listen:PORT", on this computer alone, or "tcp-listen:ADDRESS:PORT" (0.0.0.0 for all of its networks): as a
/// switch, any number of hosts; what one says is passed on to the others. Port 0 is any that is free. Errors: not a
/// port, it cannot be listened at.
hal::Result<std::unique_ptr<HostLine>> open_tcp_line(const std::string& endpoint, const EventSink& sink);

/// "pty:NAME" or "serial:DEVICE": one host. `robot` and `baud` are as in SerialPort. Errors: what cannot be opened.
hal::Result<std::unique_ptr<HostLine>> open_serial_line(const std::string& link, const std::string& robot,
                                                        unsigned long baud, const EventSink& sink);

/// Either of them. Errors: other links, too.
hal::Result<std::unique_ptr<HostLine>> open_host_line(const std::string& link, const std::string& robot,
                                                      unsigned long baud, const EventSink& sink);

}  // namespace tandem::bridges::aseba_emulation
