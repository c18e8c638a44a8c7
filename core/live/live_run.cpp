#include "core/live/live_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/live/live_run_impl.hpp"
#include "hal/element.hpp"
#include "hal/json/json_access.hpp"

namespace tandem::core {
namespace {

using hal::Json;

constexpr std::size_t kMostPosted = 1000;
constexpr hal::TimeNs kLook_ns = 50 * hal::kNsPerMs;         // for a stop that nobody notifies of
constexpr hal::TimeNs kMostBehind_ns = 250 * hal::kNsPerMs;  // that is made up for
constexpr hal::TimeNs kMeasured_ns = 500 * hal::kNsPerMs;    // speed, of late

Json refused(const std::string& why) {
  return {{"ok", false}, {"error", why}};
}

bool is_go_to(const Json& command) {
  return hal::text_of(command, "do") == "go_to";
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

void LiveRun::Impl::measure(hal::TimeNs now_ns) {
  if (now_ns - measured_ns < kMeasured_ns) return;
  reached = static_cast<double>(measured_ticks) * 1e9 /
            (static_cast<double>(world.ticks_per_second()) * static_cast<double>(now_ns - measured_ns));
  measured_ns = now_ns;
  measured_ticks = 0;
}

hal::Result<Json> LiveRun::Impl::carry_out(const Json& command) {
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
bool LiveRun::Impl::carry_out_posted() {
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
