#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <sys/socket.h>
#include <unistd.h>

#include "bridges/aseba_emulation/host_line.hpp"
#include "bridges/aseba_emulation/stream.hpp"
#include "bridges/link/listener.hpp"

namespace tandem::bridges::aseba_emulation {
namespace {

constexpr std::size_t kMostUnsent = 256 * 1024;  // bytes; a host that does not read is then cut off
constexpr std::size_t kMostAtOnce = 1024;        // bytes of one host in one turn: none talks the others down

/// The switch that serves a robot's messages to any number of hosts.
class TcpLine final : public HostLine {
 public:
  TcpLine(std::unique_ptr<Listener> listener, EventSink sink)
      : listener_(std::move(listener)), sink_(std::move(sink)) {}
  ~TcpLine() override {
    for (const auto& [descriptor, client] : clients_) ::close(descriptor);
  }
  TcpLine(const TcpLine&) = delete;
  TcpLine& operator=(const TcpLine&) = delete;

  void add_polls(std::vector<pollfd>& polls) const override {
    polls.push_back({listener_->descriptor(), POLLIN, 0});
    for (const auto& [descriptor, client] : clients_) {
      const short room = client.unsent.empty() ? 0 : POLLOUT;
      polls.push_back({descriptor, static_cast<short>(POLLIN | room), 0});
    }
  }

  hal::Status take(hal::TimeNs now, std::vector<Message>& from_hosts) override {
    greet(now);
    std::vector<int> all;
    for (const auto& [descriptor, client] : clients_) all.push_back(descriptor);
    for (const int descriptor : all) listen_to(descriptor, now, from_hosts);
    return {};
  }

  void tell(const Message& message, hal::TimeNs now) override {
    tell_all(message, -1);
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

  const std::string& path() const override { return listener_->path(); }
  const std::string& link() const override { return listener_->link(); }

 private:
  struct Client {
    StreamReader reader;
    std::vector<std::uint8_t> unsent;
  };

  void greet(hal::TimeNs now) {
    int descriptor = -1;
    while ((descriptor = listener_->accept()) >= 0) {
      clients_[descriptor];
      sink_(now, "host", {{"connected", true}, {"hosts", clients_.size()}});
    }
  }

  void listen_to(int descriptor, hal::TimeNs now, std::vector<Message>& from_hosts) {
    Client& client = clients_[descriptor];
    std::array<std::uint8_t, kMostAtOnce> buffer{};
    const ssize_t n = ::recv(descriptor, buffer.data(), buffer.size(), MSG_DONTWAIT);
    const int error = errno;
    if (n > 0) client.reader.push(std::span(buffer).first(static_cast<std::size_t>(n)));
    while (const auto message = client.reader.next()) {
      tell_all(*message, descriptor);
      from_hosts.push_back(*message);
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

  std::unique_ptr<Listener> listener_;
  EventSink sink_;
  std::map<int, Client> clients_;  // by descriptor
};

}  // namespace

hal::Result<std::unique_ptr<HostLine>> open_tcp_line(const std::string& endpoint, const EventSink& sink) {
  auto listener = Listener::open("tcp-listen", "tcp", endpoint);
  if (!listener.ok()) return listener.error();
  return std::unique_ptr<HostLine>(std::make_unique<TcpLine>(std::move(listener).value(), sink));
}

}  // namespace tandem::bridges::aseba_emulation
