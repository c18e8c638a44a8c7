#include "core/live/live_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/live/condition.hpp"
#include "core/live/controls.hpp"
#include "core/live/field_ref.hpp"
#include "core/live/inspection.hpp"
#include "core/live/timeline.hpp"
#include "core/live/touch.hpp"
#include "hal/element.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::core {
namespace {

using hal::Json;

constexpr std::size_t kMostPosted = 1000;
constexpr hal::TimeNs kLook_ns = 50 * hal::kNsPerMs;         // for a stop that nobody notifies of
constexpr hal::TimeNs kMostBehind_ns = 250 * hal::kNsPerMs;  // that is made up for
constexpr hal::TimeNs kMeasured_ns = 500 * hal::kNsPerMs;    // speed, of late
constexpr hal::TimeNs kHistory_ns = hal::kNsPerSecond;       // that a look back may hold the run up
constexpr std::size_t kMostSamples = 10'000;
constexpr double kLongestCommand = 1e9;

Json refused(const std::string& why) {
  return {{"ok", false}, {"error", why}};
}

bool is_go_to(const Json& command) {
  return hal::text_of(command, "do") == "go_to";
}

/// A whole number from `least` on. Error: missing, or something else.
hal::Result<std::int64_t> whole(const Json& json, const char* key, std::int64_t least,
                                std::optional<std::int64_t> otherwise = {}) {
  const auto found = json.find(key);
  if (found == json.end() && otherwise) return *otherwise;
  if (found != json.end() && found->is_number_integer() && found->get<double>() < kLongestCommand &&
      found->get<std::int64_t>() >= least)
    return found->get<std::int64_t>();
  return hal::Error{"\"" + std::string(key) + "\" is a whole number from " + std::to_string(least) + " on"};
}

/// A speed: times real time; null: as fast as possible.
hal::Result<std::optional<double>> speed_of(const Json& json) {
  if (json.is_null()) return std::optional<double>();
  if (json.is_number()) {
    const double times = json.get<double>();
    if (times >= 0.001 && times <= 1e6) return std::optional<double>(times);
  }
  return hal::Error{"a speed is a number from 0.001 to 1000000, times real time, or null: as fast as possible"};
}

std::vector<std::string> texts(const Json& json, const char* key) {
  std::vector<std::string> all;
  for (const Json& text : hal::list_of(json, key)) {
    if (text.is_string()) all.push_back(text.get<std::string>());
  }
  return all;
}

}  // namespace

Json to_json(const LiveState& s) {
  const auto or_null = [](const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); };
  return {{"tick", s.tick},
          {"latest", s.latest},
          {"first", s.first},
          {"paused", s.paused},
          {"speed", s.speed ? Json(*s.speed) : Json(nullptr)},
          {"reached", s.reached},
          {"ended", or_null(s.ended)},
          {"stopped_by", or_null(s.stopped_by)},
          {"no_way_back", or_null(s.no_way_back)},
          {"seed", s.seed}};
}

struct LiveRun::Impl {
  struct Posted {
    Json command;
    LiveReply reply;
    std::function<void()> own = {};  // instead of the command
  };

  Impl(World& w, LiveOptions o)
      : world(w),
        options(std::move(o)),
        clock(options.clock != nullptr ? *options.clock : system_clock),
        timeline(world, clock, options),
        paused(options.paused && (!options.real_robots || options.pause_real)),
        speed(options.speed) {}

  World& world;
  const LiveOptions options;
  LiveClock system_clock;
  LiveClock& clock;
  Timeline timeline;
  Conditions conditions;
  std::map<std::string, LiveCommand, std::less<>> commands;
  std::function<void()> show;

  mutable std::mutex lock;
  std::condition_variable changed;
  std::deque<Posted> posted;  // with `lock`, as the next three
  bool stopped = false, closed = false;
  LiveState state;

  // Of the thread that steps:
  bool paused;
  std::optional<double> speed;
  std::int64_t steps_wanted = 0;  // single ticks
  std::string stopped_by;
  std::string failure;
  hal::TimeNs anchor_ns = 0;  // of the schedule
  std::int64_t slots = 0;     // ticks since then
  hal::TimeNs step_began_ns = 0;
  std::uint64_t misses = 0;
  hal::TimeNs measured_ns = 0;  // since when
  std::int64_t measured_ticks = 0;
  double reached = 0.0;

