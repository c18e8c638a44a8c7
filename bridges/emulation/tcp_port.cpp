#include "bridges/emulation/tcp_port.hpp"

#include <cerrno>
#include <sys/socket.h>
#include <unistd.h>

namespace tandem::bridges {

hal::Result<std::unique_ptr<TcpPort>> TcpPort::open(std::string_view scheme, std::string_view host_scheme,
                                                    const std::string& endpoint, unsigned long baud) {
  auto listener = Listener::open(scheme, host_scheme, endpoint);
  if (!listener.ok()) return listener.error();
  return std::unique_ptr<TcpPort>(new TcpPort(std::move(listener).value(), baud));
}

TcpPort::~TcpPort() {
  hang_up();
}

void TcpPort::hang_up() noexcept {
  if (host_ >= 0) ::close(host_);
  host_ = -1;
}

hal::Result<std::size_t> TcpPort::read(std::span<std::uint8_t> buffer) {
  if (host_ < 0) {
    host_ = listener_->accept();
    if (host_ < 0) return std::size_t{0};
    ++hosts_;
  }
  const ssize_t n = ::recv(host_, buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (n > 0) return static_cast<std::size_t>(n);
  if (n == 0 || (errno != EAGAIN && errno != EINTR)) hang_up();
  return std::size_t{0};
}

std::size_t TcpPort::write(std::span<const std::uint8_t> bytes) {
  if (host_ < 0) return bytes.size();
  const ssize_t n = ::send(host_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
  if (n >= 0) return static_cast<std::size_t>(n);
  if (errno != EAGAIN && errno != EINTR) hang_up();
  return 0;
}

}  // namespace tandem::bridges
