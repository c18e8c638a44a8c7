#include "bridges/can/socketcan_link.hpp"

#include <cerrno>
#include <cstring>
#include <ctime>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bridges/can/kernel_frame.hpp"
#include "bridges/link/link.hpp"

namespace tandem::bridges {
namespace {

constexpr int kReceiveBuffer = 4 << 20;  // bytes; a frame takes some 200 of them

std::string advice(int error, const std::string& interface) {
  switch (error) {
    case EAFNOSUPPORT:
    case EPROTONOSUPPORT:
      return "this kernel has no CAN (CONFIG_CAN, module can-raw); use an slcan adapter, slcan:/dev/ttyACM0, or the "
             "robot's own network port, tcp:ROBOT:33333";
    case ENODEV:
      return "there is no such interface; is the adapter plugged in? `ip link` lists them";
    case ENETDOWN:
      return "the interface is down; as root: ip link set " + interface + " up type can bitrate 1000000 restart-ms 100";
    case EPERM:
    case EACCES:
      return "no permission to use CAN sockets here";
    default:
      return std::strerror(error);
  }
}

/// Closes a socket unless it was released.
struct Socket {
  explicit Socket(int descriptor) : fd(descriptor) {}
  ~Socket() {
    if (fd >= 0) ::close(fd);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int release() { return std::exchange(fd, -1); }
  int fd;
};

template <class T>
bool set_option(int socket, int level, int option, const T& value) noexcept {
  return ::setsockopt(socket, level, option, &value, sizeof value) == 0;
}

bool set_filters(int socket, const std::vector<CanFilter>& filters) {
  if (filters.empty()) return true;
  std::vector<can_filter> raw;
  for (const CanFilter& f : filters) {
    raw.push_back({f.id | (f.extended ? CAN_EFF_FLAG : 0U), f.mask | CAN_EFF_FLAG | CAN_RTR_FLAG});
  }
  return ::setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, raw.data(),
                      static_cast<socklen_t>(raw.size() * sizeof raw[0])) == 0;
}

/// 0, or the error that kept the interface from being bound.
int bind_interface(int socket, const std::string& interface) noexcept {
  ifreq request{};
  if (interface.empty() || interface.size() >= sizeof request.ifr_name) return ENODEV;
  std::strncpy(request.ifr_name, interface.c_str(), sizeof request.ifr_name - 1);
  if (::ioctl(socket, SIOCGIFINDEX, &request) != 0) return errno;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return errno;
  if (::ioctl(socket, SIOCGIFFLAGS, &request) != 0) return errno;
  return (request.ifr_flags & IFF_UP) != 0 ? 0 : ENETDOWN;
}

/// Arrival on the monotonic clock from the kernel's stamp on the wall clock.
hal::TimeNs arrival(const timespec& stamp) noexcept {
  timespec wall{};
  ::clock_gettime(CLOCK_REALTIME, &wall);
  const hal::TimeNs age = (wall.tv_sec - stamp.tv_sec) * hal::kNsPerSecond + (wall.tv_nsec - stamp.tv_nsec);
  // A wall clock that was set meanwhile must not put frames into the future or far into the past.
  return monotonic_ns() - (age >= 0 && age < hal::kNsPerSecond ? age : 0);
}

}  // namespace

hal::Result<std::unique_ptr<CanLink>> SocketCanLink::open(const std::string& interface,
                                                          const std::vector<CanFilter>& filters) {
  const auto refuse = [&](int error) {
    return hal::Error{"cannot open can:" + interface + ": " + advice(error, interface)};
  };
  Socket socket(::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (socket.fd < 0) return refuse(errno);
  if (!set_filters(socket.fd, filters)) return refuse(errno);
  if (!set_option(socket.fd, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, can_err_mask_t{error_mask()})) return refuse(errno);
  // These make the link better and not possible: a kernel without them still carries frames.
  set_option(socket.fd, SOL_SOCKET, SO_RCVBUF, kReceiveBuffer);
  set_option(socket.fd, SOL_SOCKET, SO_RXQ_OVFL, 1);
  set_option(socket.fd, SOL_SOCKET, SO_TIMESTAMPNS, 1);
  if (const int error = bind_interface(socket.fd, interface); error != 0) return refuse(error);
  return std::unique_ptr<CanLink>(new SocketCanLink(interface, socket.release()));
}

SocketCanLink::~SocketCanLink() {
  ::close(socket_);
}

void SocketCanLink::note_failure(int error) noexcept {
  switch (error) {
    case EAGAIN:
    case EINTR:
      break;
    case ENETDOWN:
      record_.become(BusState::Down);
      break;
    case ENODEV:
    case ENXIO:
    case EBADF:
      record_.become(BusState::Gone);
      break;
    default:
      ++record_.counts.failed_calls;
  }
}

void SocketCanLink::look_whether_up() noexcept {
  if (record_.state() != BusState::Down) return;
  ifreq request{};
  std::strncpy(request.ifr_name, interface_.c_str(), sizeof request.ifr_name - 1);
  if (::ioctl(socket_, SIOCGIFFLAGS, &request) != 0) {
    note_failure(errno);
  } else if ((request.ifr_flags & IFF_UP) != 0) {
    record_.become(BusState::Active);
  }
}

Sent SocketCanLink::send(const CanFrame& frame) noexcept {
  look_whether_up();
  if (!frame.valid() || !can_pass(record_.state())) {
    ++record_.counts.refused;
    return Sent::Refused;
  }
  const can_frame raw = to_kernel(frame);
  if (::write(socket_, &raw, sizeof raw) == static_cast<ssize_t>(sizeof raw)) {
    ++record_.counts.frames_out;
    return Sent::Taken;
  }
  // The interface's queue (ENOBUFS, of which poll() knows nothing) or the socket's (EAGAIN).
  if (errno == ENOBUFS || errno == EAGAIN || errno == EINTR) {
    ++record_.counts.full;
    return Sent::Full;
  }
  note_failure(errno);
  ++record_.counts.refused;
  return Sent::Refused;
}

bool SocketCanLink::receive(CanFrame& frame) noexcept {
  look_whether_up();
  while (record_.state() != BusState::Gone) {
    can_frame raw{};
    iovec part{&raw, sizeof raw};
    alignas(cmsghdr) char control[128];
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    const ssize_t n = ::recvmsg(socket_, &message, MSG_DONTWAIT);
    if (n < 0) {
      note_failure(errno);
      // ENETDOWN is told once and hides frames that still wait behind it.
      if (errno == EINTR || errno == ENETDOWN) continue;
      return false;
    }
    hal::TimeNs at = monotonic_ns();
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
      if (c->cmsg_level != SOL_SOCKET) continue;
      if (c->cmsg_type == SO_TIMESTAMPNS) {
        timespec stamp{};
        std::memcpy(&stamp, CMSG_DATA(c), sizeof stamp);
        at = arrival(stamp);
      } else if (c->cmsg_type == SO_RXQ_OVFL) {
        std::uint32_t drops = 0;
        std::memcpy(&drops, CMSG_DATA(c), sizeof drops);
        record_.counts.overrun += drops - kernel_drops_;
        kernel_drops_ = drops;
      }
    }
    if (n != static_cast<ssize_t>(sizeof raw)) {
      ++record_.counts.malformed;
      continue;
    }
    if (is_error_frame(raw)) {
      note_error_frame(raw, record_);
      continue;
    }
    const auto read = from_kernel(raw);
    if (!read) {
      ++record_.counts.malformed;
      continue;
    }
    // Where frames arrive the bus is alive, even when the news of its restart was lost.
    if (record_.state() == BusState::BusOff) record_.become(BusState::Active);
    ++record_.counts.frames_in;
    frame = *read;
    frame.at_ns = at;
    return true;
  }
  return false;
}

bool SocketCanLink::wait(hal::TimeNs timeout_ns) noexcept {
  if (record_.state() == BusState::Gone) return wait_for_input(-1, timeout_ns);
  const bool down = record_.state() == BusState::Down;
  // An interface that comes up wakes nobody.
  const bool ready = wait_for_input(socket_, down ? std::min(timeout_ns, 50 * hal::kNsPerMs) : timeout_ns);
  look_whether_up();
  return ready;
}

}  // namespace tandem::bridges
