#include "tests/hidden_robots/hidden_robot.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "tests/hidden_robots/record_writer.hpp"

namespace tandem::hidden {
namespace {

constexpr double kBase_m = 0.14;  // of a foot-bot, by its data sheet
constexpr double kTick_s = 0.1;
constexpr double kFine_s = 1e-3;   // steps of the body's motion
constexpr double kCount_m = 5e-5;  // of a counter
constexpr double kTracker_Hz = 30.0;
constexpr double kTracker_late_s = 0.06;

/// Chance by a seed, the same on every machine.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : bits_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11U) + 0.5) / 9007199254740992.0;
  }
  double normal() { return std::sqrt(-2.0 * std::log(uniform(0.0, 1.0))) * std::cos(2.0 * M_PI * uniform(0.0, 1.0)); }
  bool one_in(double n) { return uniform(0.0, n) < 1.0; }

 private:
  std::mt19937_64 bits_;
};

struct Wheels {
  double left = 0.0, right = 0.0;
};

/// A command and when it was given to the link.
struct Sent {
  double at_s;
  Wheels speed;
};

struct Place {
  double x = 0.0, y = 0.0, heading = 0.0;
};

/// Commands of a wandering robot: straight stretches, curves both ways, turns on the spot, backwards, rests.
std::vector<Wheels> commands_of(std::size_t ticks, Chance& chance) {
  std::vector<Wheels> all(ticks);
  Wheels now;
  for (std::size_t t = 0, left = 0; t < ticks; ++t, --left) {
    if (left == 0) {
      left = static_cast<std::size_t>(chance.uniform(3.0, 15.0));
      const double speed = chance.uniform(-0.1, 0.2);
      const double turn = chance.uniform(-0.12, 0.12);
      now = {speed - turn, speed + turn};
      if (chance.one_in(10.0)) now = {};
    }
    all[t] = t < 5 ? Wheels{} : now;
  }
  return all;
}

/// The robot in time: what its motors turned and where it was, at every fine step from -1 s on.
class Motion {
 public:
  Motion(const Truth& truth, const std::vector<Sent>& sent, double until_s, Chance& chance) {
    const double late_s = truth.to_robot_s + truth.command_delay_s;
    const auto steps = static_cast<std::size_t>((until_s + kBefore_s) / kFine_s) + 2;
    Wheels turned, rolled;
    Place at{0.0, 0.0, 0.3};
    for (std::size_t i = 0; i < steps; ++i) {
      turned_.push_back(turned);
      at_.push_back(at);
      const double middle_s = static_cast<double>(i) * kFine_s - kBefore_s + 0.5 * kFine_s;
      const Wheels motor = speed_at(sent, middle_s - late_s);
      const Wheels floor = speed_at(sent, middle_s - late_s - truth.body_delay_s);
      turned.left += motor.left * kFine_s;
      turned.right += motor.right * kFine_s;
      rolled = {way(floor.left, truth.left, truth.noise_m, chance),
                way(floor.right, truth.right, truth.noise_m, chance)};
      const double turn = (rolled.right - rolled.left) / (kBase_m * truth.base);
      const double forward = 0.5 * (rolled.left + rolled.right);
      at.x += forward * std::cos(at.heading + 0.5 * turn);
      at.y += forward * std::sin(at.heading + 0.5 * turn);
      at.heading += turn;
    }
  }

  /// What the motors had turned, in metres at the rim.
  Wheels turned(double t_s) const {
    const auto [i, part] = index(t_s);
    return {turned_[i].left + part * (turned_[i + 1].left - turned_[i].left),
            turned_[i].right + part * (turned_[i + 1].right - turned_[i].right)};
  }
  Place at(double t_s) const {
    const auto [i, part] = index(t_s);
    const Place &a = at_[i], &b = at_[i + 1];
    return {a.x + part * (b.x - a.x), a.y + part * (b.y - a.y), a.heading + part * (b.heading - a.heading)};
  }

 private:
  static constexpr double kBefore_s = 1.0;

