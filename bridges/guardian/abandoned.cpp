#include "bridges/guardian/abandoned.hpp"

#include <algorithm>
#include <array>
#include <ctime>
#include <memory>
#include <sys/stat.h>

#include "bridges/guardian/client.hpp"
#include "hal/monotonic.hpp"

namespace tandem::bridges::guardian {
namespace {

/// Whether the robot's device was made after it was heard of last, as when it is plugged in.
bool made_since(const StopMessages& robot, std::int64_t unix_s) {
  const std::string device = robot.identity.device.value_or("");
  struct stat info {};
  return device.starts_with('/') && ::stat(device.substr(0, device.find(' ')).c_str(), &info) == 0 &&
         std::int64_t{info.st_ctim.tv_sec} > unix_s;
}

/// Robots of one name each, and who stops them.
struct Round {
  std::vector<StoppedRobot*> robots;
  std::unique_ptr<GuardianClient> guardian = {};
};

/// Has a guardian of its own begin to stop them.
void begin(Round& round, const std::string& folder, const std::vector<StopperType>& types) {
  auto started = GuardianClient::start(types);
  if (!started.ok()) {
    for (StoppedRobot* robot : round.robots) robot->trouble = started.error().message;
    return;
  }
  round.guardian = std::move(started).value();
  std::erase_if(round.robots, [&](StoppedRobot* robot) {
    const LockHolder& holder = robot->abandoned.holder;
    if (const hal::Status claimed = round.guardian->claim({&holder.robot, 1}); !claimed.ok()) {
      robot->trouble = claimed.error().message;
      return true;
    }
    round.guardian->watch(holder.robot);
    forget_abandoned(folder, holder);
    return false;
  });
  round.guardian->begin_end();
}

void finish(Round& round, hal::TimeNs until_ns) {
  if (round.guardian == nullptr) return;
  const auto unstopped = round.guardian->end(std::max<hal::TimeNs>(0, until_ns - hal::monotonic_ns()));
  for (StoppedRobot* robot : round.robots) {
    const StopMessages& messages = robot->abandoned.holder.robot;
    const auto found = std::ranges::find(unstopped, messages.robot, &UnstoppedRobot::robot);
    if (found != unstopped.end()) {
      robot->trouble = found->trouble + "; process " + std::to_string(round.guardian->process()) + " goes on trying";
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
  std::vector<Round> rounds;  // those of two experiments may have one name
  for (StoppedRobot& robot : all) {
    const auto lacks_name = [&](const Round& round) {
      return std::ranges::none_of(round.robots, [&](const StoppedRobot* other) {
        return other->abandoned.holder.robot.robot == robot.abandoned.holder.robot.robot;
      });
    };
    const auto found = std::ranges::find_if(rounds, lacks_name);
    (found != rounds.end() ? *found : rounds.emplace_back()).robots.push_back(&robot);
  }
  for (Round& round : rounds) begin(round, folder.value(), types);
  const hal::TimeNs until_ns = hal::monotonic_ns() + timeout_ns;  // all at once: who does not answer delays nobody else
  for (Round& round : rounds) finish(round, until_ns);
  return all;
}

}  // namespace tandem::bridges::guardian
