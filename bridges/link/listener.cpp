#include "bridges/link/listener.hpp"

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tandem::bridges {
namespace {

struct AddressList {
  ~AddressList() {
    if (first != nullptr) ::freeaddrinfo(first);
  }
  addrinfo* first = nullptr;
};

/// -1 with errno set where it cannot be.
int listen_at(const addrinfo& address) {
  const int descriptor = ::socket(address.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return -1;
  const int reuse = 1;
  ::setsockopt(descriptor, SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof reuse);
  if (::bind(descriptor, address.ai_addr, address.ai_addrlen) == 0 && ::listen(descriptor, 64) == 0) return descriptor;
  const int error = errno;
  ::close(descriptor);
  errno = error;
  return -1;
}

std::uint16_t port_of(int listener) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  if (address.ss_family == AF_INET6) return ntohs(reinterpret_cast<const sockaddr_in6&>(address).sin6_port);
  return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port);
}

}  // namespace

hal::Result<std::unique_ptr<Listener>> Listener::open(std::string_view scheme, std::string_view host_scheme,
                                                      const std::string& endpoint) {
  const std::size_t colon = endpoint.rfind(':');
  const std::string written = colon == std::string::npos ? "127.0.0.1" : endpoint.substr(0, colon);
  const bool bracketed = written.starts_with('[') && written.ends_with(']');
  const std::string host = bracketed ? written.substr(1, written.size() - 2) : written;
  const std::string port = colon == std::string::npos ? endpoint : endpoint.substr(colon + 1);
  const std::string whole = std::string(scheme) + ":" + endpoint;
  std::uint16_t number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (port.empty() || error != std::errc{} || end != port.data() + port.size()) {
    return hal::Error{"link '" + whole + "': '" + port + "' is no port; write for example " + std::string(scheme) +
                      ":33333"};
  }
  addrinfo wish{};
  wish.ai_socktype = SOCK_STREAM;
  wish.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  AddressList list;
  if (const int failed = ::getaddrinfo(host.c_str(), port.c_str(), &wish, &list.first); failed != 0) {
    return hal::Error{"link '" + whole + "': there is no host '" + host + "': " + ::gai_strerror(failed)};
  }
  const int listener = listen_at(*list.first);
  if (listener < 0) return hal::Error{"cannot listen at " + whole + ": " + std::strerror(errno)};
  const std::string bound = std::to_string(port_of(listener));
  const std::string shown = written == "0.0.0.0" ? "127.0.0.1" : written;
  return std::unique_ptr<Listener>(new Listener(listener, std::string(host_scheme) + ":" + shown + ":" + bound,
                                                std::string(scheme) + ":" + written + ":" + bound));
}

Listener::~Listener() {
  ::close(descriptor_);
}

int Listener::accept() const {
  const int descriptor = ::accept4(descriptor_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
  const int at_once = 1;
  if (descriptor >= 0) ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
  return descriptor;
}

}  // namespace tandem::bridges
