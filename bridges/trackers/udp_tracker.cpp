#include "bridges/trackers/udp_tracker.hpp"

#include <arpa/inet.h>
#include <cerrno>
#include <cstring>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "bridges/sighting_box.hpp"
#include "bridges/trackers/decoding.hpp"
#include "hal/monotonic.hpp"

namespace tandem::bridges::trackers {
namespace {

constexpr std::size_t kLargestDatagram = 65536;
constexpr int kReceiveRoom = 1 << 20;

using hal::monotonic_ns;

hal::Result<in_addr> parse_address(const std::string& text) {
  in_addr address{};
  if (::inet_pton(AF_INET, text.c_str(), &address) == 1) return address;
  return hal::Error{"'" + text + "' is no address of the form 127.0.0.1"};
}

bool is_multicast(const in_addr& address) noexcept {
  return (ntohl(address.s_addr) & 0xF0000000U) == 0xE0000000U;
}

class UdpTracker final : public Tracker {
 public:
  UdpTracker(in_addr address, std::uint16_t port, std::string id, const hal::Log& log)
      : address_(address), port_(port), id_(std::move(id)), log_(log) {}
  ~UdpTracker() override {
    if (thread_.joinable()) {
      const std::uint64_t one = 1;
      while (::write(wake_, &one, sizeof one) < 0 && errno == EINTR) continue;
      thread_.join();
    }
    if (wake_ >= 0) ::close(wake_);
    if (socket_ >= 0) ::close(socket_);
  }

  hal::Status start() override {
    if (thread_.joinable()) return {};
    if (const hal::Status opened = open_socket(); !opened.ok()) return opened;
    thread_ = std::thread([this] { listen(); });
    return {};
  }
  std::size_t take(std::span<Sighting> into) noexcept override { return box_.take(into); }
  TrackerReport report() const override { return box_.report(); }

 private:
  hal::Status open_socket() {
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    wake_ = ::eventfd(0, EFD_CLOEXEC);
    if (socket_ < 0 || wake_ < 0) return failed("no socket can be made");
    const bool group = is_multicast(address_);
    const int yes = 1;
    if (group) ::setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &kReceiveRoom, sizeof kReceiveRoom);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr = address_;
    at.sin_port = htons(port_);
    if (::bind(socket_, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0)
      return failed("datagrams cannot be taken at port " + std::to_string(port_));
    const ip_mreq member{address_, {htonl(INADDR_ANY)}};
    if (group && ::setsockopt(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, &member, sizeof member) != 0)
      return failed("the multicast group cannot be joined");
    socklen_t length = sizeof at;
    ::getsockname(socket_, reinterpret_cast<sockaddr*>(&at), &length);
    log_.info("tracker '" + id_ + "' listens at UDP port " + std::to_string(ntohs(at.sin_port)));
    return {};
  }
  hal::Error failed(const std::string& what) const { return hal::Error{what + ": " + std::strerror(errno)}; }

  void listen() {
    std::vector<std::byte> datagram(kLargestDatagram);
    std::vector<Sighting> seen;
    std::array<pollfd, 2> waits = {{{socket_, POLLIN, 0}, {wake_, POLLIN, 0}}};
    for (;;) {
      if (::poll(waits.data(), waits.size(), -1) < 0 && errno != EINTR) return box_.set_trouble("it cannot be waited");
      if (waits[1].revents != 0) return;
      for (;;) {
        const ssize_t size = ::recv(socket_, datagram.data(), datagram.size(), 0);
        if (size < 0) break;
        take_datagram(std::span(datagram).first(static_cast<std::size_t>(size)), seen);
      }
    }
  }
  void take_datagram(std::span<const std::byte> data, std::vector<Sighting>& seen) {
    const hal::TimeNs now = monotonic_ns();
    seen.clear();
    const bool good = is_compact(data) ? decode_compact(data, seen) : decode_json(data, seen);
    for (Sighting& sighting : seen) sighting.received_ns = now;
    box_.put(seen, !good);
  }

  in_addr address_;
  std::uint16_t port_;
  std::string id_;
  hal::Log log_;
  int socket_ = -1, wake_ = -1;
  SightingBox box_;
  std::thread thread_;
};

}  // namespace

MadeTracker make_udp_tracker(const TrackerRequest& request, const hal::Log& log) {
  const auto options = options_of<UdpOptions>(request);
  const auto address = parse_address(options.address);
  if (!address.ok()) return address.error();
  return std::unique_ptr<Tracker>(
      std::make_unique<UdpTracker>(address.value(), static_cast<std::uint16_t>(options.port), request.id, log));
}

hal::Status check_udp_tracker(const TrackerRequest& request) {
  const auto address = parse_address(options_of<UdpOptions>(request).address);
  return address.ok() ? hal::Status{} : address.error();
}

}  // namespace tandem::bridges::trackers
