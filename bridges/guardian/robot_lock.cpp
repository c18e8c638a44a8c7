#include "bridges/guardian/robot_lock.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include "bridges/guardian/packet.hpp"
#include "bridges/guardian/same_robot.hpp"
#include "bridges/link/device.hpp"

namespace tandem::bridges::guardian {
namespace {

hal::Error failed(const std::string& what, const std::string& path) {
  return hal::Error{what + " '" + path + "': " + std::strerror(errno)};
}

constexpr std::array<std::pair<LockState, const char*>, 4> kStates = {{{LockState::Claimed, "claimed"},
                                                                       {LockState::Driven, "driven"},
                                                                       {LockState::Rests, "rests"},
                                                                       {LockState::Left, "left"}}};

/// First lines for people, then the same as a packet for programs.
std::string to_text(const LockHolder& h) {
  const auto state = std::ranges::find(kStates, h.state, &decltype(kStates)::value_type::first);
  std::string text = "robot " + h.robot.robot + "\nlink " + h.robot.link + "\nhub " + std::to_string(h.hub) +
                     "\nguardian " + std::to_string(h.guardian) + "\nstate " + state->second + "\n";
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
  for (const auto& [state, name] : kStates) {
    if (line_after(head, "state") == name) holder.state = state;
  }
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

/// The same address in another network is another robot.
std::string network() {
  std::array<char, 64> network{};
  const ssize_t n = ::readlink("/proc/self/ns/net", network.data(), network.size());
  return n > 0 ? " " + std::string(network.data(), static_cast<std::size_t>(n)) : "";
}

/// All of this computer's own addresses by which it calls itself are one.
std::string one_loopback(const std::string& device) {
  const bool loopback = device.starts_with("127.") || device.starts_with("[::1]") || device.starts_with("[::ffff:127.");
  return loopback ? "127.0.0.1" + device.substr(device.rfind(':')) : device;
}

/// Text for a file's name.
std::string key_of(const std::string& what, const std::string& name) {
  std::string key;
  for (const char c : what + (name.empty() ? "" : " " + name)) {
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

std::string written_key(const StopMessages& robot) {
  std::string link = robot.link;
  if (is_terminal(link)) {
    link = link.substr(0, link.rfind('@'));  // the rate behind the @ does not make it another device
  } else {
    if (link.starts_with("lcm:")) link = link.substr(0, link.find('?'));
    link += network();
  }
  return key_of("link " + link, robot.name);
}

std::vector<std::string> lock_keys(const StopMessages& robot) {
  std::vector<std::string> keys = {written_key(robot)};
  if (const auto device = device_at(robot.link); device && *device != robot.link) {
    const bool terminal = is_terminal(robot.link);
    keys.push_back(key_of(
        "device " + (terminal ? device->substr(0, device->find(' ')) : one_loopback(*device) + network()), robot.name));
  }
  if (std::string key = address_key(robot); !key.empty()) keys.push_back(std::move(key));
  return keys;
}

std::string address_key(const StopMessages& robot) {
  const std::string address = own_address(robot.identity);
  return address.empty() ? "" : key_of("robot " + address, "");
}

std::string left_key(const StopMessages& robot, pid_t guardian) {
  return key_of("left by " + std::to_string(guardian), robot.robot);
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

// --- all locks of a robot ---

hal::Result<bool> RobotLocks::change_to(const std::string& folder, const std::vector<std::string>& keys,
                                        std::optional<LockHolder>& holder) {
  std::erase_if(held_, [&](const auto& one) { return std::ranges::find(keys, one.first) == keys.end(); });
  bool all = true;
  for (const std::string& key : keys) {
    const auto taken = add(folder, key, holder);  // of several holders any will do: all are in the way
    if (!taken.ok()) return taken.error();
    all = all && taken.value();
  }
  return all;
}

hal::Result<bool> RobotLocks::add(const std::string& folder, const std::string& key,
                                  std::optional<LockHolder>& holder) {
  if (held_.contains(key)) return true;
  std::optional<LockHolder> seen;
  auto taken = RobotLock::take(folder, key, seen);
  if (!taken.ok()) return taken.error();
  const bool ours = taken.value().has_value();
  if (ours) held_.emplace(key, std::move(*taken.value()));
  if (seen && (!ours || !holder)) holder = seen;
  return ours;
}

void RobotLocks::free(const std::vector<std::string>& keys) {
  for (const std::string& key : keys) held_.erase(key);
}

bool RobotLocks::has_all(const std::vector<std::string>& keys) const {
  return std::ranges::all_of(keys, [this](const std::string& key) { return has(key); });
}

void RobotLocks::write(const LockHolder& holder) const {
  for (const auto& [key, lock] : held_) lock.write(holder);
}

// --- what dead ones left behind ---

namespace {

/// Calls `look(path, holder, last written)` for each lock file that nobody holds, while it is held for that.
template <class Look>
void for_all_free(const std::string& folder, const Look& look) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string path = entry.path().string();
    if (!path.ends_with(".lock")) continue;
    const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
    if (fd < 0) continue;
    struct stat info {};
    if (::flock(fd, LOCK_EX | LOCK_NB) == 0 && !removed(fd, path) && ::fstat(fd, &info) == 0)
      look(path, read_holder(fd), std::int64_t{info.st_mtim.tv_sec});
    ::close(fd);
  }
}

}  // namespace

std::vector<AbandonedRobot> find_abandoned(const std::string& folder) {
  std::vector<AbandonedRobot> all;
  for_all_free(folder, [&all](const std::string& path, const std::optional<LockHolder>& holder, std::int64_t written) {
    if (!holder || (holder->state != LockState::Driven && holder->state != LockState::Left)) {
      ::unlink(path.c_str());
      return;
    }
    const auto known = std::ranges::find(all, *holder, &AbandonedRobot::holder);  // it has several locks
    if (known == all.end()) {
      all.push_back({*holder, written});
    } else {
      known->seen_unix_s = std::max(known->seen_unix_s, written);
    }
  });
  std::ranges::sort(all, {}, [](const AbandonedRobot& robot) { return robot.holder.robot.robot; });
  return all;
}

void forget_abandoned(const std::string& folder, const LockHolder& dead) {
  if (::kill(dead.guardian, 0) != 0) ::unlink(takeover_socket(folder, dead.guardian).c_str());
  for_all_free(folder, [&dead](const std::string& path, const std::optional<LockHolder>& holder, std::int64_t) {
    if (holder && holder->guardian == dead.guardian && holder->robot.robot == dead.robot.robot) ::unlink(path.c_str());
  });
}

std::string takeover_socket(const std::string& folder, pid_t guardian) {
  return folder + "/guardian-" + std::to_string(guardian) + ".socket";
}

}  // namespace tandem::bridges::guardian
