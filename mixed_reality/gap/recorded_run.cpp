#include "mixed_reality/gap/recorded_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "core/record/record_moments.hpp"
#include "core/record/record_reader.hpp"

namespace tandem::mixed_reality {
namespace {

using core::RecordRows;

constexpr std::size_t kMostTicks = 100'000'000;

std::optional<std::size_t> field(const RecordRows& rows, std::string_view name) {
  const auto& fields = rows.stream().fields;
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const auto& f) { return f.name == name; });
  if (found == fields.end()) return std::nullopt;
  return static_cast<std::size_t>(found - fields.begin());
}

class RunReader {
 public:
  explicit RunReader(RecordedRun& run) : run_(run) {}

  void take(const core::RecordEntry& entry) {
    if (entry.type == core::RecordBlock::End) run_.end = entry.json;
    if (entry.type == core::RecordBlock::Scene && run_.scene.is_null()) run_.scene = entry.json;
    if (!entry.rows || entry.tick < 0) return;
    if (entry.rows->stream().of == "run" && entry.rows->stream().name == "clock") clock(entry);
    if (entry.rows->stream().of != "robot") return;
    const core::RecordStream& stream = entry.rows->stream();
    const bool input = stream.set == "input";
    if (stream.name == "pose" && (stream.set == "pose" || input)) poses(entry, input);
    if (stream.name == "differential_steering" && stream.set == "actuator") commands(entry, false);
    if (stream.name == "differential_steering" && stream.set == "sent") commands(entry, true);
    if (stream.name == "wheel_encoders" && (stream.set == "sensor" || input)) encoders(entry, input);
    if (stream.name == "proximity" && (stream.set == "sensor" || input)) proximity(entry, input);
    if (stream.name == "halted") halted(entry);
    if (stream.set == "seen" && stream.name == "sightings") sightings(entry);
    if (stream.set == "seen" && stream.name == "track") track(entry);
    if (stream.set == "time" && stream.name == "ledger") ledger(entry);
    if (input && stream.on_change) {
      for (std::size_t row = 0; row < entry.rows->size(); ++row)
        holding_[robot(*entry.rows, row).id].insert(stream.name);
    }
  }

 private:
  RecordedRobot& robot(const RecordRows& rows, std::size_t row) {
    const core::RecordMembers& members = rows.members();
    const auto [at, fresh] = places_.try_emplace(members.ids[row], run_.robots.size());
    if (fresh) {
      RecordedRobot& added = run_.robots.emplace_back();
      added.id = members.ids[row];
      if (row < members.kinds.size()) added.kind = members.kinds[row];
    }
    RecordedRobot& found = run_.robots[at->second];
    if (row < members.real.size() && members.real[row]) found.real = true;
    return found;
  }

  RobotTick* at(RecordedRobot& robot, hal::Tick tick) {
    if (!begun_) run_.first = tick;
    begun_ = true;
    if (tick < run_.first || static_cast<std::size_t>(tick - run_.first) >= kMostTicks) return nullptr;
    const auto i = static_cast<std::size_t>(tick - run_.first);
    run_.ticks = std::max(run_.ticks, i + 1);
    if (robot.ticks.size() <= i) robot.ticks.resize(i + 1);
    return &robot.ticks[i];
  }

  /// Calls `use(tick, row)` for each row; what was latched of real robots comes first, and nothing takes its place.
  template <class Use>
  void each(const core::RecordEntry& entry, Use&& use) {
    for (std::size_t row = 0; row < entry.rows->size(); ++row) {
      RecordedRobot& its = robot(*entry.rows, row);
      if (RobotTick* const tick = at(its, entry.tick); tick != nullptr) use(its, *tick, row);
    }
  }

  void poses(const core::RecordEntry& entry, bool input) {
    const RecordRows& rows = *entry.rows;
    const auto x = field(rows, "x"), y = field(rows, "y");
    const auto c = field(rows, "cos"), s = field(rows, "sin"), h = field(rows, "heading"), held = field(rows, "halted");
    if (!x || !y || !((c && s) || h)) return;
    each(entry, [&](RecordedRobot& its, RobotTick& tick, std::size_t row) {
      if (tick.posed && latched_[its.id] == entry.tick && !input) return;
      tick.x_m = rows.value(*x, row);
      tick.y_m = rows.value(*y, row);
      tick.heading_rad = c && s ? std::atan2(rows.value(*s, row), rows.value(*c, row)) : rows.value(*h, row);
      tick.posed = std::isfinite(tick.x_m) && std::isfinite(tick.y_m) && std::isfinite(tick.heading_rad);
      if (input) {
        latched_[its.id] = entry.tick;
        if (held) tick.held = rows.value(*held, row) != 0.0;
      }
    });
  }

