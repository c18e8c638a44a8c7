#include "app/guarded_robots.hpp"

#include <algorithm>

#include "bridges/eyebot/stop_body.hpp"
#include "bridges/footbot/stop_body.hpp"
#include "bridges/link/link_text.hpp"
#include "hal/spec/epuck.hpp"
#include "hal/spec/eyebot.hpp"
#include "hal/spec/footbot.hpp"

namespace tandem::app {
namespace {

bool is_epuck(std::string_view kind) {
  return kind == hal::epuck::kDataSheet.kind;
}
bool is_footbot(std::string_view kind) {
  return kind == hal::footbot::kDataSheet.kind;
}
bool is_eyebot(std::string_view kind) {
  return kind == hal::eyebot::kDataSheet.kind;
}

template <class Guardian>
void start(std::optional<Guardian>& guardian, const hal::Log& log) {
  auto started = Guardian::start();
  if (started.ok()) {
    guardian.emplace(std::move(started).value());
  } else {
    log.warning(started.error().message);
  }
}

std::optional<bridges::eyebot::LastWords> eyebot_words(const bridges::StopMessages& messages) {
  auto words = bridges::eyebot::from_stop_body(messages.body);
  const auto address = bridges::parse_link(messages.link);
  if (words && address.ok()) words->url = address.value().target;
  return words;
}

}  // namespace

GuardedRobots::GuardedRobots(const std::vector<core::RobotItem>& items, const hal::Log& log) {
  const auto any = [&items](bool (*is)(std::string_view)) {
    return std::ranges::any_of(items, [&](const core::RobotItem& i) { return i.bridge && is(i.kind); });
  };
  if (any(&is_epuck)) start(epucks_, log);
  if (any(&is_footbot)) start(footbots_, log);
  if (any(&is_eyebot)) start(eyebots_, log);
}

void GuardedRobots::update() {
  for (Row& row : robots_) {
    if (row.watched && row.bridge->stop_version() == row.told.version) continue;
    row.told = row.bridge->stop_messages();
    row.watched = true;
    watch(row.told);
  }
}

std::vector<std::string> GuardedRobots::release_rested() {
  std::vector<std::string> left;
  for (Row& row : robots_) {
    if (!row.watched) continue;
    if (!row.bridge->at_rest()) {
      left.push_back(row.told.robot);
      continue;
    }
    release(row.told);
    row.watched = false;
  }
  return left;
}

void GuardedRobots::watch(const bridges::StopMessages& messages) {
  if (is_epuck(messages.kind) && epucks_) {
    const auto address = bridges::parse_link(messages.link);
    if (address.ok()) epucks_->watch(address.value().target, address.value().rate);
  } else if (is_footbot(messages.kind) && footbots_) {
    if (const auto words = bridges::footbot::from_stop_body(messages.body)) footbots_->watch(messages.link, *words);
  } else if (is_eyebot(messages.kind) && eyebots_) {
    if (const auto words = eyebot_words(messages)) eyebots_->watch(*words);
  }
}

void GuardedRobots::release(const bridges::StopMessages& messages) {
  if (is_epuck(messages.kind) && epucks_) {
    const auto address = bridges::parse_link(messages.link);
    if (address.ok()) epucks_->release(address.value().target);
  } else if (is_footbot(messages.kind) && footbots_) {
    footbots_->release(messages.link);
  } else if (is_eyebot(messages.kind) && eyebots_) {
    if (const auto words = eyebot_words(messages)) eyebots_->release(*words);
  }
}

}  // namespace tandem::app
