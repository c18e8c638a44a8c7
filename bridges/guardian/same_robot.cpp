#include "bridges/guardian/same_robot.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bridges/link/device.hpp"

namespace tandem::bridges::guardian {
namespace {

constexpr hal::TimeNs kLongestAbsence = 2 * hal::kNsPerSecond;

bool is_connection(const std::string& link) {
  return link.starts_with("tcp:") || link.starts_with("epuck-tcp:");
}

/// Path of a terminal, "/dev/ttyUSB0", from the text of its device, "/dev/ttyUSB0 188:0".
std::string path_of(const std::string& device) {
  return device.substr(0, device.find(' '));
}

/// One node in the file system, once made: another one has another number, or was made at another time.
std::string node_at(const std::string& device) {
  struct stat info {};
  if (::stat(path_of(device).c_str(), &info) != 0) return {};
  return std::to_string(info.st_dev) + " " + std::to_string(info.st_ino) + " " + std::to_string(info.st_ctim.tv_sec) +
         "." + std::to_string(info.st_ctim.tv_nsec);
}

/// Of what hangs on a terminal now; "": it has none.
std::string address_at(const std::string& device) {
  const int fd = ::open(path_of(device).c_str(), O_PATH | O_CLOEXEC);
  if (fd < 0) return {};
  RobotIdentity identity;
  identity.address = serial_number_of(fd);
  ::close(fd);
  return own_address(identity);
}

/// But for the device: a robot may be found over another one.
bool words_contradict(RobotIdentity a, RobotIdentity b) {
  a.device = b.device = std::nullopt;
  return !contradiction(a, b).empty();
}

}  // namespace

bool is_terminal(const std::string& link) {
  return link.starts_with("serial:") || link.starts_with("slcan:");
}

std::string own_address(const RobotIdentity& identity) {
  const std::string address = identity.address.value_or("");
  return address.starts_with("Bluetooth ") || address.starts_with("USB ") ? address : "";
}

void RobotTrace::begin(const StopMessages& robot) {
  const RobotIdentity& now = robot.identity;
  const RobotIdentity& before = robot_.identity;
  if (robot.link == robot_.link && before.device) {
    if (!now.device) return;  // what is known of it stays
    if (now.session == before.session && now.device == before.device) {
      robot_ = robot;
      return;
    }
  }
  robot_ = robot;
  node_ = is_terminal(robot.link) && now.device ? node_at(*now.device) : "";
  broken_ = renamed_ = false;
  silent_since_ns_ = 0;
}

void RobotTrace::look() {
  if (!is_terminal(robot_.link) || !robot_.identity.device) return;
  leads_to_ = device_at(robot_.link);
  const auto& device = leads_to_;
  if (!device) {
    broken_ = true;  // it is not there now
  } else if (*device != *robot_.identity.device) {
    renamed_ = true;
  } else {
    renamed_ = false;
    broken_ = broken_ || node_at(*device) != node_;
  }
}

void RobotTrace::tried(bool reached, hal::TimeNs now) noexcept {
  if (reached) {
    silent_since_ns_ = 0;
    return;
  }
  if (silent_since_ns_ == 0) silent_since_ns_ = now;
  if (is_connection(robot_.link) && now - silent_since_ns_ > kLongestAbsence) broken_ = true;
}

bool RobotTrace::proved() const {
  if (!broken_ || renamed_) return true;
  const std::string address = own_address(robot_.identity);
  return !address.empty() && is_terminal(robot_.link) && address == address_at(robot_.identity.device.value_or(""));
}

SameRobot RobotTrace::same_as(const StopMessages& answers) const {
  const auto judged = [](bool same) { return same ? SameRobot::Yes : SameRobot::No; };
  if (!answers.identity.device) return SameRobot::Unknown;
  if (words_contradict(robot_.identity, answers.identity) || answers.kind != robot_.kind) return SameRobot::No;
  const std::string address = own_address(robot_.identity);
  if (!address.empty()) return judged(address == own_address(answers.identity));
  if (answers.identity.device == robot_.identity.device) return judged(answers.name == robot_.name && !broken_);
  return judged(answers.link == robot_.link);
}

}  // namespace tandem::bridges::guardian
