// A foot-bot's modules behind a TCP port, as ASEBA's switch shows them: messages with length, source and type in front.
// Bytes are put together here by hand.
#pragma once
#include <atomic>
#include <map>
#include <mutex>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

#include "tests/bridges/can/frames.hpp"
#include "tests/bridges/footbot/fake_footbot.hpp"

namespace tandem::bridges::footbot {

class FootbotOnTcp {
 public:
  FootbotOnTcp() : listener_(::socket(AF_INET, SOCK_STREAM, 0)), modules_(bus_), ear_(bus_.attach()) {
    modules_.add_all();
    modules_.word("base", "battery") = 3777;  // mV: with an empty one it is stopped after 2 s
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size), 0);
    EXPECT_EQ(::listen(listener_, 4), 0);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    link = "tcp:127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] { serve(); });
  }
  ~FootbotOnTcp() {
    ending_ = true;
    thread_.join();
    for (const auto& [fd, bytes] : peers_) ::close(fd);
    ::close(listener_);
  }
  FootbotOnTcp(const FootbotOnTcp&) = delete;
  FootbotOnTcp& operator=(const FootbotOnTcp&) = delete;

  template <class F>
  auto with(F&& f) {
    const std::lock_guard lock(mutex_);
    return f(modules_);
  }
  bool moves() {
    return with(
        [](FakeModules& m) { return m.word("left motor", "speed") != 0 || m.word("right motor", "speed") != 0; });
  }
  /// Cuts the connections that there are.
  void hang_up() { hang_up_ = true; }

  std::string link;

 private:
  using Bytes = std::vector<std::uint8_t>;

  void serve() {
    while (!ending_) {
      std::vector<pollfd> all = {{listener_, POLLIN, 0}};
      for (const auto& [fd, bytes] : peers_) all.push_back({fd, POLLIN, 0});
      ::poll(all.data(), all.size(), 2);
      if ((all[0].revents & POLLIN) != 0) peers_[::accept(listener_, nullptr, nullptr)];
      for (std::size_t i = 1; i < all.size(); ++i) {
        if (all[i].revents != 0) take(all[i].fd);
      }
      if (hang_up_.exchange(false)) {
        for (const auto& [fd, bytes] : peers_) ::close(fd);
        peers_.clear();
      }
      with([](FakeModules& m) { m.work(); });
      tell();
    }
  }
  void take(int fd) {
    std::array<std::uint8_t, 4096> buffer{};
    const ssize_t n = ::recv(fd, buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (n <= 0) {
      ::close(fd);
      peers_.erase(fd);
      return;
    }
    Bytes& bytes = peers_[fd];
    bytes.insert(bytes.end(), buffer.begin(), buffer.begin() + n);
    while (bytes.size() >= 6) {
      const std::size_t size = 6U + bytes[0] + 256U * bytes[1];
      if (bytes.size() < size) return;
      to_bus(Bytes(bytes.begin() + 4, bytes.begin() + static_cast<std::ptrdiff_t>(size)));
      bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    }
  }
  void to_bus(const Bytes& inner) {
    for (std::size_t at = 0; at < inner.size(); at += 8) {
      const bool last = at + 8 >= inner.size();
      const std::uint32_t kind = at == 0 && last ? 3 : at == 0 ? 1 : last ? 2 : 0;
      ear_->send(make_frame(kind << 8, std::span(inner).subspan(at, std::min<std::size_t>(8, inner.size() - at))));
    }
  }
  void tell() {
    CanFrame frame;
    while (ear_->receive(frame)) {
      const std::uint32_t source = frame.id & 0xFFU;
      Bytes& inner = open_[source];
      inner.insert(inner.end(), frame.data.begin(), frame.data.begin() + frame.size);
      if (frame.id >> 8 < 2) continue;
      const std::size_t payload = inner.size() - 2;
      Bytes message = {static_cast<std::uint8_t>(payload), static_cast<std::uint8_t>(payload >> 8),
                       static_cast<std::uint8_t>(source), 0};
      message.insert(message.end(), inner.begin(), inner.end());
      inner.clear();
      for (const auto& [fd, bytes] : peers_) (void)!::send(fd, message.data(), message.size(), MSG_NOSIGNAL);
    }
  }

  int listener_;
  MemoryBus bus_{monotonic_ns, 8192};
  std::mutex mutex_;
  FakeModules modules_;
  std::unique_ptr<CanLink> ear_;
  std::map<int, Bytes> peers_;           // and what of a message has come from each
  std::map<std::uint32_t, Bytes> open_;  // messages of modules that are not whole yet
  std::atomic<bool> ending_{false}, hang_up_{false};
  std::thread thread_;
};

}  // namespace tandem::bridges::footbot