  static Wheels speed_at(const std::vector<Sent>& sent, double t_s) {
    // The last that was sent before; ticks are regular, so it is near t / tick.
    auto i = static_cast<std::ptrdiff_t>(std::min<double>(static_cast<double>(sent.size()) - 1.0, t_s / kTick_s + 1.0));
    while (i >= 0 && sent[static_cast<std::size_t>(i)].at_s > t_s) --i;
    return i < 0 ? Wheels{} : sent[static_cast<std::size_t>(i)].speed;
  }
  static double way(double speed, double part, double noise_m, Chance& chance) {
    const double exact = speed * part * kFine_s;
    return exact + noise_m * std::sqrt(std::abs(exact)) * chance.normal();
  }
  std::pair<std::size_t, double> index(double t_s) const {
    const double at = std::max(0.0, (t_s + kBefore_s) / kFine_s);
    const auto i = std::min(static_cast<std::size_t>(at), at_.size() - 2);
    return {i, at - static_cast<double>(i)};
  }

  std::vector<Wheels> turned_;
  std::vector<Place> at_;
};

std::int64_t ns(double t_s) {
  return std::llround(t_s * 1e9);
}

struct Sighting {
  double taken_s;
  double x, y, heading;
};

/// Declares all streams.
void begin(RecordWriter& record) {
  record.json(
      1, -1,
      R"({"program":"a generator of tests","experiment":"hidden","seed":1,"ticks_per_second":10,"settings":)"
      R"("<tandem version=\"0\"><framework><experiment length=\"60\" ticks_per_second=\"10\" random_seed=\"1\"/></framework>)"
      R"(<controllers><footbot_diffusion id=\"d\" library=\"footbot_diffusion\"><actuators><differential_steering/></actuators>)"
      R"(<sensors><proximity/></sensors></footbot_diffusion></controllers><arena size=\"40,40,1\">)"
      R"(<foot-bot id=\"r0\"><body position=\"0,0,0\"/><controller config=\"d\"/></foot-bot></arena>)"
      R"(<physics_engines><kinematics2d id=\"k\"/></physics_engines></tandem>"})");
  record.json(3, -1, R"({"members":1,"ids":["r0"],"kinds":["foot-bot"],"kind":[0],"real":[0]})");
  record.json(3, -1, R"({"members":2,"ids":["run"]})");
  record.json(2, -1,
              R"({"stream":1,"of":"run","set":"time","name":"clock","fields":[{"name":"monotonic_ns","type":"i64"},)"
              R"({"name":"run_ns","type":"i64"}]})");
  record.json(2, -1,
              R"({"stream":2,"of":"robot","set":"sent","name":"differential_steering","fields":[)"
              R"({"name":"left","type":"f64"},{"name":"right","type":"f64"}]})");
  record.json(2, -1,
              R"({"stream":3,"of":"robot","set":"seen","name":"track","fields":[{"name":"sent_ns","type":"i64"}]})");
  record.json(
      2, -1,
      R"({"stream":4,"of":"robot","set":"input","name":"wheel_encoders","fields":[{"name":"taken_ns","type":"i64"},)"
      R"({"name":"validity","type":"u8"},{"name":"left","type":"f64"},{"name":"right","type":"f64"}]})");
  record.json(
      2, -1,
      R"({"stream":5,"of":"robot","set":"seen","name":"sightings","fields":[{"name":"count","type":"u8"},)"
      R"({"name":"taken_ns","type":"i64","count":16,"used_by":"count"},{"name":"x","type":"f64","count":16,"used_by":"count"},)"
      R"({"name":"y","type":"f64","count":16,"used_by":"count"},{"name":"heading","type":"f64","count":16,"used_by":"count"},)"
      R"({"name":"true_clock","type":"u8","count":16,"used_by":"count"}]})");
  record.json(
      2, -1,
      R"({"stream":6,"of":"robot","set":"time","name":"ledger","fields":[{"name":"round_trip_median_ms","type":"f32"},)"
      R"({"name":"jitter_ms","type":"f32"}]})");
}

void write_sightings(RecordWriter& record, std::int64_t tick, const std::vector<Sighting>& seen) {
  if (seen.empty()) return;
  std::string row;
  append(row, static_cast<std::uint8_t>(seen.size()));
  for (const Sighting& s : seen) append(row, ns(s.taken_s));
  for (const Sighting& s : seen) append(row, s.x);
  for (const Sighting& s : seen) append(row, s.y);
  for (const Sighting& s : seen) append(row, s.heading);
  for (std::size_t i = 0; i < seen.size(); ++i) append(row, std::uint8_t{1});
  record.row(tick, 5, 1, row);
}

}  // namespace

