#include "mixed_reality/settings/tracker_check.hpp"

#include <map>

namespace tandem::mixed_reality {
namespace {

using bridges::TrackerType;

double body_height_m(const core::Scenario& scenario, const hal::Catalog& catalog, const core::RobotItem& robot) {
  const hal::RobotKind* const kind =
      robot.own_kind ? robot.own_kind.get() : core::find_kind(scenario, catalog, robot.kind);
  const auto* const body = kind != nullptr ? kind->part<hal::Body>() : nullptr;
  return body != nullptr ? body->height_m : 0.0;
}

}  // namespace

bridges::TrackerRequest tracker_request(const core::Scenario& scenario, const hal::Catalog& catalog,
                                        const core::TrackerItem& item) {
  bridges::TrackerRequest request{item.kind, item.id, scenario.file, item.own, {}};
  for (const core::RobotItem& robot : scenario.robots) {
    if (!robot.bridge) continue;
    const double height_m =
        robot.tracker && robot.tracker->tag_m ? *robot.tracker->tag_m : body_height_m(scenario, catalog, robot);
    for (const std::string& name : tracked_names(robot)) request.things.push_back({name, height_m});
  }
  return request;
}

std::vector<std::string> outlooks(const core::Scenario& scenario, const hal::Catalog& catalog) {
  std::vector<std::string> all;
  for (const core::TrackerItem& item : scenario.trackers) {
    const auto* const type = catalog.find<TrackerType>(item.kind);
    if (type == nullptr || type->outlook == nullptr) continue;
    const std::string text = type->outlook(tracker_request(scenario, catalog, item));
    if (!text.empty()) all.push_back("tracker '" + item.id + "': " + text);
  }
  return all;
}

bridges::MadeTracker make_tracker(const hal::Catalog& catalog, const bridges::TrackerRequest& request,
                                  const hal::Log& log) {
  const auto* const type = catalog.find<TrackerType>(request.kind);
  if (type == nullptr)
    return hal::Error{"there is no tracker '" + request.kind +
                      "'; there are: " + hal::listed(catalog.names(TrackerType::kCategory))};
  return type->make(request, log);
}

std::vector<std::string> tracked_names(const core::RobotItem& item) {
  if (item.tracker && !item.tracker->names.empty()) return item.tracker->names;
  return {item.id};
}

void check_trackers(const core::Scenario& scenario, const hal::Catalog& catalog, core::Problems& problems) {
  const auto complain = [&](int line, const std::string& what) { problems.push_back({scenario.file, line, what}); };
  for (std::size_t i = 0; i < scenario.trackers.size(); ++i) {
    const core::TrackerItem& item = scenario.trackers[i];
    if (i == kMostTrackers)
      complain(item.line, "more than " + std::to_string(kMostTrackers) + " trackers; leave some out");
    const auto* const type = catalog.find<TrackerType>(item.kind);
    if (type == nullptr || type->check == nullptr) continue;  // unknown elements were told; boards have no trackers
    if (const hal::Status good = type->check(tracker_request(scenario, catalog, item)); !good.ok())
      complain(item.line, "tracker '" + item.id + "': " + good.error().message);
  }
  std::map<std::string, const core::RobotItem*> named;
  for (const core::RobotItem& item : scenario.robots) {
    if (!item.bridge) continue;
    const int line = item.tracker ? item.tracker->line : item.line;
    if (item.tracker && item.tracker->p_BT[2] != 0.0)
      complain(line,
               "robot '" + item.id + "': the third number of its tracker's 'offset' is 0; its height is 'height'");
    if (item.tracker && item.tracker->source == "fused" && scenario.trackers.empty())
      complain(line, "robot '" + item.id + "': its pose is to be fused, and the file has no <trackers>");
    if (scenario.trackers.empty()) continue;
    for (const std::string& name : tracked_names(item)) {
      if (name.size() > bridges::Sighting::kLongestName)
        complain(line, "robot '" + item.id + "': '" + name +
                           "' is too long for trackers, which have names of at most " +
                           std::to_string(bridges::Sighting::kLongestName) + " characters");
      const auto [first, fresh] = named.emplace(name, &item);
      if (!fresh)
        complain(line, "robot '" + item.id + "': trackers know '" + first->second->id + "' on line " +
                           std::to_string(first->second->line) + " as '" + name + "', too");
    }
  }
}

}  // namespace tandem::mixed_reality