  // --- time ---

  double period_ns() const { return 1e9 / (static_cast<double>(world.ticks_per_second()) * *speed); }
  hal::TimeNs due_ns() const {
    return anchor_ns + static_cast<hal::TimeNs>(std::llround(static_cast<double>(slots) * period_ns()));
  }
  void begin_schedule() {
    anchor_ns = clock.now_ns();
    slots = 0;
    measured_ns = anchor_ns;
    measured_ticks = 0;
  }
  void measure(hal::TimeNs now_ns) {
    if (now_ns - measured_ns < kMeasured_ns) return;
    reached = static_cast<double>(measured_ticks) * 1e9 /
              (static_cast<double>(world.ticks_per_second()) * static_cast<double>(now_ns - measured_ns));
    measured_ns = now_ns;
    measured_ticks = 0;
  }

  std::string why_ended() const {
    if (world.state() == RunState::Failed) return world.failure();
    if (world.state() == RunState::Done) return "a hook ended the run";
    if (options.ticks > 0 && world.tick() >= options.ticks)
      return "its " + std::to_string(options.ticks) + " ticks are done";
    return {};
  }
  bool over() const {
    return world.state() != RunState::Running || (options.ticks > 0 && world.tick() >= options.ticks);
  }

  /// Brings what others see up to date; `told`: something that they are to be told of has changed.
  void publish(bool told) {
    const std::lock_guard hold(lock);
    state.tick = world.tick();
    state.latest = timeline.latest_tick();
    state.first = timeline.first_tick();
    state.reached = paused ? 0.0 : reached;
    if (!told) return;
    state.paused = paused;
    state.speed = options.real_robots ? std::optional<double>(1.0) : speed;
    state.ended = over() ? why_ended() : std::string();
    state.stopped_by = stopped_by;
    state.no_way_back = timeline.no_way_back();
    state.seed = world.seed();
    ++state.changes;
  }

  // --- commands ---

  hal::Result<Json> carry_out(const Json& command) {
    const auto name = command.is_object() ? command.find("do") : command.end();
    if (!command.is_object() || name == command.end() || !name->is_string())
      return hal::Error{"a command is an object with its name in \"do\""};
    const auto found = commands.find(name->get<std::string>());
    if (found != commands.end()) return found->second(command);
    std::vector<std::string> names;
    for (const auto& [known, function] : commands) names.push_back(known);
    return hal::Error{"there is no command '" + name->get<std::string>() + "'" +
                      hal::did_you_mean(name->get<std::string>(), names)};
  }

  /// @returns whether there was anything.
  bool carry_out_posted() {
    bool any = false;
    for (;;) {
      Posted next;
      bool overtaken = false;
      {
        const std::lock_guard hold(lock);
        if (posted.empty()) break;
        next = std::move(posted.front());
        posted.pop_front();
        overtaken = !posted.empty() && is_go_to(next.command) && is_go_to(posted.front().command);
      }
      any = true;
      if (next.own) {
        next.own();
        continue;
      }
      if (overtaken) {  // who drags along the bar wants the last place alone
        if (next.reply) next.reply({{"ok", true}, {"skipped", true}});
        continue;
      }
      const hal::Result<Json> done = carry_out(next.command);
      publish(true);  // before the answer, so that whoever has it sees what it says
      if (!next.reply) continue;
      if (!done.ok()) {
        next.reply(refused(done.error().message));
        continue;
      }
      Json answer{{"ok", true}};
      answer.update(done.value());
      next.reply(answer);
    }
    return any;
  }

