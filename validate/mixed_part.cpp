// The twin, the filter and `tandem fit` against emulated robots' own logs, over delays, links and slip.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

#include "validate/goodness.hpp"
#include "validate/laboratory.hpp"
#include "validate/parts.hpp"

namespace tandem::validate {
namespace {

constexpr double kSettled_s = 20.0;      // in which the filter learns: not judged
constexpr double kAssumedSlip_mm = 4.0;  // after 1 m: what the filter counts with, whatever the wheels do

/// Wanders about its place: each stretch is driven back as it was driven there. Speeds are whole numbers of the steps
/// that the foot-bot's motors know, 0.41398 cm/s: what they round would pass for slip.
constexpr const char* kWander = R"(
local state, left, right, ticks, back, length = 1, 0, 0, 0, true, 0
local function chance() state = (state * 1103515245 + 12345) % 2147483648; return state / 2147483648 end
local function whole(speed) return 0.41398 * math.floor(speed / 0.41398 + 0.5) end
function init() state = 17 + 131 * tonumber(string.match(robot.id, "%d+")) end
function step()
  if ticks == 0 then
    back = not back
    if back then left, right, ticks = -left, -right, length
    else
      local speed, turn = 3 + 15 * chance(), 10 * (chance() - 0.5)
      left, right = whole(speed - turn), whole(speed + turn)
      length = 4 + math.floor(12 * chance()); ticks = length
    end
  end
  ticks = ticks - 1
  robot.wheels.set_velocity(left, right)
end
)";

/// What is hidden in a robot.
struct Hidden {
  double command_ms = 0.0, body_ms = 0.0, counter_ms = 0.0, link_ms = 0.0;  // link: each way
  double slip_mm = 0.0;
  double left = 1.0, right = 1.0;

  std::vector<std::string> options(std::size_t number) const {
    const auto s = [](double ms) { return fmt::format("{} s", ms / 1000.0); };
    return {"--command_delay",  s(command_ms),
            "--wheel_delay",    s(body_ms),
            "--counter_delay",  s(counter_ms),
            "--to_robot_delay", s(link_ms),
            "--to_host_delay",  s(link_ms),
            "--wheel_noise",    fmt::format("{}", slip_mm / 1000.0),
            "--left_wheel",     fmt::format("{}", left),
            "--right_wheel",    fmt::format("{}", right),
            "--wheel_seed",     fmt::format("{}", number + 1)};
  }
  std::string words() const {
    return fmt::format("{:g} / {:g} / {:g} / {:g} / {:g}", command_ms, body_ms, counter_ms, link_ms, slip_mm);
  }
};

std::vector<Hidden> grid() {
  std::vector<Hidden> all;
  for (const double body : {0.0, 60.0})
    for (const double command : {0.0, 30.0, 60.0, 110.0}) all.push_back({command, body, 0.0, 0.0, 0.0, 0.99, 1.01});
  for (const double link : {10.0, 30.0})
    for (const double slip : {2.0, kAssumedSlip_mm}) all.push_back({20.0, 20.0, 0.0, link, slip, 1.015, 0.99});
  all.push_back({0.0, 0.0, 60.0, 0.0, kAssumedSlip_mm, 1.0, 1.0});
  all.push_back({20.0, 40.0, 20.0, 20.0, kAssumedSlip_mm, 0.985, 1.0});
  return all;
}

/// Sums over ticks. NEES: squared errors by their own covariance, divided by their dimension.
struct Errors {
  double place2 = 0.0, heading2 = 0.0, nees_place = 0.0, nees_heading = 0.0;
  std::size_t n = 0, tracked = 0;

