#include "bridges/link/serial_link.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <libserial/SerialPort.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>
#include <utility>

namespace tandem::bridges {
namespace {

using enum LibSerial::BaudRate;

constexpr std::pair<std::uint32_t, LibSerial::BaudRate> kRates[] = {
    {1200, BAUD_1200},       {2400, BAUD_2400},       {4800, BAUD_4800},       {9600, BAUD_9600},
    {19200, BAUD_19200},     {38400, BAUD_38400},     {57600, BAUD_57600},     {115200, BAUD_115200},
    {230400, BAUD_230400},   {460800, BAUD_460800},   {500000, BAUD_500000},   {576000, BAUD_576000},
    {921600, BAUD_921600},   {1000000, BAUD_1000000}, {1152000, BAUD_1152000}, {1500000, BAUD_1500000},
    {2000000, BAUD_2000000}, {2500000, BAUD_2500000}, {3000000, BAUD_3000000}, {4000000, BAUD_4000000}};

LibSerial::BaudRate baud_rate(std::uint32_t rate) noexcept {
  const auto* const found = std::ranges::find(kRates, rate, &std::pair<std::uint32_t, LibSerial::BaudRate>::first);
  return found == std::end(kRates) ? BAUD_INVALID : found->second;
}

std::string advice(int error) {
  switch (error) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return "there is no such device; is the robot or adapter plugged in, or the rfcomm device bound?";
    case EACCES:
    case EPERM:
      return "no permission; add yourself to the group that owns it (usually: sudo usermod -aG dialout $USER, then log "
             "in again)";
    case EBUSY:
      return "it is in use by another program; close that one first";
    case EISDIR:
    case ENOTTY:
      return "it is not a terminal device; name a serial port such as /dev/ttyUSB0 or /dev/rfcomm0";
    case EHOSTDOWN:
    case EHOSTUNREACH:
    case ECONNREFUSED:
    case ETIMEDOUT:
      return std::string(std::strerror(error)) + "; is the robot switched on, in range and paired?";
    default:
      return std::strerror(error);
  }
}

hal::Error open_error(const LinkAddress& address, int error) {
  return hal::Error{"cannot open " + to_text(address) + ": " + advice(error)};
}

/// Closes a descriptor at the end of a scope.
struct Descriptor {
  explicit Descriptor(int descriptor) : fd(descriptor) {}
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int fd;
};

/// 0, or why the device cannot be used. LibSerial must never see such a device: it would abort on giving it up. `probe`
/// stays open meanwhile, so that a Bluetooth connection is made once.
int check_device(int probe, bool beside) noexcept {
  if (probe < 0) return errno;
  if (::isatty(probe) == 0) return ENOTTY;
  if (!beside && ::flock(probe, LOCK_EX | LOCK_NB) != 0) return EBUSY;
  return 0;
}

}  // namespace

/// LibSerial's port. Closing one that was hung up throws out of LibSerial's destructor and ends the process; therefore
/// its descriptor is first pointed at a scratch terminal, which always closes well.
class SerialLink::Port {
 public:
  explicit Port(const LinkAddress& address) : serial_(std::make_unique<LibSerial::SerialPort>()) {
    serial_->Open(address.target);
    serial_->SetBaudRate(baud_rate(address.rate));
    serial_->SetCharacterSize(LibSerial::CharacterSize::CHAR_SIZE_8);
    serial_->SetParity(LibSerial::Parity::PARITY_NONE);
    serial_->SetStopBits(LibSerial::StopBits::STOP_BITS_1);
    serial_->SetFlowControl(LibSerial::FlowControl::FLOW_CONTROL_NONE);
    serial_->SetVMin(0);
    serial_->SetVTime(0);
  }
  ~Port() {
    const int descriptor = serial_->IsOpen() ? serial_->GetFileDescriptor() : -1;
    if (descriptor < 0) return;
    ::ioctl(descriptor, TIOCNXCL);
    ::flock(descriptor, LOCK_UN);  // a child that somebody has forked may hold it as well
    const Descriptor master(::posix_openpt(O_RDWR | O_NOCTTY));
    char path[64] = {};
    const bool made = master.fd >= 0 && ::grantpt(master.fd) == 0 && ::unlockpt(master.fd) == 0 &&
                      ::ptsname_r(master.fd, path, sizeof path) == 0;
    const Descriptor slave(made ? ::open(path, O_RDWR | O_NOCTTY | O_NONBLOCK) : -1);
    if (slave.fd >= 0 && ::dup2(slave.fd, descriptor) >= 0) {
      try {
        serial_->Close();
        return;
      } catch (const std::exception&) {
      }
    }
    // No scratch terminal to be had: give up the few bytes of LibSerial's object rather than the process.
    ::close(descriptor);
    static_cast<void>(serial_.release());
  }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;

  int descriptor() const { return serial_->GetFileDescriptor(); }

 private:
  std::unique_ptr<LibSerial::SerialPort> serial_;
};

hal::Result<std::unique_ptr<ByteLink>> SerialLink::open(const LinkAddress& address, bool beside) {
  const Descriptor probe(::open(address.target.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (const int error = check_device(probe.fd, beside); error != 0) return open_error(address, error);
  try {
    auto port = std::make_unique<Port>(address);
    const int fd = port->descriptor();
    ::ioctl(fd, TIOCNXCL);  // LibSerial has set it
    ::flock(probe.fd, LOCK_UN);
    if (!beside && ::flock(fd, LOCK_EX | LOCK_NB) != 0) return open_error(address, EBUSY);
    ::fcntl(fd, F_SETFD, FD_CLOEXEC);
    ::fcntl(fd, F_SETFL, ::fcntl(fd, F_GETFL) | O_NONBLOCK);
    ::tcflush(fd, TCIFLUSH);
    return std::unique_ptr<ByteLink>(new SerialLink(address, std::move(port)));
  } catch (const std::exception& e) {
    return hal::Error{"cannot set up " + to_text(address) + ": " + e.what()};
  }
}

SerialLink::SerialLink(LinkAddress address, std::unique_ptr<Port> port)
    : DescriptorLink(port->descriptor()), address_(std::move(address)), port_(std::move(port)) {}

SerialLink::~SerialLink() = default;

ssize_t SerialLink::put(std::span<const std::uint8_t> bytes) noexcept {
  return ::write(descriptor_, bytes.data(), bytes.size());
}

Received SerialLink::read(std::span<std::uint8_t> buffer) noexcept {
  if (!open_ || buffer.empty()) return {};
  pollfd p{descriptor_, POLLIN, 0};
  if (::poll(&p, 1, 0) <= 0) return {};
  const ssize_t n = (p.revents & POLLIN) != 0 ? ::read(descriptor_, buffer.data(), buffer.size()) : 0;
  const bool nothing_yet = n < 0 && (errno == EAGAIN || errno == EINTR);
  if (n > 0) return received(n);
  // Readable but empty, or an error: that is how a hang-up shows.
  if (!nothing_yet) hang_up();
  return {};
}

}  // namespace tandem::bridges