  void add_commands();
  hal::Status no_pause() const {
    if (!options.real_robots) return {};
    if (options.pause_real) return hal::Error{"real robots take part, and time has one speed: pause it, or halt them"};
    return hal::Error{"real robots take part, whose time cannot be held: halt them instead"};
  }
  hal::Result<Json> play(const Json& c);
  hal::Result<Json> pause(const Json& c);
  hal::Result<Json> pause_real(bool on, const Json& c);
  hal::Result<Json> step(const Json& c);
  hal::Result<Json> set_speed(const Json& c);
  hal::Result<Json> go_to(const Json& c);
  hal::Result<Json> reset(const Json& c);
  hal::Result<Json> undo();
  hal::Result<Json> stop_when(const Json& c);
  hal::Result<Json> history(const Json& c);
  hal::Result<Json> act(const Json& c);
  Json here() const { return {{"tick", world.tick()}}; }
  bool stop_asked() const {
    const std::lock_guard hold(lock);
    return stopped || (options.stop != nullptr && options.stop->load(std::memory_order_relaxed));
  }
  /// Whoever looks back when the run ends leaves it as it is, not as it was.
  void leave() {
    if (!timeline.known()) return;
    if (const hal::Status there = timeline.go_to(timeline.latest_tick()); !there.ok())
      options.log.warning(there.error().message);
  }
  void moved() {
    conditions.forget(world);
    begin_schedule();
    shown();
  }
  void shown() {
    publish(true);
    if (show) show();
  }
};

void LiveRun::Impl::add_commands() {
  commands["play"] = [this](const Json& c) { return play(c); };
  commands["pause"] = [this](const Json& c) { return pause(c); };
  commands["step"] = [this](const Json& c) { return step(c); };
  commands["speed"] = [this](const Json& c) { return set_speed(c); };
  commands["go_to"] = [this](const Json& c) { return go_to(c); };
  commands["reset"] = [this](const Json& c) { return reset(c); };
  commands["undo"] = [this](const Json&) { return undo(); };
  commands["stop_when"] = [this](const Json& c) { return stop_when(c); };
  commands["history"] = [this](const Json& c) { return history(c); };
  commands["inspect"] = [this](const Json& c) -> hal::Result<Json> { return inspection_of(world, texts(c, "robots")); };
  commands["controls"] = [this](const Json&) -> hal::Result<Json> { return Json{{"controls", controls_json(world)}}; };
  for (const char* name : {"move", "add", "remove", "light", "halt", "release", "set", "press", "reload"})
    commands[name] = [this](const Json& c) { return act(c); };
}

hal::Result<Json> LiveRun::Impl::play(const Json& c) {
  if (options.real_robots) return pause_real(false, c);
  if (over()) return hal::Error{"the run has ended (" + why_ended() + "): go back to an earlier tick, or reset it"};
  if (c.contains("speed")) {
    const auto wanted = speed_of(c["speed"]);
    if (!wanted.ok()) return wanted.error();
    speed = wanted.value();
  }
  paused = false;
  steps_wanted = 0;
  stopped_by.clear();
  begin_schedule();
  return here();
}

/// Of a run with real robots.
hal::Result<Json> LiveRun::Impl::pause_real(bool on, const Json& c) {
  if (!options.pause_real) return no_pause().error();
  if (const hal::Status done = options.pause_real(on); !done.ok()) return done.error();
  paused = on;
  Json action = c;
  action.erase("id");
  timeline.note(action);
  return here();
}

hal::Result<Json> LiveRun::Impl::pause(const Json& c) {
  if (options.real_robots) return pause_real(true, c);
  paused = true;
  steps_wanted = 0;
  return here();
}

hal::Result<Json> LiveRun::Impl::step(const Json& c) {
  if (const hal::Status can = no_pause(); !can.ok()) return can.error();
  const auto ticks = whole(c, "ticks", 1, 1);
  if (!ticks.ok()) return ticks.error();
  if (over()) return hal::Error{"the run has ended (" + why_ended() + "): go back to an earlier tick, or reset it"};
  paused = true;
  steps_wanted = ticks.value();
  stopped_by.clear();
  return here();
}

hal::Result<Json> LiveRun::Impl::set_speed(const Json& c) {
  if (const hal::Status can = no_pause(); !can.ok()) return can.error();
  const auto times = c.find("times");
  if (times == c.end())
    return hal::Error{"\"times\" is missing: how many times real time, or null: as fast as possible"};
  const auto wanted = speed_of(*times);
  if (!wanted.ok()) return wanted.error();
  speed = wanted.value();
  begin_schedule();
  return Json::object();
}

hal::Result<Json> LiveRun::Impl::go_to(const Json& c) {
  const auto tick = whole(c, "tick", 0);
  if (!tick.ok()) return tick.error();
  if (const hal::Status gone = timeline.go_to(tick.value()); !gone.ok()) return gone.error();
  paused = true;
  steps_wanted = 0;
  stopped_by.clear();
  moved();
  return here();
}