  double mean_nees_place() const { return nees_place / static_cast<double>(std::max<std::size_t>(1, tracked)); }
  double mean_nees_heading() const { return nees_heading / static_cast<double>(std::max<std::size_t>(1, tracked)); }
  void add_nees(const Errors& other) {
    nees_place += other.nees_place;
    nees_heading += other.nees_heading;
    tracked += other.tracked;
  }
};

/// Stamps of the run's clock as CLOCK_MONOTONIC, tick by tick.
class RunClock {
 public:
  explicit RunClock(const RecordTable& table)
      : rows_(table.rows.at("run")), monotonic_(table.column("monotonic_ns")), run_(table.column("run_ns")) {}
  std::size_t ticks() const { return rows_.size(); }
  double monotonic_ns(std::size_t tick, double run_ns) const {
    return rows_.at(tick)[monotonic_] - (rows_.at(tick)[run_] - run_ns);
  }
  double run_ns(std::size_t tick) const { return rows_.at(tick)[run_]; }

 private:
  const std::vector<std::vector<double>>& rows_;
  std::size_t monotonic_, run_;
};

Errors errors_of(const std::string& id, const TrueTrack& truth, const RecordTable& poses, const RecordTable& tracks,
                 const RunClock& clock) {
  Errors e;
  const auto& shown = poses.rows.at(id);
  const auto& track = tracks.rows.at(id);
  const std::size_t x = poses.column("x_m"), y = poses.column("y_m"), h = poses.column("heading_rad");
  const std::size_t tx = tracks.column("x_m"), ty = tracks.column("y_m"), th = tracks.column("heading_rad"),
                    taken = tracks.column("taken_ns"), known = tracks.column("known"),
                    xx = tracks.column("covariance[0]"), xy = tracks.column("covariance[1]"),
                    yy = tracks.column("covariance[2]"), hh = tracks.column("covariance[5]");
  for (std::size_t t = 0; t < std::min({shown.size(), track.size(), clock.ticks()}); ++t) {
    if (clock.run_ns(t) < kSettled_s * 1e9) continue;
    const TruePlace is = place_at(truth, clock.monotonic_ns(t, clock.run_ns(t)));
    e.place2 += std::pow(shown[t][x] - is.x_m, 2) + std::pow(shown[t][y] - is.y_m, 2);
    e.heading2 += std::pow(std::remainder(shown[t][h] - is.heading_rad, 2.0 * M_PI), 2);
    ++e.n;
    if (track[t][known] != 1.0 || !(track[t][hh] > 0.0)) continue;
    const TruePlace then = place_at(truth, clock.monotonic_ns(t, track[t][taken]));
    const double dx = track[t][tx] - then.x_m, dy = track[t][ty] - then.y_m;
    const double dh = std::remainder(track[t][th] - then.heading_rad, 2.0 * M_PI);
    const double determinant = track[t][xx] * track[t][yy] - track[t][xy] * track[t][xy];
    e.nees_place +=
        (track[t][yy] * dx * dx - 2.0 * track[t][xy] * dx * dy + track[t][xx] * dy * dy) / determinant / 2.0;
    e.nees_heading += dh * dh / track[t][hh];
    ++e.tracked;
  }
  return e;
}

Row twin_row(const Hidden& hidden, const Errors& e) {
  const auto n = static_cast<double>(std::max<std::size_t>(1, e.n));
  const double place_mm = 1e3 * std::sqrt(e.place2 / n), heading_deg = std::sqrt(e.heading2 / n) * 180.0 / M_PI;
  return {{hidden.words(), fmt::format("{:.1f} mm", place_mm), fmt::format("{:.2f}°", heading_deg),
           fmt::format("{:.2f}", e.mean_nees_place()), fmt::format("{:.2f}", e.mean_nees_heading())},
          "twin within 5 mm and 1°",
          verdict_of(e.n > 100 && place_mm <= 5.0 && heading_deg <= 1.0)};
}

/// The filter counts with wheels that slip by so much, and is to be as wrong as it says where they do. It knows nothing
/// of a robot whose wheels are truer: there it is to be no more wrong than it says.
Row nees_row(const std::string& whose, const Errors& sum, bool as_assumed) {
  const double place = sum.mean_nees_place(), heading = sum.mean_nees_heading();
  const auto right = [&](double nees) { return nees >= (as_assumed ? 0.8 : 0.0) && nees <= 1.2; };
  return {{whose, "", "", fmt::format("{:.2f}", place), fmt::format("{:.2f}", heading)},
          as_assumed ? "0.8 to 1.2" : "at most 1.2",
          verdict_of(sum.tracked > 0 && right(place) && right(heading))};
}

/// What the line itself takes, from when a command is given to the link until the wheels are told, in ms: of a robot
/// without hidden delays, by its log.
double own_delay_ms(const Laboratory& lab, const std::string& id, const RecordTable& tracks, const RunClock& clock) {
  const auto& track = tracks.rows.at(id);
  const std::size_t sent = tracks.column("sent_ns");
  const std::vector<double> told = lab.told_of(id);
  double sum_ms = 0.0, n = 0.0;
  for (std::size_t t = 0; t < std::min(track.size(), clock.ticks()); ++t) {
    if (!(track[t][sent] > 0.0)) continue;
    const double at_ns = clock.monotonic_ns(t, track[t][sent]);
    for (auto i = std::lower_bound(told.begin(), told.end(), at_ns - 1e6); i != told.end() && *i < at_ns + 50e6; ++i)
      sum_ms += (*i - at_ns) / 1e6, n += 1.0;
  }
  return n > 0.0 ? sum_ms / n : 0.0;
}

/// A value that `tandem fit` tells, and how often its bounds held.
struct Told {
  const char* name;
  const char* words;
  double unit;
  double (*truth)(const Hidden&, double line_ms);
  std::uint64_t held = 0, n = 0;
};

std::vector<Told> told() {
  return {
      {"left", "left wheel", 1.0, [](const Hidden& h, double) { return h.left; }},
      {"right", "right wheel", 1.0, [](const Hidden& h, double) { return h.right; }},
      {"base", "wheel base", 1.0, [](const Hidden&, double) { return 1.0; }},
      {"delay_s", "delay to the floor", 1e3,
       [](const Hidden& h, double line_ms) { return (line_ms + h.link_ms + h.command_ms + h.body_ms) / 1e3; }},
      {"lag_s", "body behind counters", 1e3, [](const Hidden& h, double) { return (h.body_ms - h.counter_ms) / 1e3; }},
      {"noise_sqrt_m", "noise after 1 m", 1e3, [](const Hidden& h, double) { return h.slip_mm / 1e3; }}};
}

void add_fit(Part& part, const std::vector<Hidden>& hidden, const hal::Json& fit, double line_ms) {
  Table found{"What tandem fit finds",
              fmt::format("Each value ± its 95 % bound, behind it the truth; ms, mm after 1 m, wheels as parts of what "
                          "they should roll. The line itself takes {:.1f} ms to tell the wheels.",
                          line_ms),
              {"command / body / counters / link / slip"},
              {}};
  std::vector<Told> values = told();
  for (const Told& value : values) found.columns.push_back(value.words);
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    Row row{{hidden[i].words()}};
    const hal::Json wheels =
        i < fit["robots"].size() ? fit["robots"][i].value("wheels", hal::Json::object()) : hal::Json::object();
    for (Told& value : values) {
      if (!wheels.contains(value.name) || !wheels[value.name].value("observable", false)) {
        row.cells.push_back("cannot be told");
        continue;
      }
      const hal::Json& w = wheels[value.name];
      const double at = w.value("value", NAN), bound = w.value("bound_95", NAN),
                   truth = value.truth(hidden[i], line_ms);
      const double low = w.value("low_95", at - bound), high = w.value("high_95", at + bound);
      ++value.n;
      value.held += low <= truth && truth <= high ? 1 : 0;
      row.cells.push_back(fmt::format("{:.4g} ± {:.2g} ({:.4g})", value.unit * at, value.unit * 0.5 * (high - low),
                                      value.unit * truth));
    }
    found.rows.push_back(std::move(row));
  }
  part.tables.push_back(std::move(found));
  Table held{"How often the bounds hold",
             "p: how likely it is that so few of bounds that hold in 95 of 100 cases do.",
             {"value", "hold", "of", "p"},
             {}};
  for (const Told& value : values) {
    const double p = value.n == 0 ? 1.0 : binomial_p(value.held, value.n, 0.95);
    const bool few = static_cast<double>(value.held) < 0.95 * static_cast<double>(value.n);
    held.rows.push_back(
        {{value.words, fmt::format("{}", value.held), fmt::format("{}", value.n), fmt::format("{:.3f}", few ? p : 1.0)},
         "p at least 0.01",
         verdict_of(!few || p >= 0.01)});
  }
  part.tables.push_back(std::move(held));
}

