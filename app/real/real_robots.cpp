#include "app/real/real_robots.hpp"

#include <fmt/format.h>
#include <string>
#include <utility>

#include "app/process/screen.hpp"
#include "app/process/terminal.hpp"
#include "app/real/ledger_json.hpp"
#include "core/record/record_streams.hpp"

namespace tandem::app {
namespace {

using hal::Json;

const char* name_of(bridges::LinkHealth health) noexcept {
  static constexpr const char* kNames[] = {"connecting", "active", "suspect", "lost"};
  return kNames[static_cast<std::size_t>(health)];
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
  if (robot.sightings) json["sightings"] = sightings_json(*robot.sightings);
  return json;
}

RealRobots::Line line_of(const mixed_reality::RealRobotStatus& real) {
  std::string text = fmt::format("{:<12} {:<8}", cut_to(printable(real.id), 12), real.driving ? "drives" : "stands");
  text += real.reading_age_s ? fmt::format("  age {:6.0f} ms", 1e3 * *real.reading_age_s) : "  no reading  ";
  text += fmt::format("  round trip {:5.1f} ms", 1e3 * real.round_trip_s);
  if (const auto late = real.ledger.late_readings + real.ledger.late_commands; late > 0)
    text += fmt::format("  late {}", late);
  if (real.battery) text += fmt::format("  battery {:3.0f} %", 100.0 * *real.battery);
  if (!real.driving) text += "  " + printable(real.state);
  if (!real.trouble.empty()) text += "; " + printable(real.trouble);
  return {text, real.driving};
}

}  // namespace

Json real_message(const std::vector<mixed_reality::RealRobotStatus>& robots, const std::vector<core::RollRow>& roll) {
  Json message = {{"type", "real"}, {"robots", Json::array()}};
  bool stopped = false;
  for (const mixed_reality::RealRobotStatus& robot : robots) {
    stopped = stopped || robot.emergency_stopped;
    message["robots"].push_back(status_json(robot));
  }
  message["estop"] = stopped;
  message["roll"] = Json::array();
  for (const core::RollGroup& group : core::grouped(roll)) {
    message["roll"].push_back({{"presence", name_of(group.presence)},
                               {"urgent", is_urgent(group.presence)},
                               {"why", group.why},
                               {"robots", group.ids},
                               {"text", text_of(group)}});
  }
  return message;
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

std::vector<RealRobots::Line> lines_of(const std::vector<mixed_reality::RealRobotStatus>& robots) {
  std::vector<RealRobots::Line> lines;
  for (const mixed_reality::RealRobotStatus& robot : robots) lines.push_back(line_of(robot));
  return lines;
}

}  // namespace tandem::app
