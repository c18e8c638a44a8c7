// The other side of a TCP link: listens on this machine, and says what a test tells it to.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

namespace tandem::bridges {

class TcpPeer {
 public:
  TcpPeer() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return;
    ::listen(listener_, 4);
    socklen_t size = sizeof address;
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
  }
  ~TcpPeer() {
    hang_up();
    stop_listening();
  }
  TcpPeer(const TcpPeer&) = delete;
  TcpPeer& operator=(const TcpPeer&) = delete;

  std::uint16_t port() const { return port_; }
  void accept() {
    hang_up();
    client_ = ::accept(listener_, nullptr, nullptr);
  }
  void send(const std::vector<std::uint8_t>& bytes) const {
    static_cast<void>(!::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL));
  }
  /// As many bytes, or those that came within ten seconds.
  std::vector<std::uint8_t> receive(std::size_t count) const {
    std::vector<std::uint8_t> all;
    std::array<std::uint8_t, 256> buffer{};
    for (pollfd p{client_, POLLIN, 0}; all.size() < count && ::poll(&p, 1, 10'000) > 0;) {
      const ssize_t n = ::recv(client_, buffer.data(), std::min(buffer.size(), count - all.size()), 0);
      if (n <= 0) break;
      all.insert(all.end(), buffer.begin(), buffer.begin() + n);
    }
    return all;
  }
  void hang_up() {
    if (client_ >= 0) ::close(client_);
    client_ = -1;
  }
  void stop_listening() {
    if (listener_ >= 0) ::close(listener_);
    listener_ = -1;
  }

 private:
  int listener_, client_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace tandem::bridges
