#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <map>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bridges/footbot_emulator/assembler.hpp"
#include "bridges/footbot_emulator/host_side.hpp"
#include "bridges/footbot_emulator/stream.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

constexpr std::size_t kMostUnsent = 256 * 1024;  // bytes; a host that does not read is then cut off
constexpr std::size_t kMostAtOnce = 1024;        // bytes of one host in one turn: none talks the others down

/// The translator between bus and serial line on the robot, and the switch that serves the line's messages to any
/// number of hosts. What one host says goes to the bus and to the other hosts.
class SwitchSide final : public HostSide {
 public:
  SwitchSide(int listener, std::string path, EventSink sink)
      : listener_(listener), path_(std::move(path)), sink_(std::move(sink)) {}
  ~SwitchSide() override {
    for (const auto& [descriptor, client] : clients_) ::close(descriptor);
    ::close(listener_);
  }
  SwitchSide(const SwitchSide&) = delete;
  SwitchSide& operator=(const SwitchSide&) = delete;

  void add_polls(std::vector<pollfd>& polls) const override {
    polls.push_back({listener_, POLLIN, 0});
    for (const auto& [descriptor, client] : clients_) {
      const short room = client.unsent.empty() ? 0 : POLLOUT;
      polls.push_back({descriptor, static_cast<short>(POLLIN | room), 0});
    }
  }

  hal::Status take(hal::TimeNs now, std::vector<Frame>& to_bus) override {
    greet(now);
    std::vector<int> all;
    for (const auto& [descriptor, client] : clients_) all.push_back(descriptor);
    for (const int descriptor : all) listen_to(descriptor, now, to_bus);
    return {};
  }

  void show(const Frame& frame, hal::TimeNs now) override {
    const auto message = assembler_.push(frame);
    if (message) tell_all(*message, -1);
    flush(now);
  }

  void flush(hal::TimeNs now) override {
    std::vector<int> lost;
    for (auto& [descriptor, client] : clients_) {
      if (client.unsent.empty()) continue;
      const ssize_t n = ::send(descriptor, client.unsent.data(), client.unsent.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
      if (n > 0) client.unsent.erase(client.unsent.begin(), client.unsent.begin() + n);
      const bool broken = n < 0 && errno != EAGAIN && errno != EINTR;
      if (broken || client.unsent.size() > kMostUnsent) lost.push_back(descriptor);
    }
    for (const int descriptor : lost) cut_off(descriptor, now, "it does not read");
  }

  const std::string& path() const override { return path_; }

 private:
  struct Client {
    StreamReader reader;
    std::vector<std::uint8_t> unsent;
  };

  void greet(hal::TimeNs now) {
    int descriptor = -1;
    while ((descriptor = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC)) >= 0) {
      const int at_once = 1;
      ::setsockopt(descriptor, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
      clients_[descriptor];
      sink_(now, "host", {{"connected", true}, {"hosts", clients_.size()}});
    }
  }

  void listen_to(int descriptor, hal::TimeNs now, std::vector<Frame>& to_bus) {
    Client& client = clients_[descriptor];
    std::array<std::uint8_t, kMostAtOnce> buffer{};
    const ssize_t n = ::recv(descriptor, buffer.data(), buffer.size(), MSG_DONTWAIT);
    const int error = errno;
    if (n > 0) client.reader.push(std::span(buffer).first(static_cast<std::size_t>(n)));
    while (const auto message = client.reader.next()) {
      tell_all(*message, descriptor);
      const auto frames = to_frames(*message);
      to_bus.insert(to_bus.end(), frames.begin(), frames.end());
    }
    if (client.reader.broken()) return cut_off(descriptor, now, "it announced a message that is too long");
    if (n == 0) return cut_off(descriptor, now, "it hung up");
    if (n < 0 && error != EAGAIN && error != EINTR) cut_off(descriptor, now, std::strerror(error));
  }

  void tell_all(const Message& message, int but) {
    const std::vector<std::uint8_t> bytes = to_bytes(message);
    for (auto& [descriptor, client] : clients_) {
      if (descriptor != but) client.unsent.insert(client.unsent.end(), bytes.begin(), bytes.end());
    }
  }

  void cut_off(int descriptor, hal::TimeNs now, std::string_view why) {
    ::close(descriptor);
    clients_.erase(descriptor);
    sink_(now, "host", {{"connected", false}, {"hosts", clients_.size()}, {"why", why}});
  }

  int listener_;
  std::string path_;
  EventSink sink_;
  Assembler assembler_;
  std::map<int, Client> clients_;  // by descriptor
};

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
  if (::bind(descriptor, address.ai_addr, address.ai_addrlen) == 0 && ::listen(descriptor, 8) == 0) return descriptor;
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

hal::Result<std::unique_ptr<HostSide>> open_switch(const std::string& endpoint, const EventSink& sink) {
  const std::size_t colon = endpoint.rfind(':');
  std::string host = colon == std::string::npos ? "127.0.0.1" : endpoint.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const std::string port = colon == std::string::npos ? endpoint : endpoint.substr(colon + 1);
  const std::string whole = "tcp-listen:" + endpoint;
  std::uint16_t number = 0;
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), number);
  if (port.empty() || error != std::errc{} || end != port.data() + port.size()) {
    return hal::Error{"link '" + whole + "': '" + port + "' is no port; write for example tcp-listen:33333"};
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
  const std::string shown = host == "0.0.0.0" ? "127.0.0.1" : host;
  return std::unique_ptr<HostSide>(
      std::make_unique<SwitchSide>(listener, "tcp:" + shown + ":" + std::to_string(port_of(listener)), sink));
}

}  // namespace tandem::bridges::footbot_emulator
