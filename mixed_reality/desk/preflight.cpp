#include "mixed_reality/desk/preflight.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "hal/angle.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/rounded.hpp"
#include "hal/unit.hpp"
#include "mixed_reality/desk/machine.hpp"
#include "mixed_reality/fence/intrusion.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr double kAtStart_m = 0.05, kAtStart_rad = 10.0 * std::numbers::pi / 180.0;  // set up by hand
constexpr double kNear_m = 0.02;                                                     // between two bodies
constexpr double kSeenWithin_s = 0.5;
constexpr double kLowSoon_V = 0.1, kLowSoon = 0.1;  // above the limit at which a robot is stopped
constexpr double kBusy = 0.7;                       // load of a processor
constexpr double kLateShare = 0.25;                 // of a tick

std::string ms(double span_s) {
  return hal::format_number(std::round(span_s * 1e4) / 10.0) + " ms";
}
std::string cm(double length_m) {
  return hal::format_number(std::round(length_m * 1e3) / 10.0) + " cm";
}
std::string degrees(double angle_rad) {
  return hal::format_number(std::round(angle_rad * 1800.0 / std::numbers::pi) / 10.0) + " deg";
}
std::string place(const core::Pose& pose) {
  return hal::place_text(pose.x_m, pose.y_m) + " m, " + degrees(pose.heading_rad());
}
using Place = RealRobotStatus::Place;

/// Of one robot.
class Looker {
 public:
  Looker(const MixedSession& session, const core::RobotItem& item, const RealRobotStatus& status, PreflightRows& rows)
      : session_(session), item_(item), status_(status), rows_(rows) {}

  void look() {
    link();
    if (status_.health == LinkHealth::Connecting) return;  // of the rest nothing is known
    firmware();
    round_trip();
    clock();
    readings();
    battery();
    pose();
    sightings();
    arena();
  }

 private:
  void add(const char* check, Finding finding, std::string found, std::string advice = {}) {
    rows_.push_back({"robot " + status_.id, check, finding, std::move(found),
                     finding == Finding::Ok ? std::string() : std::move(advice)});
  }

