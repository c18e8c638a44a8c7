#include "app/real/real_report.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "app/real/bridge_status.hpp"
#include "app/real/ledger_json.hpp"
#include "hal/unit.hpp"

namespace tandem::app {
namespace {

std::string ledger_text(const mixed_reality::RobotLedger& l) {
  std::string text = fmt::format(
      "readings {:.0f} ms old, {:.0f} ms at most (99 %); answers in {:.1f} ms, {:.1f} ms (99 %), jitter {:.1f} ms; {} "
      "late "
      "readings, {} late commands",
      to_ms(l.age_median_ns), to_ms(l.age_p99_ns), to_ms(l.round_trip_median_ns), to_ms(l.round_trip_p99_ns),
      to_ms(l.jitter_ns), l.late_readings, l.late_commands);
  if (l.clock)
    text += fmt::format("; its clock {:+.1f} ppm, {}, {} jumps", l.clock->drift_ppm,
                        l.clock->bound_ns ? fmt::format("within {:.1f} ms", to_ms(*l.clock->bound_ns)) : "one way",
                        l.clock->jumps);
  return text;
}

/// What trackers saw of a robot, and what was made of it.
void add_pose(hal::Json& robot, const mixed_reality::RealRobotReport& r) {
  robot["pose_source"] = r.pose_source;
  robot["poses_rejected"] = r.poses_rejected;
  if (r.sightings) robot["sightings"] = sightings_json(*r.sightings);
  if (r.learnt) {
    robot["learnt"] = {{"left_wheel", r.learnt->left},          {"right_wheel", r.learnt->right},
                       {"wheel_base", r.learnt->base},          {"gyroscope_bias_rad_s", r.learnt->bias_rad_s},
                       {"tracker_delays_s", r.learnt->delay_s}, {"standard_deviations", r.learnt->sd}};
    if (r.learnt->lag_s) {
      robot["learnt"]["lag_s"] = *r.learnt->lag_s;
      robot["learnt"]["lag_sd_s"] = r.learnt->lag_sd_s;
    }
  }
}

void add_trackers(hal::Json& json, const std::vector<mixed_reality::TrackerStatus>& trackers) {
  hal::Json& all = json["trackers"] = hal::Json::array();
  for (const mixed_reality::TrackerStatus& t : trackers) {
    hal::Json tracker{{"id", t.id},
                      {"kind", t.kind},
                      {"messages", t.heard.messages},
                      {"malformed", t.heard.malformed},
                      {"sightings", t.heard.sightings},
                      {"dropped", t.heard.dropped},
                      {"unknown", t.unknown},
                      {"from_future", t.from_future},
                      {"old", t.old},
                      {"outside", t.outside},
                      {"clock_jumps", t.clock_jumps},
                      {"by_former_date", t.by_former_date}};
    if (t.clock) tracker["clock"] = clock_json(*t.clock);
    if (t.shortest_way_s) tracker["shortest_way_ms"] = 1e3 * *t.shortest_way_s;
    if (!t.unknown_names.empty()) tracker["unknown_names"] = t.unknown_names;
    if (!t.heard.trouble.empty()) tracker["trouble"] = t.heard.trouble;
    for (const auto& [name, count] : t.heard.counts) tracker[name] = count;
    all.push_back(std::move(tracker));
  }
}

}  // namespace

hal::Json report_json(const mixed_reality::MixedReport& report) {
  hal::Json json;
  hal::Json& robots = json["real_robots"] = hal::Json::array();
  for (const mixed_reality::RealRobotReport& r : report.robots) {
    hal::Json robot;
    robot["id"] = r.id;
    robot["link"] = r.link;
    robot["x_m"] = r.pose.x_m;
    robot["y_m"] = r.pose.y_m;
    robot["heading_rad"] = r.pose.heading_rad();
    robot["state"] = r.state;
    robot["driving"] = r.driving;
    robot["stop_confirmed"] = r.stop_confirmed;
    robot["ticks_driving"] = r.counts.ticks_driving;
    robot["ticks_held"] = r.counts.ticks_held;
    robot["stops"] = r.counts.stops;
    robot["rearms"] = r.counts.rearms;
    robot["fenced_ticks"] = r.counts.fenced_ticks;
    robot["intrusions"] = r.counts.intrusions;
    robot["trespasses"] = r.counts.barrier.trespasses;
    robot["held_back_ticks"] = r.counts.barrier.changed_ticks;
    robot["held_back_most_m_s"] = r.counts.barrier.most_m_s;
    if (r.counts.barrier.delay_s > 0.0) robot["measured_delay_s"] = r.counts.barrier.delay_s;
    add_pose(robot, r);
    add_link_report(robot, r.conversation);
    robot["ledger"] = ledger_json(r.ledger);
    robot["incidents"] = r.incidents;
    robots.push_back(std::move(robot));
  }
  if (!report.replacements.empty()) {
    hal::Json& replacements = json["replacements"] = hal::Json::array();
    for (const mixed_reality::ReplacementReport& r : report.replacements)
      replacements.push_back(
          {{"robot", r.robot}, {"before", r.before}, {"after", r.after}, {"link", r.link}, {"tick", r.tick}});
  }
  if (!report.trackers.empty()) add_trackers(json, report.trackers);
  hal::Json& pace = json["pace"];
  pace["ticks"] = report.pace.ticks;
  pace["deadline_misses"] = report.pace.deadline_misses;
  pace["misses_by_machine"] = report.pace.misses_by_machine;
  for (std::size_t i = 0; i < std::min<std::size_t>(report.pace.deadline_misses, mixed_reality::PaceLedger::kKept);
       ++i) {
    const mixed_reality::MissedDeadline& m = report.pace.first_misses[i];
    pace["first_misses"].push_back({{"tick", m.tick},
                                    {"late_ms", to_ms(m.lateness_ns)},
                                    {"ran_ms", to_ms(m.ran_ns)},
                                    {"waited_ms", to_ms(m.waited_ns)},
                                    {"stalled_ms", to_ms(m.stalled_ns)},
                                    {"woke_late_ms", to_ms(m.woke_late_ns)},
                                    {"by_machine", m.by_machine}});
  }
  pace["skipped_slots"] = report.pace.skipped_slots;
  pace["largest_lateness_ms"] = to_ms(report.pace.largest_lateness_ns);
  pace["wake_up_p99_ms"] = to_ms(report.pace.wake_up.quantile_ns(0.99));
  pace["step_p99_ms"] = to_ms(report.pace.step.quantile_ns(0.99));
  json["system_clock"] = system_clock_json(report.clock);
  return json;
}

Rows rows_of(const mixed_reality::LockstepReport& report) {
  std::uint64_t asked_again = 0, odd_answers = 0;
  for (const mixed_reality::PartnerReport& p : report.peers) {
    asked_again += p.asked_again;
    odd_answers += p.doubled + p.wrong_tick + p.not_understood + p.garbled;
  }
  return {{"peers", fmt::format("{}, waited for {:.2f} s in all; {} times asked again, {} odd answers",
                                report.peers.size(), hal::to_seconds(report.waited_ns), asked_again, odd_answers)}};
}

Rows rows_of(const mixed_reality::MixedReport& report) {
  Rows rows;
  for (const mixed_reality::RealRobotReport& r : report.robots) {
    rows.emplace_back(
        "real robot",
        fmt::format("{} on {}: {}; {} ticks driving, {} held, {} of {} questions answered, {}", r.id, r.link, r.state,
                    r.counts.ticks_driving, r.counts.ticks_held, r.conversation.answers, r.conversation.questions,
                    r.stop_confirmed ? "stop confirmed" : "STOP NOT CONFIRMED"));
    const mixed_reality::BarrierCounts& barrier = r.counts.barrier;
    if (barrier.changed_ticks + barrier.trespasses + r.counts.intrusions > 0) {
      rows.emplace_back("safety of " + r.id,
                        fmt::format("held back in {} ticks, by {} m/s at most; {} times where it should not be",
                                    barrier.changed_ticks, hal::format_number(barrier.most_m_s),
                                    barrier.trespasses + r.counts.intrusions));
    }
    rows.emplace_back("ledger of " + r.id, ledger_text(r.ledger));
    if (r.sightings) {
      rows.emplace_back(
          "sightings of " + r.id,
          fmt::format("{} used, {} gated, {} late, {} doubled, {} impossible, {} disputed, {} jumps, {} slips",
                      r.sightings->used, r.sightings->gated, r.sightings->late, r.sightings->doubled,
                      r.sightings->impossible, r.sightings->disputed, r.sightings->jumps, r.sightings->slips));
    }
  }
  for (const mixed_reality::TrackerStatus& t : report.trackers) {
    rows.emplace_back("tracker", fmt::format("{}: {} messages, {} malformed, {} sightings, {} of nobody here, {} from "
                                             "the future, {} old, {} outside, {} jumps of its clock",
                                             t.id, t.heard.messages, t.heard.malformed, t.heard.sightings, t.unknown,
                                             t.from_future, t.old, t.outside, t.clock_jumps));
  }
  return rows;
}

}  // namespace tandem::app
