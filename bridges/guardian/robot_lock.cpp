#include "bridges/guardian/robot_lock.hpp"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bridges/guardian/packet.hpp"

namespace tandem::bridges::guardian {
namespace {

hal::Error failed(const std::string& what, const std::string& path) {
  return hal::Error{what + " '" + path + "': " + std::strerror(errno)};
}

/// First lines for people, then the same as a packet for programs.
std::string to_text(const LockHolder& h) {
  std::string text = "robot " + h.robot.robot + "\nlink " + h.robot.link + "\nhub " + std::to_string(h.hub) +
                     "\nguardian " + std::to_string(h.guardian) + "\nstate " + (h.left ? "left" : "driven") + "\n";
  return text + "stop " + encode({Word::Watch, h.robot, ""}) + "\n";
}

std::string line_after(const std::string& text, const std::string& word) {
  const std::string mark = "\n" + word + " ";
  const std::size_t at = text.find(mark);
  if (at == std::string::npos) return {};
  const std::size_t begin = at + mark.size();
  return text.substr(begin, text.find('\n', begin) - begin);
}

std::optional<LockHolder> from_text(const std::string& text) {
  const std::size_t stop = text.find("\nstop ");
  if (stop == std::string::npos) return std::nullopt;
  const auto packet = decode(std::string_view(text).substr(stop + 6, text.size() - stop - 7));
  if (!packet) return std::nullopt;
  LockHolder holder;
  holder.robot = packet->robot;
  const std::string head = text.substr(0, stop + 1);
  holder.hub = static_cast<pid_t>(std::strtol(line_after(head, "hub").c_str(), nullptr, 10));
  holder.guardian = static_cast<pid_t>(std::strtol(line_after(head, "guardian").c_str(), nullptr, 10));
  holder.left = line_after(head, "state") == "left";
  return holder;
}

std::optional<LockHolder> read_holder(int descriptor) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t n = 1; n > 0 && text.size() < 2 * kLongestPacket;) {
    n = ::pread(descriptor, buffer.data(), buffer.size(), static_cast<off_t>(text.size()));
    if (n > 0) text.append(buffer.data(), static_cast<std::size_t>(n));
  }
  return from_text(text);
}

/// The file was removed by its last holder after we opened it.
bool removed(int descriptor, const std::string& path) {
  struct stat open {};
  struct stat named {};
  if (::fstat(descriptor, &open) != 0 || ::stat(path.c_str(), &named) != 0) return true;
  return open.st_ino != named.st_ino || open.st_dev != named.st_dev;
}

}  // namespace

hal::Result<std::string> lock_folder() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  const std::string folder = runtime != nullptr && *runtime == '/' && ::access(runtime, W_OK) == 0
                                 ? std::string(runtime) + "/tandem"
                                 : "/tmp/tandem-" + std::to_string(::getuid());
  if (::mkdir(folder.c_str(), 0700) != 0 && errno != EEXIST) return failed("cannot make the folder", folder);
  struct stat info {};
  if (::lstat(folder.c_str(), &info) != 0) return failed("cannot read the folder", folder);
  if (!S_ISDIR(info.st_mode) || info.st_uid != ::getuid()) {
    return hal::Error{"'" + folder + "' is not a folder of yours; remove it, locks of robots belong there"};
  }
  return folder;
}

std::string lock_key(const StopMessages& robot) {
  std::string link = robot.link;
  if (link.starts_with("serial:") || link.starts_with("slcan:")) {
    // One device may have several names; the rate behind the @ does not make it another one.
    const std::size_t path = link.find(':') + 1;
    const std::size_t rate = link.rfind('@');
    const std::string device = link.substr(path, rate == std::string::npos ? rate : rate - path);
    std::error_code error;
    const auto real = std::filesystem::weakly_canonical(device, error);
    link = "device " + (error ? device : real.string());
  } else {
    // The same address in another network is another robot.
    std::array<char, 64> network{};
    const ssize_t n = ::readlink("/proc/self/ns/net", network.data(), network.size());
    if (n > 0) link += " " + std::string(network.data(), static_cast<std::size_t>(n));
  }
  std::string key;
  for (const char c : link + (robot.name.empty() ? "" : " " + robot.name)) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-';
    if (plain) {
      key += c;
    } else {
      constexpr std::string_view kHex = "0123456789abcdef";
      key += '_';
      if (c == '/' || c == ' ') continue;
      key += kHex[static_cast<unsigned char>(c) >> 4U];
      key += kHex[static_cast<unsigned char>(c) & 15U];
    }
  }
  if (key.size() > 200) key = key.substr(0, 180) + "-" + std::to_string(std::hash<std::string>{}(key));
  return key;
}

hal::Result<std::optional<RobotLock>> RobotLock::take(const std::string& folder, const std::string& key,
                                                      std::optional<LockHolder>& holder) {
  const std::string path = folder + "/" + key + ".lock";
  for (;;) {
    const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    if (fd < 0) return failed("cannot open the lock", path);
    const bool ours = ::flock(fd, LOCK_EX | LOCK_NB) == 0;
    if (ours && removed(fd, path)) {
      ::close(fd);
      continue;
    }
    holder = read_holder(fd);
    if (ours) return std::optional(RobotLock(path, fd));
    ::close(fd);
    return std::optional<RobotLock>();
  }
}

RobotLock::RobotLock(RobotLock&& other) noexcept : path_(std::move(other.path_)), descriptor_(other.descriptor_) {
  other.descriptor_ = -1;
}

RobotLock& RobotLock::operator=(RobotLock&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

RobotLock::~RobotLock() {
  if (descriptor_ < 0) return;
  ::unlink(path_.c_str());
  ::close(descriptor_);
}

void RobotLock::write(const LockHolder& holder) const {
  const std::string text = to_text(holder);
  (void)!::ftruncate(descriptor_, 0);
  (void)!::pwrite(descriptor_, text.data(), text.size(), 0);
}

std::string takeover_socket(const std::string& folder, pid_t guardian) {
  return folder + "/guardian-" + std::to_string(guardian) + ".socket";
}

}  // namespace tandem::bridges::guardian