  void link() {
    if (status_.health == LinkHealth::Active) return add("link", Finding::Ok, status_.link);
    const bool needed = item_.bridge->if_missing == core::IfMissing::Refuse;
    std::string found = status_.link + ": " + (status_.trouble.empty() ? "no answer" : status_.trouble);
    std::string advice = status_.advice;
    if (item_.bridge->if_missing == core::IfMissing::Simulate) advice += "; without it the run simulates it";
    if (item_.bridge->if_missing == core::IfMissing::Wait) advice += "; the run waits for it";
    add("link", needed ? Finding::Fail : Finding::Warn, std::move(found), std::move(advice));
  }
  void firmware() {
    if (!status_.identity.empty()) return add("firmware", Finding::Ok, status_.identity);
    add("firmware", Finding::Warn, "it does not say who it is", "make sure by hand that it is the right robot");
  }
  void round_trip() {
    const double tick_s = 1.0 / static_cast<double>(session_.world().ticks_per_second());
    const RobotLedger& ledger = status_.ledger;
    const double trip_s = ledger.answers > 0 ? hal::to_seconds(ledger.round_trip_median_ns) : status_.round_trip_s;
    const Finding finding = trip_s < 0.5 * tick_s              ? Finding::Ok
                            : trip_s < item_.bridge->timeout_s ? Finding::Warn
                                                               : Finding::Fail;
    std::string found = ms(trip_s);
    if (ledger.answers > 0) found += ", 99 of 100 within " + ms(hal::to_seconds(ledger.round_trip_p99_ns));
    add("round trip", finding, found + "; a tick is " + ms(tick_s),
        "bring it nearer, take other robots off its line, or run fewer ticks per second");
  }
  void clock() {
    const auto& clock = status_.ledger.clock;
    if (!clock || clock->messages == 0) return;
    const bool steady = clock->jumps == 0;
    std::string found =
        "apart by " + hal::format_number(std::round(hal::to_seconds(clock->offset_ns) * 1e3) / 1e3) + " s";
    if (clock->bound_ns) found += ", known within " + ms(hal::to_seconds(*clock->bound_ns));
    add("clock", steady ? Finding::Ok : Finding::Warn, found + (steady ? "" : "; it was set meanwhile"),
        "see what sets its clock");
  }
  void readings() {
    if (!status_.reading_age_s)
      return add("readings", Finding::Fail, "none came", "see that its firmware sends what the controller reads");
    const bool fresh = *status_.reading_age_s <= item_.bridge->timeout_s;
    add("readings", fresh ? Finding::Ok : Finding::Fail, "the newest is " + ms(*status_.reading_age_s) + " old",
        "see that the link holds");
  }
  void battery() {
    if (!status_.battery)
      return add("battery", Finding::Ok, "not known: it tells nothing of it, or its controller does not ask for it");
    const auto* const part = session_.world().space().kind(status_.robot).part<hal::BatteryPart>();
    const double low_V = part != nullptr ? part->low_V : 0.0, low = part != nullptr ? part->low_charge : 0.0;
    const bool volts = low_V > 0.0 && status_.supply_V.has_value();
    const double left = volts ? *status_.supply_V - low_V : *status_.battery - low;
    const double soon = volts ? kLowSoon_V : kLowSoon;
    std::string found = volts ? hal::format_number(std::round(*status_.supply_V * 100.0) / 100.0) + " V"
                              : hal::format_number(std::round(*status_.battery * 100.0)) + " %";
    add("battery",
        left <= 0.0   ? Finding::Fail
        : left < soon ? Finding::Warn
                      : Finding::Ok,
        std::move(found),
        "charge it: at " + (volts ? hal::format_number(low_V) + " V" : hal::format_number(low * 100.0) + " %") +
            " it is stopped");
  }

  /// Of its own pose source; null: it knows nothing.
  const Place* own() const {
    return !status_.places.empty() && status_.places.front().source != "hub" ? &status_.places.front() : nullptr;
  }
  core::Pose start() const {
    return core::Pose::at(item_.placement.p_W[0], item_.placement.p_W[1], item_.placement.yaw_rad);
  }
  void pose() {
    const Place* const known = own();
    if (known == nullptr) {
      const bool seen = status_.sightings.has_value();
      return add("place", Finding::Fail, "nobody knows where it is",
                 seen ? "see that its tag is on, in view, and in <tracker id=…>" : "see that it measures its place");
    }
    if (known->source == "odometry")
      return add("place", Finding::Ok, "by its wheels alone, from where it stands now: put it at " + place(start()));
    compare("place", *known);
  }
  void compare(const char* what, const Place& seen) {
    const double apart_m = std::hypot(seen.pose.x_m - start().x_m, seen.pose.y_m - start().y_m);
    const double turned_rad = std::abs(hal::turn_between(start().heading_rad(), seen.pose.heading_rad()));
    const bool there = apart_m <= kAtStart_m && turned_rad <= kAtStart_rad;
    add(what, there ? Finding::Ok : Finding::Warn,
        place(seen.pose) + " by " + seen.source +
            (there ? "" : ", " + cm(apart_m) + " and " + degrees(turned_rad) + " off the file's"),
        "put it at " + place(start()) + ", or let it begin where it is");
  }
  void sightings() {
    if (!status_.sightings) return;
    for (const TrackerStatus& tracker : session_.trackers()) {
      const auto seen = std::ranges::find(status_.places, tracker.id, &Place::source);
      const bool fresh = seen != status_.places.end() && seen->age_s <= kSeenWithin_s;
      const std::string check = "seen by " + tracker.id;
      if (fresh) {
        add(check.c_str(), Finding::Ok, place(seen->pose) + ", " + ms(seen->age_s) + " ago");
      } else {
        add(check.c_str(), Finding::Warn,
            seen == status_.places.end() ? "never" : "last " + ms(seen->age_s) + " ago at " + place(seen->pose),
            "see that its tag is on and in view");
      }
    }
    const PoseCounts& c = *status_.sightings;
    if (c.disputed > 0)
      add("trackers", Finding::Fail, "they say different places", "calibrate them: their frames do not agree");
  }
  void arena() {
    const Place* const known = own();
    if (known == nullptr) return;
    const core::Space& space = session_.world().space();
    const double r_m = space.kind(status_.robot).body.radius_m;
    const bool inside = std::abs(known->pose.x_m - space.arena_center_x_m()) <= 0.5 * space.arena_size_x_m() - r_m &&
                        std::abs(known->pose.y_m - space.arena_center_y_m()) <= 0.5 * space.arena_size_y_m() - r_m;
    if (!inside)
      return add("arena", Finding::Fail, "it stands outside, at " + place(known->pose), "bring it into the arena");
    const Intrusion in = intrusion_of(space, status_.robot, known->pose);
    if (!in.deep()) return add("arena", Finding::Ok, "it stands inside, in nothing virtual");
    add("arena", Finding::Warn, "it stands in the virtual '" + name_of(space, in) + "'", "move it out, or the thing");
  }

