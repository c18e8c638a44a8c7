#include "app/real/guarded_robots.hpp"

#include "app/process/signals.hpp"
#include "bridges/guardian/stopper.hpp"

namespace tandem::app {
namespace {

using bridges::guardian::GuardianClient;

constexpr hal::TimeNs kConfirmWithin = 500 * hal::kNsPerMs;  // to the guardian, after the bridges have ended
constexpr hal::TimeNs kStopWithin = 3 * hal::kNsPerSecond;   // robots that dead programs have left

std::vector<bridges::guardian::StopperType> stoppers_of(const hal::Catalog& catalog) {
  std::vector<bridges::guardian::StopperType> stoppers;
  for (const auto* type : catalog.all<bridges::guardian::StopperType>()) stoppers.push_back(*type);
  return stoppers;
}

}  // namespace

std::vector<bridges::guardian::StoppedRobot> stop_abandoned_robots(const hal::Catalog& catalog, const hal::Log& log) {
  auto robots = bridges::guardian::stop_abandoned(stoppers_of(catalog), kStopWithin);
  for (const auto& robot : robots) log.warning(robot.to_text());
  return robots;
}

GuardedRobots::GuardedRobots(bool real_robots, const hal::Catalog& catalog, hal::Log log) : log_(std::move(log)) {
  if (!real_robots) return;
  abandoned_ = stop_abandoned_robots(catalog, log_);
  bridges::guardian::GuardianOptions options;
  options.suspend_asked = &suspend_asked();
  auto started = GuardianClient::start(stoppers_of(catalog), options);
  if (!started.ok()) {
    started_ = started.error();
    return;
  }
  guardian_ = std::move(started).value();
  catch_suspend();
}

bridges::SendPermit GuardedRobots::permit() const noexcept {
  return guardian_ ? guardian_->permit() : bridges::SendPermit();
}

std::uint64_t GuardedRobots::freezes() const noexcept {
  return guardian_ ? guardian_->freezes().count : 0;
}

hal::Status GuardedRobots::claim() {
  if (!guardian_) return {};
  return guardian_->claim(robots());
}

std::vector<bridges::StopMessages> GuardedRobots::robots() const {
  std::vector<bridges::StopMessages> all;
  for (const Row& row : robots_) all.push_back(row.bridge->stop_messages());
  return all;
}

hal::Status GuardedRobots::claim(const bridges::RobotBridge& bridge) {
  if (!guardian_) return {};
  const bridges::StopMessages one = bridge.stop_messages();
  return guardian_->claim({&one, 1});
}

void GuardedRobots::remove(const bridges::RobotBridge& bridge) {
  if (guardian_) guardian_->release(bridge.stop_messages().robot);
  std::erase_if(robots_, [&bridge](const Row& row) { return row.bridge == &bridge; });
}

void GuardedRobots::update() {
  if (!guardian_) return;
  for (const std::string& news : guardian_->take_news()) log_.warning(news);
  for (Row& row : robots_) {
    if (row.watched && row.bridge->stop_version() == row.told.version) continue;
    row.told = row.bridge->stop_messages();
    row.watched = true;
    guardian_->watch(row.told);
  }
}

std::vector<std::string> GuardedRobots::release_rested() {
  std::vector<std::string> left;
  for (Row& row : robots_) {
    if (!row.watched) continue;
    row.watched = false;
    if (!row.bridge->at_rest()) {
      left.push_back(row.told.robot);
    } else if (guardian_) {
      guardian_->release(row.told.robot);
    }
  }
  if (left.empty() || !guardian_) return left;
  left.clear();
  for (const bridges::guardian::UnstoppedRobot& robot : guardian_->end(kConfirmWithin)) left.push_back(robot.robot);
  return left;
}

}  // namespace tandem::app
