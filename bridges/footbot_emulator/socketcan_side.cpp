#include <cerrno>
#include <cstring>
#include <deque>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bridges/footbot_emulator/host_side.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

constexpr std::size_t kMostUnsent = 1100;  // frames that the robot's translator can keep

/// All modules behind one raw socket.
class SocketCanSide final : public HostSide {
 public:
  SocketCanSide(std::string interface, int socket, EventSink sink)
      : path_("can:" + interface), socket_(socket), sink_(std::move(sink)) {}
  ~SocketCanSide() override { ::close(socket_); }
  SocketCanSide(const SocketCanSide&) = delete;
  SocketCanSide& operator=(const SocketCanSide&) = delete;

  // A full queue of the interface wakes nobody: what waits is tried again whenever the robot does something.
  void add_polls(std::vector<pollfd>& polls) const override { polls.push_back({socket_, POLLIN, 0}); }

  hal::Status take(hal::TimeNs now, std::vector<Frame>& to_bus) override {
    can_frame raw{};
    ssize_t n = 0;
    while ((n = ::recv(socket_, &raw, sizeof raw, MSG_DONTWAIT)) == static_cast<ssize_t>(sizeof raw)) {
      if ((raw.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_ERR_FLAG)) != 0) {
        sink_(now, "ignored", {{"id", raw.can_id}, {"why", "no module takes extended or remote frames"}});
        continue;
      }
      Frame frame;
      frame.id = static_cast<std::uint16_t>(raw.can_id & CAN_SFF_MASK);
      frame.size = std::min<std::uint8_t>(raw.can_dlc, 8);
      std::copy_n(raw.data, frame.size, frame.data.begin());
      to_bus.push_back(frame);
    }
    // ENETDOWN is told once; the interface may come up again.
    const bool gone = n < 0 && (errno == ENODEV || errno == ENXIO || errno == EBADF);
    if (gone) return hal::Error{path_ + " has gone: " + std::strerror(errno)};
    return {};
  }

  void tell(const Frame& frame, hal::TimeNs now) override {
    unsent_.push_back(frame);
    flush(now);
    if (unsent_.size() <= kMostUnsent) return;
    sink_(now, "overflow", {{"frames", unsent_.size() - kMostUnsent}});
    unsent_.resize(kMostUnsent);
  }

  void flush(hal::TimeNs /*now*/) override {
    while (!unsent_.empty()) {
      can_frame raw{};
      raw.can_id = unsent_.front().id;
      raw.can_dlc = unsent_.front().size;
      std::copy_n(unsent_.front().data.begin(), raw.can_dlc, raw.data);
      if (::send(socket_, &raw, sizeof raw, MSG_DONTWAIT) != static_cast<ssize_t>(sizeof raw)) return;
      unsent_.pop_front();
    }
  }

  const std::string& path() const override { return path_; }
  const std::string& link() const override { return path_; }

 private:
  std::string path_;
  int socket_;
  EventSink sink_;
  std::deque<Frame> unsent_;
};

}  // namespace

hal::Result<std::unique_ptr<HostSide>> open_socketcan(const std::string& interface, const EventSink& sink) {
  const int socket = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  const auto refuse = [&](const std::string& why) {
    if (socket >= 0) ::close(socket);
    return hal::Error{"cannot open can:" + interface + ": " + why};
  };
  if (socket < 0) {
    return refuse(std::string(std::strerror(errno)) + "; where the kernel has no CAN, emulate on pty:NAME");
  }
  const unsigned index = ::if_nametoindex(interface.c_str());
  if (index == 0) {
    return refuse("there is no such interface; a virtual one is made by: ip link add dev vcan0 type vcan");
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(index);
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return refuse(std::strerror(errno));
  }
  return std::unique_ptr<HostSide>(std::make_unique<SocketCanSide>(interface, socket, sink));
}

}  // namespace tandem::bridges::footbot_emulator
