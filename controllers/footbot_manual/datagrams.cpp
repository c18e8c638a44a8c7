#include "controllers/footbot_manual/datagrams.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>

namespace tandem::controllers {

Datagrams::Datagrams(const std::string& address, std::uint16_t port) {
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_port = htons(port);
  const std::string name = address + ", port " + std::to_string(port);
  if (inet_pton(AF_INET, address.c_str(), &here.sin_addr) != 1)
    throw std::runtime_error("'" + address +
                             "' is no IPv4 address; such are 127.0.0.1 (this machine) and 0.0.0.0 (all)");
  socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket_ < 0) throw std::runtime_error(name + ": no socket: " + std::strerror(errno));
  if (bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here) == 0) return;
  const int why = errno;
  close(socket_);
  throw std::runtime_error(name + ": " + std::strerror(why) +
                           (why == EADDRINUSE ? "; each robot needs a port of its own: give <params port=…/> in its "
                                                "<controller>, and end other programs that listen there"
                                              : "; see param 'address'"));
}

Datagrams::~Datagrams() {
  close(socket_);
}

bool Datagrams::receive(std::string_view& text) noexcept {
  socklen_t size = sizeof from_;
  const ssize_t count =
      recvfrom(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT, reinterpret_cast<sockaddr*>(&from_), &size);
  if (count < 0) return false;
  text = {buffer_.data(), static_cast<std::size_t>(count)};
  return true;
}

void Datagrams::reply(std::string_view text) noexcept {
  (void)sendto(socket_, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
               reinterpret_cast<const sockaddr*>(&from_), sizeof from_);
}

}  // namespace tandem::controllers
