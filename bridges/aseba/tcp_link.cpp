#include "bridges/aseba/tcp_link.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tandem::bridges::aseba {
namespace {

std::string advice(int error) {
  switch (error) {
    case ECONNREFUSED:
      return "nobody listens there; is asebaswitch running on the robot?";
    case ETIMEDOUT:
    case EHOSTUNREACH:
    case ENETUNREACH:
      return std::string(std::strerror(error)) + "; is the robot switched on and in this network?";
    default:
      return std::strerror(error);
  }
}

int remaining_ms(hal::TimeNs deadline) noexcept {
  const hal::TimeNs left = deadline - monotonic_ns();
  return left <= 0 ? 0 : static_cast<int>((left + hal::kNsPerMs - 1) / hal::kNsPerMs);
}

/// A connected socket, or -1 with the reason in `error`.
int connect_to(const addrinfo& address, hal::TimeNs deadline, int& error) noexcept {
  const int fd = ::socket(address.ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, address.ai_protocol);
  if (fd < 0) {
    error = errno;
    return -1;
  }
  error = ::connect(fd, address.ai_addr, address.ai_addrlen) == 0 ? 0 : errno;
  if (error == EINPROGRESS) {
    pollfd p{fd, POLLOUT, 0};
    socklen_t size = sizeof error;
    if (::poll(&p, 1, remaining_ms(deadline)) <= 0) {
      error = ETIMEDOUT;
    } else if (::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size) != 0) {
      error = errno;
    }
  }
  if (error == 0) return fd;
  ::close(fd);
  return -1;
}

void set_option(int socket, int level, int option, int value) noexcept {
  ::setsockopt(socket, level, option, &value, sizeof value);
}

}  // namespace

hal::Result<std::unique_ptr<ByteLink>> TcpLink::connect(const std::string& host, std::uint16_t port,
                                                        hal::TimeNs timeout_ns) {
  const std::string name = "tcp:" + host + ":" + std::to_string(port);
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int why = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found); why != 0) {
    return hal::Error{"cannot open " + name + ": the host is not known here (" + ::gai_strerror(why) +
                      "); write its name or address"};
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> addresses(found, ::freeaddrinfo);
  const hal::TimeNs deadline = monotonic_ns() + timeout_ns;
  int error = EHOSTUNREACH;
  for (const addrinfo* a = found; a != nullptr; a = a->ai_next) {
    const int fd = connect_to(*a, deadline, error);
    if (fd < 0) continue;
    set_option(fd, IPPROTO_TCP, TCP_NODELAY, 1);
    set_option(fd, SOL_SOCKET, SO_KEEPALIVE, 1);
    set_option(fd, IPPROTO_TCP, TCP_KEEPIDLE, 1);
    set_option(fd, IPPROTO_TCP, TCP_KEEPINTVL, 1);
    set_option(fd, IPPROTO_TCP, TCP_KEEPCNT, 3);
    set_option(fd, IPPROTO_TCP, TCP_USER_TIMEOUT, 3000);  // ms
    return std::unique_ptr<ByteLink>(new TcpLink(name, fd));
  }
  return hal::Error{"cannot open " + name + ": " + advice(error)};
}

TcpLink::~TcpLink() {
  ::close(socket_);
}

void TcpLink::hang_up() noexcept {
  if (open_) ++statistics_.errors;
  open_ = false;
}

std::size_t TcpLink::write(std::span<const std::uint8_t> bytes, hal::TimeNs budget_ns) noexcept {
  const hal::TimeNs deadline = monotonic_ns() + budget_ns;
  std::size_t done = 0;
  while (done < bytes.size() && open_) {
    const ssize_t n = ::send(socket_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (n > 0) {
      done += static_cast<std::size_t>(n);
    } else if (n < 0 && errno != EAGAIN && errno != EINTR) {
      hang_up();
    } else {
      const int left_ms = budget_ns > 0 ? remaining_ms(deadline) : 0;
      if (left_ms <= 0) break;
      pollfd p{socket_, POLLOUT, 0};
      ::poll(&p, 1, left_ms);
    }
  }
  statistics_.bytes_out += done;
  statistics_.bytes_refused += bytes.size() - done;
  return done;
}

Received TcpLink::read(std::span<std::uint8_t> buffer) noexcept {
  if (!open_ || buffer.empty()) return {};
  const ssize_t n = ::recv(socket_, buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (n > 0) {
    statistics_.bytes_in += static_cast<std::uint64_t>(n);
    return {static_cast<std::size_t>(n), monotonic_ns()};
  }
  if (n == 0 || (errno != EAGAIN && errno != EINTR)) hang_up();
  return {};
}

bool TcpLink::wait(hal::TimeNs timeout_ns) noexcept {
  const timespec t{static_cast<time_t>(timeout_ns / hal::kNsPerSecond),
                   static_cast<long>(timeout_ns % hal::kNsPerSecond)};
  if (!open_) {
    ::nanosleep(&t, nullptr);  // nothing to wait for; a loop of waits must not spin
    return false;
  }
  pollfd p{socket_, POLLIN, 0};
  return ::ppoll(&p, 1, &t, nullptr) > 0;
}

}  // namespace tandem::bridges::aseba
