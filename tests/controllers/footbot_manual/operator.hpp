// Somebody who drives a robot by datagrams.
#pragma once
#include <arpa/inet.h>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

namespace tandem::test {

/// A UDP socket on this machine that sends to one port of it.
class Operator {
 public:
  Operator() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in here = local(0);
    socklen_t size = sizeof here;
    const timeval most{5, 0};
    if (socket_ < 0 || bind(socket_, reinterpret_cast<const sockaddr*>(&here), size) != 0 ||
        getsockname(socket_, reinterpret_cast<sockaddr*>(&here), &size) != 0 ||
        setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &most, sizeof most) != 0)
      throw std::runtime_error("no socket");
    port_ = ntohs(here.sin_port);
  }
  ~Operator() { close(socket_); }
  Operator(const Operator&) = delete;
  Operator& operator=(const Operator&) = delete;

  std::uint16_t port() const { return port_; }  ///< its own
  void say(std::uint16_t port, const std::string& text) const {
    const sockaddr_in to = local(port);
    const auto sent = sendto(socket_, text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    if (sent != static_cast<ssize_t>(text.size())) throw std::runtime_error("not sent");
  }
  /// What was answered; empty when nothing came for five seconds.
  std::string hear() const {
    std::array<char, 2048> text{};
    const ssize_t count = recv(socket_, text.data(), text.size(), 0);
    return {text.data(), count > 0 ? static_cast<std::size_t>(count) : 0};
  }

 private:
  static sockaddr_in local(std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }

  int socket_;
  std::uint16_t port_ = 0;
};

/// Two ports that nobody has at the moment.
inline std::array<std::uint16_t, 2> free_ports() {
  const Operator one, other;
  return {one.port(), other.port()};
}

}  // namespace tandem::test
