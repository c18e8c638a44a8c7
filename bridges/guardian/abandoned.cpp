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

/// What its new guardian calls it: those of two experiments may have one name.
std::string own_name(const std::string& name, std::set<std::string>& taken) {
  std::string own = name;
  for (int n = 2; !taken.insert(own).second; ++n) own = name + " (" + std::to_string(n) + ")";
  return own;
}

/// Robots on a link each.
void stop(const std::vector<StoppedRobot*>& robots, const std::string& folder, const std::vector<StopperType>& types,
          hal::TimeNs timeout_ns) {
  auto started = GuardianClient::start(types);
  if (!started.ok()) {
    for (StoppedRobot* robot : robots) robot->trouble = started.error().message;
    return;
  }
  GuardianClient& guardian = **started;
  std::vector<StopMessages> orders;
  std::set<std::string> names;
  for (const StoppedRobot* robot : robots) {
    StopMessages& order = orders.emplace_back(robot->abandoned.holder.robot);
    order.robot = own_name(order.robot, names);
  }
  const std::vector<hal::Status> claims = guardian.claim_each(orders);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (!claims[i].ok()) continue;
    guardian.watch(orders[i]);
    forget_abandoned(folder, robots[i]->abandoned.holder);
  }
  const std::vector<UnstoppedRobot> unstopped = guardian.end(timeout_ns);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    StoppedRobot* const robot = robots[i];
    const auto found = std::ranges::find(unstopped, orders[i].robot, &UnstoppedRobot::robot);
    if (!claims[i].ok()) {
      robot->trouble = claims[i].error().message;
    } else if (found != unstopped.end()) {
      robot->trouble = found->trouble + "; process " + std::to_string(guardian.process()) + " goes on trying";
    } else if (made_since(orders[i], robot->abandoned.seen_unix_s)) {
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
  while (!waiting.empty()) {  // dead hubs and guardians of one robot may have left a file each
    std::set<std::string> links;
    std::vector<StoppedRobot*> round, later;
    for (StoppedRobot* robot : waiting)
      (links.insert(written_key(robot->abandoned.holder.robot)).second ? round : later).push_back(robot);
    stop(round, folder.value(), types, timeout_ns);
    waiting = std::move(later);
  }
  return all;
}

}  // namespace tandem::bridges::guardian
