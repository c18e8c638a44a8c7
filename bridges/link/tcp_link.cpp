#include "bridges/link/tcp_link.hpp"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace tandem::bridges {
namespace {

std::string advice(int error, std::string_view who_listens) {
  switch (error) {
    case ECONNREFUSED:
      return "nobody listens there; " + std::string(who_listens);
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

bool end_connection_of(int process, int descriptor, std::uint16_t port) noexcept {
  constexpr long kPidfdOpen = 434, kPidfdGetfd = 438;  // on every architecture; older headers do not name them
  const auto pidfd = static_cast<int>(::syscall(kPidfdOpen, process, 0));
  if (pidfd < 0) return false;
  const auto fd = static_cast<int>(::syscall(kPidfdGetfd, pidfd, descriptor, 0));
  ::close(pidfd);
  if (fd < 0) return false;
  sockaddr_storage peer{};
  socklen_t size = sizeof peer;
  bool meant = ::getpeername(fd, reinterpret_cast<sockaddr*>(&peer), &size) == 0;
  if (peer.ss_family == AF_INET)
    meant = meant && ntohs(reinterpret_cast<const sockaddr_in&>(peer).sin_port) == port;
  else
    meant = meant && peer.ss_family == AF_INET6 && ntohs(reinterpret_cast<const sockaddr_in6&>(peer).sin6_port) == port;
  const bool ended = meant && ::shutdown(fd, SHUT_RDWR) == 0;
  ::close(fd);
  return ended;
}

hal::Result<Endpoint> parse_endpoint(std::string_view scheme, std::string_view text, std::uint16_t usual_port) {
  const std::string whole = "link '" + std::string(scheme) + ":" + std::string(text) + "': ";
  const std::string number = usual_port != 0 ? std::to_string(usual_port) : "3000";
  Endpoint endpoint{"", usual_port};
  std::string_view port;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return hal::Error{whole + "the [ is never closed"};
    endpoint.host = text.substr(1, end - 1);
    port = text.substr(end + 1);
    if (!port.empty() && !port.starts_with(':')) return hal::Error{whole + "after the ] comes :PORT"};
  } else {
    const std::size_t colon = text.find(':');
    endpoint.host = text.substr(0, colon);
    port = colon == std::string_view::npos ? std::string_view{} : text.substr(colon);
  }
  if (endpoint.host.empty())
    return hal::Error{whole + "no host; write for example " + std::string(scheme) + ":192.168.1.20:" + number};
  if (port.empty()) {
    if (usual_port != 0) return endpoint;
    return hal::Error{whole + "no port; write for example " + std::string(scheme) + ":" + endpoint.host + ":" + number};
  }
  port.remove_prefix(1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), endpoint.port);
  if (error != std::errc{} || end != port.data() + port.size() || endpoint.port == 0) {
    return hal::Error{whole + "'" + std::string(port) + "' is not a port; write a number from 1 to 65535"};
  }
  return endpoint;
}

hal::Result<std::unique_ptr<ByteLink>> TcpLink::connect(const Endpoint& endpoint, std::string_view scheme,
                                                        std::string_view who_listens, hal::TimeNs timeout_ns) {
  const std::string port = std::to_string(endpoint.port);
  const std::string name = std::string(scheme) + ":" + endpoint.host + ":" + port;
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int why = ::getaddrinfo(endpoint.host.c_str(), port.c_str(), &hints, &found); why != 0) {
    return hal::Error{"cannot open " + name + ": the host is not known here (" + ::gai_strerror(why) +
                      "); write its name or address"};
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> addresses(found, ::freeaddrinfo);
  const hal::TimeNs deadline = monotonic_ns() + timeout_ns;
  int error = EHOSTUNREACH;
  for (const addrinfo* a = found; a != nullptr; a = a->ai_next) {
    const int fd = connect_to(*a, deadline, error);
    if (fd >= 0) return take_over(name, fd);
  }
  return hal::Error{"cannot open " + name + ": " + advice(error, who_listens)};
}

std::unique_ptr<ByteLink> TcpLink::take_over(std::string name, int socket) {
  set_option(socket, IPPROTO_TCP, TCP_NODELAY, 1);
  set_option(socket, SOL_SOCKET, SO_KEEPALIVE, 1);
  set_option(socket, IPPROTO_TCP, TCP_KEEPIDLE, 1);
  set_option(socket, IPPROTO_TCP, TCP_KEEPINTVL, 1);
  set_option(socket, IPPROTO_TCP, TCP_KEEPCNT, 3);
  set_option(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, 3000);  // ms
  return std::unique_ptr<ByteLink>(new TcpLink(std::move(name), socket));
}

TcpLink::~TcpLink() {
  ::close(descriptor_);
}

ssize_t TcpLink::put(std::span<const std::uint8_t> bytes) noexcept {
  return ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

Received TcpLink::read(std::span<std::uint8_t> buffer) noexcept {
  if (!open_ || buffer.empty()) return {};
  const ssize_t n = ::recv(descriptor_, buffer.data(), buffer.size(), MSG_DONTWAIT);
  if (n > 0) return received(n);
  if (n == 0 || (errno != EAGAIN && errno != EINTR)) hang_up();
  return {};
}

}  // namespace tandem::bridges
