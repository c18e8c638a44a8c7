#include "bridges/guardian/abandoned.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <set>
#include <sys/stat.h>

#include "bridges/guardian/client.hpp"

namespace tandem::bridges::guardian {
namespace {

/// Whether the robot's device was made after it was heard of last, as when it is plugged in.
bool made_since(const StopMessages& robot, std::int64_t unix_s) {
  const std::string device = robot.identity.device.value_or("");
  struct stat info {};
  return device.starts_with('/') && ::stat(device.substr(0, device.find(' ')).c_str(), &info) == 0 &&
         std::int64_t{info.st_ctim.tv_sec} > unix_s;
}

/// Robots of one name each.
void stop(std::vector<StoppedRobot*> robots, const std::string& folder, const std::vector<StopperType>& types,
          hal::TimeNs timeout_ns) {
  auto started = GuardianClient::start(types);
  if (!started.ok()) {
    for (StoppedRobot* robot : robots) robot->trouble = started.error().message;
    return;
  }
  GuardianClient& guardian = **started;
  std::erase_if(robots, [&](StoppedRobot* robot) {
    const LockHolder& holder = robot->abandoned.holder;
    if (const hal::Status claimed = guardian.claim({&holder.robot, 1}); !claimed.ok()) {
      robot->trouble = claimed.error().message;
      return true;
    }
    guardian.watch(holder.robot);
    forget_abandoned(folder, holder);
    return false;
  });
  const std::vector<UnstoppedRobot> unstopped = guardian.end(timeout_ns);
  for (StoppedRobot* robot : robots) {
    const StopMessages& messages = robot->abandoned.holder.robot;
    const auto found = std::ranges::find(unstopped, messages.robot, &UnstoppedRobot::robot);
    if (found != unstopped.end()) {
      robot->trouble = found->trouble + "; process " + std::to_string(guardian.process()) + " goes on trying";
    } else if (made_since(messages, robot->abandoned.seen_unix_s)) {
      robot->trouble = "who is there now rests, but the device was made anew since then: it may be another robot";
    } else {
      robot->confirmed = true;
    }
  }
}

}  // namespace

std::string StoppedRobot::to_text() const {
  const LockHolder& holder = abandoned.holder;
  const auto seen = static_cast<std::time_t>(abandoned.seen_unix_s);
  std::tm local{};
  ::localtime_r(&seen, &local);
  std::array<char, 32> when{};
  std::strftime(when.data(), when.size(), "%Y-%m-%d %H:%M:%S", &local);
  return "robot '" + holder.robot.robot + "' on " + holder.robot.link +
         " may have driven on with its last command since " + when.data() + ": its hub (process " +
         std::to_string(holder.hub) + ") and its guardian (process " + std::to_string(holder.guardian) +
         ") are both gone, and it had confirmed no stop. " +
         (confirmed ? "It was stopped now, and has confirmed that"
                    : "It was told to stop now, and has NOT confirmed that: " + trouble);
}

std::vector<StoppedRobot> stop_abandoned(const std::vector<StopperType>& types, hal::TimeNs timeout_ns) {
  std::vector<StoppedRobot> all;
  const auto folder = lock_folder();
  if (!folder.ok()) return all;
  for (AbandonedRobot& robot : find_abandoned(folder.value())) all.push_back({std::move(robot), false, ""});
  std::vector<StoppedRobot*> waiting;
  for (StoppedRobot& robot : all) waiting.push_back(&robot);
  while (!waiting.empty()) {  // those of two experiments may have one name
    std::set<std::string> names;
    std::vector<StoppedRobot*> round, later;
    for (StoppedRobot* robot : waiting)
      (names.insert(robot->abandoned.holder.robot.robot).second ? round : later).push_back(robot);
    stop(std::move(round), folder.value(), types, timeout_ns);
    waiting = std::move(later);
  }
  return all;
}

}  // namespace tandem::bridges::guardian