hal::Result<Json> LiveRun::Impl::reset(const Json& c) {
  if (options.real_robots) return hal::Error{"there is no reset: real robots take part, which cannot be put back"};
  Json action{{"do", "reset"}};
  if (c.contains("seed")) action["seed"] = c["seed"];
  auto done = timeline.act(action);
  stopped_by.clear();
  moved();
  return done;
}

hal::Result<Json> LiveRun::Impl::undo() {
  auto done = timeline.undo();
  if (done.ok()) moved();
  return done;
}

hal::Result<Json> LiveRun::Impl::act(const Json& c) {
  Json action = c;
  action.erase("id");  // of the message
  if (!options.real_robots) {
    auto done = timeline.act(std::move(action));
    if (done.ok()) shown();
    return done;
  }
  auto done = touch(world, action);
  if (done.ok()) timeline.note(action);
  return done;
}

hal::Result<Json> LiveRun::Impl::stop_when(const Json& c) {
  if (hal::flag_of(c, "clear")) {
    conditions.clear();
    return Json::object();
  }
  if (const hal::Status can = no_pause(); !can.ok()) return can.error();
  const hal::Status added = conditions.add(c, world);
  if (!added.ok()) return added.error();
  return Json::object();
}

hal::Result<Json> LiveRun::Impl::history(const Json& c) {
  const auto field = read_field_ref(c);
  if (!field.ok()) return field.error();
  const auto robot = c.find("robot");
  if (robot == c.end() || !robot->is_string()) return hal::Error{"\"robot\" is missing: an id"};
  const auto id = robot->get<std::string>();
  const RobotId now = world.space().find_robot(id);
  if (now.valid()) {
    if (const auto known = value_of(field.value(), world.space(), now); !known.ok()) return known.error();
  }
  const auto from = whole(c, "from", 0, timeline.first_tick());
  const auto to = whole(c, "to", 0, world.tick());
  const auto every = whole(c, "every", 1, 1);
  for (const auto* number : {&from, &to, &every}) {
    if (!number->ok()) return number->error();
  }
  if (!timeline.no_way_back().empty()) return hal::Error{"there is no past to be had: " + timeline.no_way_back()};
  hal::Tick first = std::max(from.value(), timeline.first_tick());
  const hal::Tick last = std::min(to.value(), timeline.latest_tick());
  if (first > last)
    return hal::Error{"there are ticks " + std::to_string(timeline.first_tick()) + " to " +
                      std::to_string(timeline.latest_tick())};
  std::int64_t stride = every.value();
  stride = std::max(stride, (last - first) / static_cast<std::int64_t>(kMostSamples) + 1);
  const hal::Tick affordable = kHistory_ns / std::max<hal::TimeNs>(1000, timeline.step_cost_ns());
  Json answer;
  if (last - first + timeline.ticks_to(first) > affordable) {
    first = std::max(first, last - affordable);
    answer["bounded"] = "the last " + std::to_string(last - first) +
                        " ticks: to compute more of them again would hold the run up for more than a second";
  }
  Json ticks = Json::array();
  Json values = Json::array();
  const hal::Status looked = timeline.look_back(first, last, [&](hal::Tick tick) {
    if ((tick - first) % stride != 0) return;
    ticks.push_back(tick);
    const auto value = value_of(field.value(), world.space(), world.space().find_robot(id));
    const bool number = value.ok() && value.value() && std::isfinite(*value.value());
    values.push_back(number ? Json(*value.value()) : Json(nullptr));
  });
  begin_schedule();
  if (!looked.ok()) return looked.error();
  answer["ticks"] = std::move(ticks);
  answer["values"] = std::move(values);
  return answer;
}

LiveRun::LiveRun(World& world, LiveOptions options) : impl_(std::make_unique<Impl>(world, std::move(options))) {
  impl_->add_commands();
  impl_->publish(true);
}

LiveRun::~LiveRun() {
  close();
}

void LiveRun::post(Json command, LiveReply reply) {
  std::string why;
  {
    const std::lock_guard hold(impl_->lock);
    if (impl_->closed)
      why = "the run is over";
    else if (impl_->posted.size() >= kMostPosted)
      why = "too many commands wait to be carried out: send fewer";
    else
      impl_->posted.push_back({std::move(command), std::move(reply)});
  }
  if (why.empty())
    impl_->changed.notify_one();
  else if (reply)
    reply(refused(why));
}