template <class T>
T taken(hal::Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().message);
  return std::move(result).value();
}

void judge(Part& part, const Laboratory& lab, const MixedRun& run, const std::vector<Hidden>& hidden) {
  Table twins{
      "Twin and filter",
      fmt::format(
          "Hidden delays in ms of command, body, counters, link each way; slip in mm after 1 m. NEES: squared error by "
          "the covariance that the filter tells, divided by its dimension: 1 where it knows how well it knows. It "
          "counts with wheels that slip by {:g} mm after 1 m; where they slip less it is more careful than it has to "
          "be.",
          kAssumedSlip_mm),
      {"command / body / counters / link / slip", "twin, RMS", "heading, RMS", "NEES of places", "NEES of headings"},
      {}};
  const RecordTable poses = taken(lab.table("pose")), tracks = taken(lab.table("seen track")),
                    clocks = taken(lab.table("run time clock"));
  const RunClock clock(clocks);
  Errors as_assumed, truer;
  for (std::size_t i = 0; i < hidden.size(); ++i) {
    const Errors e = errors_of(run.robots[i].id, taken(lab.log_of(run.robots[i].id)), poses, tracks, clock);
    twins.rows.push_back(twin_row(hidden[i], e));
    (hidden[i].slip_mm < kAssumedSlip_mm ? truer : as_assumed).add_nees(e);
  }
  twins.rows.push_back(nees_row("all that slip as the filter assumes", as_assumed, true));
  twins.rows.push_back(nees_row("all that slip less", truer, false));
  part.tables.push_back(std::move(twins));
  add_fit(part, hidden, taken(lab.fit()), own_delay_ms(lab, run.robots[0].id, tracks, clock));
}

}  // namespace

Part mixed_part(Depth depth) {
  Part part{"Real robots: twin, filter, fit",
            "Emulated foot-bots with hidden delays, links and slip, each a process, in one run in real time, seen by "
            "an emulated tracker that is "
            "60 ms late with 2 mm of noise. The truth is that of the robots' own logs."};
  if (depth == Depth::Short) {
    part.text += " It takes minutes, so the short form leaves it out.";
    return part;
  }
  const std::vector<Hidden> hidden = grid();
  MixedRun run{{}, kWander, "", 150.0};
  for (std::size_t i = 0; i < hidden.size(); ++i)
    run.robots.push_back({fmt::format("fb{}", i), -16.0 + 8.0 * static_cast<double>(i % 5),
                          -12.0 + 8.0 * static_cast<double>(i / 5), 0.0, hidden[i].options(i)});
  try {
    in_fair_trials(part, run, [&](Part& judged, const Laboratory& lab) { judge(judged, lab, run, hidden); });
  } catch (const std::exception& wrong) {
    part.tables.push_back({"Twin and filter", "", {"error"}, {{{wrong.what()}, "", Verdict::NotMade}}});
  }
  return part;
}

}  // namespace tandem::validate
