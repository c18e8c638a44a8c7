// First motion of a robot: that it turns as told, and is the one that trackers take it for.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "hal/angle.hpp"
#include "hal/unit.hpp"
#include "mixed_reality/desk/preflight.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr double kTurn_rad = std::numbers::pi / 6.0;
constexpr double kRight = 0.5;                         // share of the turn that must be seen
constexpr double kSeen_rad = 0.25 * kTurn_rad;         // of another robot: it is that one that turned
constexpr hal::TimeNs kRest_ns = 400 * hal::kNsPerMs;  // for the last sightings to come

std::string degrees(double angle_rad) {
  return hal::format_number(std::round(angle_rad * 1800.0 / std::numbers::pi) / 10.0) + " deg";
}

/// Heading by source, of one robot.
using Headings = std::map<std::string, double>;

std::map<std::string, Headings> headings_of(const MixedSession& session) {
  std::map<std::string, Headings> all;
  for (const RealRobotStatus& robot : session.status()) {
    for (const RealRobotStatus::Place& place : robot.places) {
      if (place.source != "hub") all[robot.id][place.source] = place.pose.heading_rad();
    }
    if (robot.wheels_turned_rad) all[robot.id]["its wheels"] = *robot.wheels_turned_rad;
  }
  return all;
}

/// Keeps all standing for a while.
void rest(MixedSession& session, const std::atomic<bool>& stop) {
  const hal::TimeNs began_ns = session.now().monotonic_ns;
  (void)session.stand_by([&] { return session.now().monotonic_ns - began_ns >= kRest_ns; }, stop);
}

}  // namespace

PreflightRows try_motion(MixedSession& session, const std::string& robot, const std::atomic<bool>& stop) {
  PreflightRows rows;
  const auto add = [&](Finding finding, std::string found, std::string advice = {}) {
    rows.push_back({"robot " + robot, "motion", finding, std::move(found), std::move(advice)});
  };
  const auto before = headings_of(session);
  const hal::Status there = session.turn(robot, kTurn_rad, stop);
  rest(session, stop);
  const auto after = headings_of(session);
  const hal::Status back = there.ok() ? session.turn(robot, -kTurn_rad, stop) : hal::Status{};
  rest(session, stop);
  for (const hal::Status* status : {&there, &back}) {
    if (status->ok()) continue;
    add(Finding::Fail, status->error().message, "mend that first, then try again");
    return rows;
  }
  const auto turned = [&](const std::string& id, const std::string& source) -> std::optional<double> {
    const auto was = before.find(id), is = after.find(id);
    if (was == before.end() || is == after.end() || !was->second.contains(source) || !is->second.contains(source))
      return {};
    return hal::turn_between(was->second.at(source), is->second.at(source));
  };
  std::string found, missed;
  const auto seen = after.find(robot);
  for (const auto& [source, heading] : seen == after.end() ? Headings() : seen->second) {
    const auto angle = turned(robot, source);
    if (!angle) continue;
    found += (found.empty() ? "turned " : ", ") + degrees(*angle) + " by " + source;
    if (*angle < kRight * kTurn_rad || *angle > 2.0 * kTurn_rad) missed += (missed.empty() ? "" : ", ") + source;
  }
  std::string others;
  PreflightRows of_others;
  for (const auto& [id, headings] : after) {
    if (id == robot) continue;
    std::string by;
    for (const auto& [source, heading] : headings) {
      const auto angle = turned(id, source);
      if (!angle || std::abs(*angle) <= kSeen_rad) continue;
      others += (others.empty() ? "" : ", ") + ("'" + id + "' by " + source);
      by += (by.empty() ? "" : ", ") + degrees(*angle) + " by " + source;
    }
    if (!by.empty())
      of_others.push_back({"robot " + id, "motion", Finding::Fail,
                           "turned " + by + ", while '" + robot + "' was told to",
                           "keep away from both until that is mended"});
  }
  if (found.empty()) {
    add(Finding::Warn, "nobody can see whether it turned", "look for yourself: it was told to turn left and back");
  } else if (!others.empty()) {
    add(Finding::Fail, found + "; meanwhile these turned: " + others,
        "links or tags are swapped: see <bridge link=…> and <tracker id=…>");
  } else if (!missed.empty()) {
    add(Finding::Fail, found + "; not as told by " + missed,
        "see that its wheels are free, its tag is its own, and turn=… of its <tracker> is right");
  } else {
    add(Finding::Ok, found);
  }
  rows.insert(rows.end(), of_others.begin(), of_others.end());
  return rows;
}

}  // namespace tandem::mixed_reality
