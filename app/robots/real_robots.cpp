#include "app/robots/real_robots.hpp"

#include <string>
#include <utility>

#include "app/robots/ledger_json.hpp"
#include "core/record/record_streams.hpp"

namespace tandem::app {
namespace {

using hal::Json;

const char* name_of(bridges::LinkHealth health) noexcept {
  switch (health) {
    case bridges::LinkHealth::Connecting:
      return "connecting";
    case bridges::LinkHealth::Active:
      return "active";
    case bridges::LinkHealth::Suspect:
      return "suspect";
    case bridges::LinkHealth::Lost:
      return "lost";
  }
  return "";
}

/// Null: not known.
Json optional(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json status_json(const mixed_reality::RealRobotStatus& robot) {
  Json json = {{"id", robot.id},
               {"device", robot.device},
               {"link", robot.link},
               {"identity", robot.identity},
               {"coming", robot.coming},
               {"state", robot.state},
               {"driving", robot.driving},
               {"health", name_of(robot.health)},
               {"trouble", robot.trouble},
               {"age_s", optional(robot.reading_age_s)},
               {"round_trip_s", robot.round_trip_s},
               {"battery", optional(robot.battery)},
               {"supply_V", optional(robot.supply_V)},
               {"armed", !robot.awaits_arming},
               {"awaits_rearm", robot.awaits_rearm},
               {"held_back_m_s", robot.held_back_m_s},
               {"held_back_ticks", robot.held_back_ticks},
               {"ledger", ledger_json(robot.ledger)},
               {"sources", Json::array()}};
  for (const auto& place : robot.places) {
    Json source = {{"name", place.source},
                   {"x", place.pose.x_m},
                   {"y", place.pose.y_m},
                   {"heading", place.pose.heading_rad()},
                   {"age_s", place.age_s}};
    if (place.sd_m) source["sd_m"] = *place.sd_m;
    if (place.sd_rad) source["sd_heading"] = *place.sd_rad;
    json["sources"].push_back(std::move(source));
  }
  if (robot.sightings) {
    const mixed_reality::PoseCounts& c = *robot.sightings;
    json["sightings"] = {{"used", c.used},
                         {"gated", c.gated},
                         {"late", c.late},
                         {"doubled", c.doubled},
                         {"impossible", c.impossible},
                         {"disputed", c.disputed},
                         {"jumps", c.jumps},
                         {"slips", c.slips}};
  }
  return json;
}

void add_areas(std::vector<core::Drawing::Area>& list, core::Drawing::Area::Kind kind,
               const std::vector<core::SafetyArea>& areas) {
  for (const core::SafetyArea& area : areas) {
    core::Drawing::Area drawn{kind, area.id, {}, area.from_m, area.to_m, area.max_speed_m_s};
    for (const core::Point2& p : area.corners) drawn.corners.push_back({p[0], p[1]});
    list.push_back(std::move(drawn));
  }
}

}  // namespace

Json real_message(const mixed_reality::MixedSession& session) {
  Json message = {{"type", "real"}, {"robots", Json::array()}};
  bool stopped = false;
  for (const mixed_reality::RealRobotStatus& robot : session.status()) {
    stopped = stopped || robot.emergency_stopped;
    message["robots"].push_back(status_json(robot));
  }
  message["estop"] = stopped;
  message["roll"] = Json::array();
  for (const mixed_reality::RollGroup& group : grouped(session.roll_call())) {
    message["roll"].push_back({{"presence", name_of(group.presence)},
                               {"urgent", is_urgent(group.presence)},
                               {"why", group.why},
                               {"robots", group.ids},
                               {"text", text_of(group)}});
  }
  return message;
}

std::vector<core::Drawing::Area> areas_of(const core::SafetyConfig& safety) {
  using Kind = core::Drawing::Area::Kind;
  std::vector<core::Drawing::Area> areas;
  add_areas(areas, Kind::Fence, safety.fences);
  add_areas(areas, Kind::KeepOut, safety.keep_outs);
  add_areas(areas, Kind::Zone, safety.zones);
  return areas;
}

hal::Status record_ledgers(core::Recorder& recorder, const mixed_reality::MixedSession& session) {
  core::RecordTable table;
  table.type = &hal::row_type<mixed_reality::LedgerRow>();
  table.set = "time";
  table.robots = session.ledger_robots();
  table.first = session.ledger_rows().data();
  return recorder.add(table);
}

std::optional<Json> skipped_event(const mixed_reality::ClockRow& now, std::uint32_t& told) {
  const std::uint32_t slots = now.skipped_slots - std::exchange(told, now.skipped_slots);
  if (slots == 0) return std::nullopt;
  return Json{{"kind", "skipped"}, {"slots", slots}, {"monotonic_ns", now.monotonic_ns}, {"unix_ns", now.unix_ns}};
}

}  // namespace tandem::app
