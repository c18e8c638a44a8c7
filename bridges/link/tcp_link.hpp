// A TCP connection as a byte link: to a robot in the network, a serial server (ser2net), asebaswitch, a simulated
// robot.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "bridges/link/descriptor_link.hpp"

namespace tandem::bridges {

/// Address of a listener.
struct Endpoint {
  std::string host;
  std::uint16_t port = 0;
};

/// Takes "host:port", "[address]:port" apart, and the same without a port where there is a usual one. `scheme`: what
/// stands before it in a LINK text, for messages.
/// Errors: no host, not a port, no port where none is usual (`usual_port` 0).
hal::Result<Endpoint> parse_endpoint(std::string_view scheme, std::string_view text, std::uint16_t usual_port = 0);

/// Ends a TCP connection that another process holds open and cannot end, for it is frozen: who serves one host at a
/// time then serves the next. `descriptor`: in that process. False: it is no connection to that port, or the system
/// does not permit it (before Linux 5.6; a process that has not named us with PR_SET_PTRACER, where that counts).
bool end_connection_of(int process, int descriptor, std::uint16_t port) noexcept;

/// A connection made by this side, without delays for small packets, and with keep-alive so that a peer that lost its
/// power is noticed: 3 to 4 s after its last sign of life the link has hung up.
class TcpLink final : public DescriptorLink {
 public:
  /// Blocks for the look-up of the name, and at most `timeout_ns` for the connection.
  /// Errors, each with what to do: unknown host, refused, no route, no answer. `scheme`: of the LINK text, for names
  /// and messages; `who_listens`: "is asebaswitch running on the robot?", what people look at when the other side
  /// refuses.
  static hal::Result<std::unique_ptr<ByteLink>> connect(const Endpoint& endpoint, std::string_view scheme = "tcp",
                                                        std::string_view who_listens = "is its program running?",
                                                        hal::TimeNs timeout_ns = 3 * hal::kNsPerSecond);
  /// A connection made elsewhere, as `Listener::accept` gives it; owned from here on. `name` is for messages.
  static std::unique_ptr<ByteLink> take_over(std::string name, int socket);
  ~TcpLink() override;

  Received read(std::span<std::uint8_t> buffer) noexcept override;
  std::string name() const override { return name_; }

 private:
  TcpLink(std::string name, int socket) : DescriptorLink(socket), name_(std::move(name)) {}
  ssize_t put(std::span<const std::uint8_t> bytes) noexcept override;

  std::string name_;
};

}  // namespace tandem::bridges