void LiveRun::post_own(std::function<void()> call) {
  {
    const std::lock_guard hold(impl_->lock);
    if (impl_->closed) return;
    impl_->posted.push_back({Json(), {}, std::move(call)});
  }
  impl_->changed.notify_one();
}

void LiveRun::stop() {
  {
    const std::lock_guard hold(impl_->lock);
    impl_->stopped = true;
  }
  impl_->changed.notify_one();
}

void LiveRun::close() {
  std::deque<Impl::Posted> left;
  {
    const std::lock_guard hold(impl_->lock);
    impl_->closed = true;
    left.swap(impl_->posted);
  }
  for (const Impl::Posted& posted : left) {
    if (posted.own) posted.own();
    if (posted.reply) posted.reply(refused("the run is over"));
  }
}

LiveState LiveRun::state() const {
  const std::lock_guard hold(impl_->lock);
  return impl_->state;
}

void LiveRun::start() {
  impl_->timeline.start();
  impl_->begin_schedule();
  impl_->publish(true);
}

bool LiveRun::before_step() {
  Impl& r = *impl_;
  bool rests = false;
  for (;;) {
    if (r.carry_out_posted()) rests = false;
    if (r.stop_asked()) {
      r.leave();
      return false;
    }
    hal::TimeNs until_ns = r.clock.now_ns() + kLook_ns;
    if (r.over() && !r.options.stay) return false;
    if (r.over() || (r.paused && r.steps_wanted == 0)) {
      if (!std::exchange(rests, true)) r.shown();
    } else if (r.steps_wanted > 0 || (!r.paused && !r.speed)) {
      break;
    } else if (!r.paused) {
      const hal::TimeNs due_ns = r.due_ns();
      const hal::TimeNs now_ns = r.clock.now_ns();
      if (now_ns >= due_ns) {
        if (now_ns - due_ns > static_cast<hal::TimeNs>(r.period_ns())) ++r.misses;
        if (now_ns - due_ns > kMostBehind_ns) {
          r.anchor_ns = now_ns;
          r.slots = 0;
        }
        ++r.slots;
        break;
      }
      until_ns = std::min(until_ns, due_ns);
    }
    std::unique_lock hold(r.lock);
    if (r.posted.empty() && !r.stopped) r.clock.wait_until(hold, r.changed, until_ns);
  }
  if (const hal::Status done = r.timeline.before_step(); !done.ok()) {
    r.failure = done.error().message;
    return false;
  }
  r.step_began_ns = r.clock.now_ns();
  return true;
}

bool LiveRun::after_step() {
  Impl& r = *impl_;
  if (r.options.real_robots) {
    r.carry_out_posted();
    r.publish(r.over());
    return true;
  }
  const hal::TimeNs now_ns = r.clock.now_ns();
  const bool is_new = r.timeline.after_step(now_ns - r.step_began_ns);
  ++r.measured_ticks;
  r.measure(now_ns);
  bool told = r.over();
  if (r.steps_wanted > 0) told = --r.steps_wanted == 0 || told;
  if (!r.conditions.empty()) {
    r.stopped_by = r.conditions.check(r.world);
    if (!r.stopped_by.empty()) {
      r.paused = told = true;
      r.steps_wanted = 0;
    }
  }
  r.publish(told);
  if (!is_new && r.show) r.show();
  return is_new;
}

void LiveRun::look() {
  if (impl_->carry_out_posted() && impl_->show) impl_->show();
}

void LiveRun::add_command(std::string name, LiveCommand command) {
  impl_->commands[std::move(name)] = std::move(command);
}
void LiveRun::on_show(std::function<void()> show) {
  impl_->show = std::move(show);
}
void LiveRun::on_event(std::function<void(hal::Tick, const Json&)> tell) {
  impl_->timeline.on_event = std::move(tell);
}
const std::string& LiveRun::failure() const noexcept {
  return impl_->failure;
}
std::uint64_t LiveRun::deadline_misses() const noexcept {
  return impl_->misses;
}

}  // namespace tandem::core
