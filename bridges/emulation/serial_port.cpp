#include "bridges/emulation/serial_port.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "hal/check.hpp"

namespace tandem::bridges {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPty = "pty:";
constexpr std::string_view kSerial = "serial:";

hal::Error failed(const std::string& what) {
  return hal::Error{what + ": " + std::strerror(errno)};
}

struct Speed {
  speed_t code;
  unsigned long baud;
};

constexpr Speed kSpeeds[] = {{B1200, 1200},     {B2400, 2400},     {B4800, 4800},     {B9600, 9600},
                             {B19200, 19200},   {B38400, 38400},   {B57600, 57600},   {B115200, 115200},
                             {B230400, 230400}, {B460800, 460800}, {B921600, 921600}, {B1000000, 1000000}};

unsigned long baud_of(speed_t code) {
  const auto* const found = std::ranges::find(kSpeeds, code, &Speed::code);
  return found == std::end(kSpeeds) ? 0 : found->baud;
}

speed_t code_of(unsigned long baud) {
  const auto* const found = std::ranges::find(kSpeeds, baud, &Speed::baud);
  TANDEM_CHECK(found != std::end(kSpeeds), "a robot's speed is a usual one");
  return found->code;
}

/// Raw, 8N1. A host that opens a fresh pseudo-terminal without a word about speed finds the robot's.
bool make_raw(int descriptor, unsigned long baud) {
  termios settings{};
  if (tcgetattr(descriptor, &settings) != 0) return false;
  cfmakeraw(&settings);
  settings.c_cflag |= CREAD | CLOCAL;
  settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB);
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  cfsetispeed(&settings, code_of(baud));
  cfsetospeed(&settings, code_of(baud));
  return tcsetattr(descriptor, TCSANOW, &settings) == 0;
}

}  // namespace

hal::Result<std::unique_ptr<SerialPort>> SerialPort::open(const std::string& link, const std::string& robot,
                                                          unsigned long baud) {
  const std::string rate = std::to_string(baud);
  std::unique_ptr<SerialPort> port(new SerialPort(baud));
  port->link_ = link;
  hal::Status status;
  if (link.starts_with(kPty) && link.size() > kPty.size()) {
    status = port->make_terminal(link.substr(kPty.size()));
  } else if (link.starts_with(kSerial) && link.size() > kSerial.size()) {
    std::string device = link.substr(kSerial.size());
    const std::size_t at = device.rfind('@');
    if (at != std::string::npos) {
      if (device.substr(at + 1) != rate) {
        return hal::Error{"link '" + link + "': " + robot + " speaks at " + rate + " baud only"};
      }
      device.resize(at);
    }
    status = port->open_device(device);
  } else {
    return hal::Error{"link '" + link + "': " + robot + " takes pty:NAME or serial:DEVICE@" + rate};
  }
  if (!status.ok()) return status.error();
  return port;
}

hal::Status SerialPort::make_terminal(const std::string& path) {
  std::error_code ignored;
  const fs::file_status there = fs::symlink_status(path, ignored);
  if (fs::exists(there) && !fs::is_symlink(there)) {
    return hal::Error{"'" + path + "' is there already and is no symbolic link; remove it or choose another name"};
  }
  descriptor_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0 || grantpt(descriptor_) != 0 || unlockpt(descriptor_) != 0) {
    return failed("cannot make a pseudo-terminal");
  }
  std::array<char, 128> name{};
  if (ptsname_r(descriptor_, name.data(), name.size()) != 0) return failed("cannot name the pseudo-terminal");
  device_ = name.data();
  slave_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (slave_ < 0 || !make_raw(slave_, baud_)) return failed("cannot set up '" + device_ + "'");

  // Made beside and moved into place: a host never finds half of it.
  const std::string fresh = path + "." + std::to_string(getpid()) + ".new";
  ::unlink(fresh.c_str());
  if (::symlink(device_.c_str(), fresh.c_str()) != 0) return failed("cannot make the link '" + path + "'");
  if (::rename(fresh.c_str(), path.c_str()) != 0) {
    const hal::Error error = failed("cannot make the link '" + path + "'");
    ::unlink(fresh.c_str());
    return error;
  }
  path_ = path;
  owns_link_ = true;
  return {};
}

hal::Status SerialPort::open_device(const std::string& device) {
  path_ = device_ = device;
  descriptor_ = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor_ < 0) return failed("cannot open the serial device '" + device + "'");
  if (!make_raw(descriptor_, baud_)) return failed("'" + device + "' is no serial device");
  return {};
}

SerialPort::~SerialPort() {
  if (owns_link_) {
    std::array<char, 128> target{};
    const ssize_t n = ::readlink(path_.c_str(), target.data(), target.size());
    if (n > 0 && std::string(target.data(), static_cast<std::size_t>(n)) == device_) ::unlink(path_.c_str());
  }
  if (slave_ >= 0) ::close(slave_);
  if (descriptor_ >= 0) ::close(descriptor_);
}

hal::Result<std::size_t> SerialPort::read(std::span<std::uint8_t> buffer) {
  const ssize_t n = ::read(descriptor_, buffer.data(), buffer.size());
  if (n > 0) return static_cast<std::size_t>(n);
  if (n < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) {
    return failed("the serial line '" + path_ + "' has gone");
  }
  return std::size_t{0};
}

std::size_t SerialPort::write(std::span<const std::uint8_t> bytes) {
  const ssize_t n = ::write(descriptor_, bytes.data(), bytes.size());
  return n > 0 ? static_cast<std::size_t>(n) : 0;
}

unsigned long SerialPort::host_baud() const {
  termios settings{};
  if (slave_ < 0 || tcgetattr(slave_, &settings) != 0) return baud_;
  return baud_of(cfgetospeed(&settings));
}

}  // namespace tandem::bridges