  void commands(const core::RecordEntry& entry, bool sent) {
    const auto left = field(*entry.rows, "left"), right = field(*entry.rows, "right");
    if (!left || !right) return;
    each(entry, [&](RecordedRobot&, RobotTick& tick, std::size_t row) {
      if (tick.sent && !sent) return;
      tick.sent = sent;
      tick.told_left_m_s = entry.rows->value(*left, row);
      tick.told_right_m_s = entry.rows->value(*right, row);
      tick.told = std::isfinite(tick.told_left_m_s) && std::isfinite(tick.told_right_m_s);
    });
  }

  void encoders(const core::RecordEntry& entry, bool input) {
    const auto left = field(*entry.rows, "left"), right = field(*entry.rows, "right");
    const auto taken = field(*entry.rows, "taken_ns"), validity = field(*entry.rows, "validity");
    if (!left || !right) return;
    each(entry, [&](RecordedRobot&, RobotTick& tick, std::size_t row) {
      if (tick.counted && !input) return;
      tick.counted_left_m = entry.rows->value(*left, row);
      tick.counted_right_m = entry.rows->value(*right, row);
      tick.counted = std::isfinite(tick.counted_left_m) && std::isfinite(tick.counted_right_m) &&
                     (!validity || entry.rows->value(*validity, row) != 0.0);
      tick.counted_ns = taken && input ? whole(entry.rows->value(*taken, row)) : -1;
    });
  }

  static std::int64_t whole(double value) { return std::isfinite(value) ? std::llround(value) : -1; }

  void clock(const core::RecordEntry& entry) {
    const auto monotonic = field(*entry.rows, "monotonic_ns"), run = field(*entry.rows, "run_ns");
    if (!monotonic || !run || entry.rows->size() == 0) return;
    if (!begun_) run_.first = entry.tick;
    begun_ = true;
    if (entry.tick < run_.first || static_cast<std::size_t>(entry.tick - run_.first) >= kMostTicks) return;
    const auto i = static_cast<std::size_t>(entry.tick - run_.first);
    if (run_.clocks.size() <= i) run_.clocks.resize(i + 1);
    run_.clocks[i] = {true, whole(entry.rows->value(*monotonic, 0)), whole(entry.rows->value(*run, 0))};
  }

  void sightings(const core::RecordEntry& entry) {
    const RecordRows& rows = *entry.rows;
    const auto count = field(rows, "count"), taken = field(rows, "taken_ns"), x = field(rows, "x"),
               y = field(rows, "y"), heading = field(rows, "heading"), right = field(rows, "true_clock");
    if (!count || !taken || !x || !y) return;
    each(entry, [&](RecordedRobot& its, RobotTick& tick, std::size_t row) {
      const std::size_t n = std::min({rows.used(*taken, row), rows.used(*x, row), rows.used(*y, row)});
      for (std::size_t k = 0; k < n; ++k) {
        RecordedSighting seen;
        seen.tick = static_cast<std::size_t>(&tick - its.ticks.data());
        seen.taken_ns = whole(rows.value(*taken, row, k));
        seen.x_m = rows.value(*x, row, k);
        seen.y_m = rows.value(*y, row, k);
        if (heading && k < rows.used(*heading, row)) seen.heading_rad = rows.value(*heading, row, k);
        seen.true_clock = right && k < rows.used(*right, row) && rows.value(*right, row, k) != 0.0;
        if (std::isfinite(seen.x_m) && std::isfinite(seen.y_m)) its.sightings.push_back(seen);
      }
    });
  }

  void track(const core::RecordEntry& entry) {
    const auto sent = field(*entry.rows, "sent_ns");
    if (!sent) return;
    each(entry, [&](RecordedRobot&, RobotTick& tick, std::size_t row) {
      tick.sent_ns = whole(entry.rows->value(*sent, row));
    });
  }

  /// The last one counts: it is of the whole run.
  void ledger(const core::RecordEntry& entry) {
    const auto trip = field(*entry.rows, "round_trip_median_ms"), jitter = field(*entry.rows, "jitter_ms");
    if (!trip) return;
    each(entry, [&](RecordedRobot& its, RobotTick&, std::size_t row) {
      const double trip_s = 1e-3 * entry.rows->value(*trip, row);
      if (!(trip_s > 0.0)) return;
      its.round_trip_s = trip_s;
      its.round_trip_jitter_s = jitter ? 1e-3 * entry.rows->value(*jitter, row) : 0.0;
    });
  }

  void proximity(const core::RecordEntry& entry, bool input) {
    const auto distance = field(*entry.rows, "distance");
    if (!distance) return;
    each(entry, [&](RecordedRobot& its, RobotTick& tick, std::size_t row) {
      if (its.rays == 0) its.rays = entry.rows->used(*distance, row);
      if (its.rays == 0) return;
      const auto i = static_cast<std::size_t>(&tick - its.ticks.data());
      if (its.near_m.size() < (i + 1) * its.rays)
        its.near_m.resize((i + 1) * its.rays, std::numeric_limits<float>::quiet_NaN());
      if (!input && !std::isnan(its.near_m[i * its.rays])) return;
      for (std::size_t k = 0; k < std::min(its.rays, entry.rows->used(*distance, row)); ++k)
        its.near_m[i * its.rays + k] = static_cast<float>(entry.rows->value(*distance, row, k));
    });
  }

