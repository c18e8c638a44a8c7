#include "bridges/aseba_emulation/host_line.hpp"

namespace tandem::bridges::aseba_emulation {

hal::Result<std::unique_ptr<HostLine>> open_host_line(const std::string& link, const std::string& robot,
                                                      unsigned long baud, const EventSink& sink) {
  constexpr std::string_view kListen = "tcp-listen:";
  if (link.starts_with(kListen)) return open_tcp_line(link.substr(kListen.size()), sink);
  if (link.starts_with("pty:") || link.starts_with("serial:")) return open_serial_line(link, robot, baud, sink);
  return hal::Error{"link '" + link + "': " + robot + " takes pty:NAME, serial:DEVICE@" + std::to_string(baud) +
                    " or tcp-listen:PORT"};
}

}  // namespace tandem::bridges::aseba_emulation
