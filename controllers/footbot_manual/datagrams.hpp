// Datagrams that arrive at a UDP port.
#pragma once
#include <array>
#include <cstdint>
#include <netinet/in.h>
#include <string>
#include <string_view>

namespace tandem::controllers {

/// A UDP port of IPv4 that is this object's alone. Nothing here waits.
class Datagrams {
 public:
  /// @throws std::runtime_error with what to do when the address is none of this machine's or the port is taken
  Datagrams(const std::string& address, std::uint16_t port);
  ~Datagrams();
  Datagrams(const Datagrams&) = delete;
  Datagrams& operator=(const Datagrams&) = delete;

  /// The next datagram that has arrived, valid until the next call; longer ones than 1 kB are cut. @returns whether
  /// there was one
  bool receive(std::string_view& text) noexcept;
  /// To whom the datagram came from that was received last; lost when the network takes it not at once.
  void reply(std::string_view text) noexcept;

 private:
  int socket_ = -1;
  sockaddr_in from_{};
  std::array<char, 1024> buffer_{};
};

}  // namespace tandem::controllers