  /// Rows come when something changes.
  void halted(const core::RecordEntry& entry) {
    const auto by = field(*entry.rows, "by");
    if (!by) return;
    for (std::size_t row = 0; row < entry.rows->size(); ++row)
      halts_[robot(*entry.rows, row).id][entry.tick] = entry.rows->value(*by, row) != 0.0;
  }

 public:
  void finish() {
    for (RecordedRobot& robot : run_.robots) {
      robot.ticks.resize(run_.ticks);
      if (robot.rays > 0) robot.near_m.resize(run_.ticks * robot.rays, std::numeric_limits<float>::quiet_NaN());
      if (const auto holding = holding_.find(robot.id); holding != holding_.end()) hold(robot, holding->second);
      const auto halts = halts_.find(robot.id);
      if (halts == halts_.end()) continue;
      bool held = false;
      for (std::size_t i = 0; i < robot.ticks.size(); ++i) {
        const auto change = halts->second.find(run_.first + static_cast<hal::Tick>(i));
        if (change != halts->second.end()) held = change->second;
        robot.ticks[i].held = (robot.ticks[i].held || held) && !robot.ticks[i].sent;
      }
    }
  }

 private:
  /// Rows of streams that are written when they change hold until the next.
  static void hold(RecordedRobot& robot, const std::set<std::string>& streams) {
    for (std::size_t i = 1; i < robot.ticks.size(); ++i) {
      const RobotTick& before = robot.ticks[i - 1];
      RobotTick& now = robot.ticks[i];
      if (streams.contains("wheel_encoders") && before.counted && !now.counted) {
        now.counted = true;
        now.counted_left_m = before.counted_left_m;
        now.counted_right_m = before.counted_right_m;
        now.counted_ns = before.counted_ns;
      }
      if (!streams.contains("proximity") || robot.rays == 0 || !std::isnan(robot.near_m[i * robot.rays])) continue;
      const auto row = robot.near_m.begin() + static_cast<std::ptrdiff_t>(i * robot.rays);
      std::copy_n(row - static_cast<std::ptrdiff_t>(robot.rays), robot.rays, row);
    }
  }

  RecordedRun& run_;
  std::map<std::string, std::set<std::string>> holding_;  // names of such streams, by robot
  bool begun_ = false;
  std::map<std::string, std::size_t> places_;
  std::map<std::string, hal::Tick> latched_;
  std::map<std::string, std::map<hal::Tick, bool>> halts_;
};

}  // namespace

double RecordedRun::time_s(std::size_t tick) const noexcept {
  if (tick < clocks.size() && clocks[tick].there && clocks.front().there)
    return hal::to_seconds(clocks[tick].monotonic_ns - clocks.front().monotonic_ns);
  return static_cast<double>(tick) * tick_s();
}

double RecordedRun::time_s(std::size_t tick, std::int64_t stamp_ns) const noexcept {
  const bool there = tick < clocks.size() && clocks[tick].there;
  const hal::TimeNs run_ns =
      there ? clocks[tick].run_ns : hal::time_of_tick(first + static_cast<hal::Tick>(tick), ticks_per_second);
  return time_s(tick) + hal::to_seconds(stamp_ns - run_ns);
}

const RecordedRobot* RecordedRun::find(const std::string& id) const noexcept {
  const auto found = std::find_if(robots.begin(), robots.end(), [&](const auto& r) { return r.id == id; });
  return found == robots.end() ? nullptr : &*found;
}

hal::Result<RecordedRun> read_recorded_run(const std::string& path) {
  auto opened = core::RecordReader::open(path);
  if (!opened.ok()) return opened.error();
  core::RecordReader& reader = opened.value();
  RecordedRun run;
  run.path = path;
  run.start = reader.start();
  if (const auto found = run.start.find("ticks_per_second"); found != run.start.end() && found->is_number())
    run.ticks_per_second = std::clamp<std::int64_t>(found->get<std::int64_t>(), 1, 1'000'000);
  RunReader reading(run);
  while (const auto entry = reader.next()) reading.take(*entry);
  reading.finish();
  // "ep2" before "ep10".
  std::stable_sort(run.robots.begin(), run.robots.end(), [](const RecordedRobot& a, const RecordedRobot& b) {
    return std::pair(a.id.size(), std::string_view(a.id)) < std::pair(b.id.size(), std::string_view(b.id));
  });
  run.damage = reader.damage();
  if (run.robots.empty()) return hal::Error{"record '" + path + "' holds no robots' poses"};
  return run;
}

}  // namespace tandem::mixed_reality
