// Interface of the line from an emulated robot's nodes to its hosts, which carries whole messages.
#pragma once
#include <memory>
#include <poll.h>
#include <string>
#include <vector>

#include "bridges/aseba_emulation/message.hpp"
#include "bridges/emulation/event_log.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::aseba_emulation {

/// Nothing here blocks.
class HostLine {
 public:
  virtual ~HostLine() = default;
  /// What is to be waited for.
  virtual void add_polls(std::vector<pollfd>& polls) const = 0;
  /// Takes in what hosts have sent, or a part of it. Errors: the line is gone for good.
  virtual hal::Status take(hal::TimeNs now, std::vector<Message>& from_hosts) = 0;
  /// Sends to every host; what cannot go at once waits for `flush`.
  virtual void tell(const Message& message, hal::TimeNs now) = 0;
  virtual void flush(hal::TimeNs now) = 0;
  /// For people: what a host opens.
  virtual const std::string& path() const = 0;
  /// LINK text that opens the same line again.
  virtual const std::string& link() const = 0;
};

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