  const MixedSession& session_;
  const core::RobotItem& item_;
  const RealRobotStatus& status_;
  PreflightRows& rows_;
};

/// The real ones among themselves, by what is known of their places.
void look_apart(const MixedSession& session, const std::vector<RealRobotStatus>& all, PreflightRows& rows) {
  const core::Space& space = session.world().space();
  Finding worst = Finding::Ok;
  for (std::size_t a = 0; a < all.size(); ++a) {
    for (std::size_t b = a + 1; b < all.size(); ++b) {
      const core::Pose &one = all[a].places.back().pose, &other = all[b].places.back().pose;
      const double gap_m = std::hypot(one.x_m - other.x_m, one.y_m - other.y_m) -
                           space.kind(all[a].robot).body.radius_m - space.kind(all[b].robot).body.radius_m;
      if (gap_m >= kNear_m) continue;
      const Finding finding = gap_m < 0.0 ? Finding::Fail : Finding::Warn;
      worst = std::max(worst, finding);
      rows.push_back({"robot " + all[a].id, "apart", finding,
                      gap_m < 0.0 ? "it would stand in '" + all[b].id + "', by " + cm(-gap_m)
                                  : "only " + cm(gap_m) + " from '" + all[b].id + "'",
                      "set them up farther apart, or see whether their tags are swapped"});
    }
  }
  if (worst == Finding::Ok && all.size() > 1)
    rows.push_back({"arena", "apart", Finding::Ok, "all real robots stand clear of one another", ""});
}

void look_at_tracker(const TrackerStatus& t, PreflightRows& rows) {
  const auto add = [&](const char* check, Finding finding, std::string found, std::string advice = {}) {
    rows.push_back({"tracker " + t.id, check, finding, std::move(found), std::move(advice)});
  };
  if (t.heard.messages == 0)
    return add("heard", Finding::Fail, t.heard.trouble.empty() ? "nothing came" : t.heard.trouble,
               "see that it runs, and sends to where the file listens");
  add("heard", Finding::Ok,
      std::to_string(t.heard.messages) + " messages, " + std::to_string(t.heard.sightings) + " sightings");
  if (t.heard.malformed > 0)
    add("form", Finding::Warn, std::to_string(t.heard.malformed) + " messages cannot be read",
        "see that it speaks the form that the file says");
  if (!t.heard.trouble.empty()) add("trouble", Finding::Warn, t.heard.trouble, "see its own messages");
  if (t.unknown > 0) {
    std::string names;
    for (const std::string& name : t.unknown_names) names += (names.empty() ? "'" : ", '") + name + "'";
    add("names", Finding::Warn, "it sees what is no robot of the file: " + names,
        "put the names into <tracker id=…> of their robots, or take the things away");
  }
  const bool bad_clock = t.from_future > 0 || t.old > 0 || t.clock_jumps > 0;
  add("clock", bad_clock ? Finding::Warn : Finding::Ok,
      bad_clock ? std::to_string(t.from_future) + " stamps of the future, " + std::to_string(t.old) + " too old, " +
                      std::to_string(t.clock_jumps) + " jumps"
                : "its stamps fit",
      bad_clock ? "see its clock, and clock=… of the tracker" : "");
  if (t.outside > 0)
    add("frame", Finding::Warn, std::to_string(t.outside) + " sightings lie outside of the arena",
        "see origin and turn of the tracker");
}

}  // namespace