Truth draw(std::uint64_t number) {
  Chance chance(number * 7919 + 17);
  Truth t;
  t.left = 1.0 + 0.02 * chance.normal();
  t.right = 1.0 + 0.02 * chance.normal();
  t.base = 1.0 + 0.02 * chance.normal();
  t.to_robot_s = t.to_host_s = chance.uniform(0.0, 0.03);
  t.command_delay_s = chance.one_in(3.0) ? 0.0 : chance.uniform(0.0, 0.06);
  t.body_delay_s = chance.one_in(3.0) ? 0.0 : chance.uniform(0.0, 0.11);
  t.counter_delay_s = chance.one_in(2.0) ? 0.0 : chance.uniform(0.0, 0.06);
  t.noise_m = chance.uniform(0.001, 0.005);
  t.tracker_sd_m = chance.uniform(0.001, 0.003);
  t.tracker_sd_rad = chance.uniform(0.005, 0.02);
  return t;
}

std::string record_of(const Truth& truth, std::uint64_t number, double seconds) {
  Chance chance(number * 104729 + 5);
  const auto ticks = static_cast<std::size_t>(std::llround(seconds / kTick_s));
  const std::vector<Wheels> commands = commands_of(ticks, chance);
  std::vector<Sent> sent;
  for (std::size_t t = 0; t < ticks; ++t)
    sent.push_back({static_cast<double>(t) * kTick_s + chance.uniform(0.0005, 0.003), commands[t]});
  const Motion motion(truth, sent, seconds, chance);

  std::vector<Sighting> sightings;
  for (double t = chance.uniform(0.0, 1.0 / kTracker_Hz); t < seconds; t += 1.0 / kTracker_Hz) {
    const Place at = motion.at(t);
    sightings.push_back({t, at.x + truth.tracker_sd_m * chance.normal(), at.y + truth.tracker_sd_m * chance.normal(),
                         std::remainder(at.heading + truth.tracker_sd_rad * chance.normal(), 2.0 * M_PI)});
  }

  RecordWriter record;
  begin(record);
  std::size_t next = 0;
  for (std::size_t t = 0; t < ticks; ++t) {
    const auto tick = static_cast<std::int64_t>(t);
    const double now_s = static_cast<double>(t) * kTick_s;
    std::string clock, speeds, track, counters;
    append(clock, ns(1000.0 + now_s));
    append(clock, ns(now_s));
    record.row(tick, 1, 2, clock);
    append(speeds, commands[t].left);
    append(speeds, commands[t].right);
    record.row(tick, 2, 1, speeds);
    append(track, ns(sent[t].at_s));
    record.row(tick, 3, 1, track);
    // The hub asks some time before the tick, and takes the middle of question and answer for when it was read.
    const double read_s = now_s - chance.uniform(0.01, 0.06) - truth.to_host_s;
    const double stamp_s = read_s + 0.5 * (truth.to_host_s - truth.to_robot_s);
    const Wheels turned = motion.turned(read_s - truth.counter_delay_s);
    append(counters, ns(stamp_s));
    append(counters, std::uint8_t{2});
    append(counters, kCount_m * std::floor(turned.left / kCount_m));
    append(counters, kCount_m * std::floor(turned.right / kCount_m));
    record.row(tick, 4, 1, counters);
    std::vector<Sighting> seen;
    while (next < sightings.size() && sightings[next].taken_s + kTracker_late_s <= now_s)
      seen.push_back(sightings[next++]);
    write_sightings(record, tick, seen);
    if (t % 10 == 0) {
      std::string ledger;
      append(ledger, static_cast<float>(1e3 * (truth.to_robot_s + truth.to_host_s)));
      append(ledger, 0.1F);
      record.row(tick, 6, 1, ledger);
    }
  }
  record.json(8, static_cast<std::int64_t>(ticks) - 1, R"({"ended":"length"})");
  return record.bytes();
}

}  // namespace tandem::hidden