std::string_view name_of(Finding finding) noexcept {
  return finding == Finding::Ok ? "ok" : finding == Finding::Warn ? "warn" : "fail";
}

Finding worst_of(const PreflightRows& rows) noexcept {
  Finding worst = Finding::Ok;
  for (const PreflightRow& row : rows) worst = std::max(worst, row.finding);
  return worst;
}

PreflightRows look_over(const MixedSession& session) {
  PreflightRows rows;
  const std::vector<RealRobotStatus> all = session.status();
  const auto& items = session.world().scenario().robots;
  for (const RealRobotStatus& status : all) {
    const auto item = std::ranges::find(items, status.id, &core::RobotItem::id);
    if (item != items.end() && item->bridge) Looker(session, *item, status, rows).look();
  }
  look_apart(session, all, rows);
  for (const TrackerStatus& tracker : session.trackers()) look_at_tracker(tracker, rows);
  return rows;
}

PreflightRows look_over_machine(const core::Scenario& scenario, const hal::DurationHistogram& late) {
  PreflightRows rows;
  const auto add = [&](const char* check, bool good, std::string found, const char* advice) {
    rows.push_back({"machine", check, good ? Finding::Ok : Finding::Warn, std::move(found), good ? "" : advice});
  };
  const Machine machine = look_at_machine(scenario.priority);
  const bool steady = machine.clock_source.empty() || machine.clock_source == "tsc" ||
                      machine.clock_source.starts_with("arch") || machine.clock_source == "kvm-clock";
  add("clock source", steady, machine.clock_source.empty() ? "not told" : machine.clock_source,
      "a slow clock costs time in every tick: see the system's boot messages about the tsc");
  const bool by_date =
      std::ranges::any_of(scenario.trackers, [](const core::TrackerItem& t) { return t.clock == "unix"; });
  add("date", machine.date.synchronised || !by_date,
      machine.date.text() + (by_date || machine.date.synchronised ? "" : "; nobody here needs it"),
      "a tracker stamps with the date: run chrony or ntpd here and there, or say clock=\"own\"");
  if (scenario.priority > 0)
    add("priority", machine.priority.ok(),
        machine.priority.ok() ? "granted: " + std::to_string(scenario.priority) : machine.priority.error().message,
        "give this user the right (ulimit -r, or rtprio in /etc/security/limits.conf)");
  add("load", machine.load < kBusy,
      machine.load < 0.0 ? "not told"
                         : hal::format_number(std::round(machine.load * 100.0)) + " % of " +
                               std::to_string(machine.processors) + " processors",
      "end other programs, or ask for a real-time priority (<time priority=…>)");
  const double tick_s = 1.0 / static_cast<double>(scenario.ticks_per_second);
  const double worst_s = hal::to_seconds(late.largest_ns());
  add("wake-up", worst_s < kLateShare * tick_s, ms(worst_s) + " late at most, of a tick of " + ms(tick_s),
      "other programs keep this one from running: end them, or ask for a real-time priority");
  return rows;
}

}  // namespace tandem::mixed_reality
