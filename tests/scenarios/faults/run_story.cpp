#include "tests/scenarios/faults/run_story.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "hal/device/wheels.hpp"
#include "mixed_reality/safety/supervisor.hpp"

namespace tandem::faults {
namespace {

using mixed_reality::RearmParams;
using mixed_reality::RunPhase;
using mixed_reality::Supervisor;

constexpr TimeNs kFrozenAfter = 350 * kMs;   // the guardian's patience with a silent hub
constexpr TimeNs kGuardianWakes = 10 * kMs;  // after a death
constexpr TimeNs kCommandTimeout = 500 * kMs;
constexpr TimeNs kHubWaits = 2 * kSecond;  // an ending hub for its robots, before it leaves them to the guardian
constexpr TimeNs kShutdown = 300 * kMs;    // and then for each to confirm its last word
constexpr TimeNs kRamp = 600 * kMs;        // from 0 to the speed that is told
constexpr TimeNs kHandBack = kSecond;      // a hub that was frozen gets its turn by then

/// The longest times that were seen.
struct Figures {
  TimeNs back_ns = 0;  ///< from the end of the faults to driving as told
  TimeNs rest_ns = 0;  ///< from the death of the hub, or being reachable, to rest
};

/// One robot of a story.
struct Actor {
  std::unique_ptr<TestedRobot> robot;
  Supervisor supervisor{RearmParams{}};
  std::uint64_t interruptions = 0;
  bool faultless = true;
  TimeNs end = 0;            // of its faults
  TimeNs damaged_until = 0;  // what is read may be nonsense
  TimeNs delay = 0;          // of its readings at most
  bool guarded = false, confirmed = false;
  TimeNs drives_since = -1;  // without a break; -1: does not
  TimeNs obeys_since = -1;   // drives as told
  bool rests() const { return robot->speed().none(); }
};

class Run {
 public:
  Run(const Story& story, const Kind& kind, Figures& figures) : story_(story), kind_(kind), figures_(figures) {
    for (std::size_t i = 0; i < story.robots.size(); ++i) {
      actors_.emplace_back().robot = kind.make(i, story.seed + i);
    }
  }

  /// `logs`: takes over what the emulators logged.
  std::string play(golden::Digest& logs) {
    begin();
    if (well()) begin_faults();
    if (well()) hub_fault();
    if (well() && !story_.hub_goes()) check_back();
    if (well() && !story_.hub_goes()) end();
    for (const Actor& a : actors_) logs.add(a.robot->logged().text());
    return wrong_;
  }

 private:
  bool well() const { return wrong_.empty(); }
  void fail(const Actor& a, const std::string& what) {
    if (!well()) return;
    const auto i = static_cast<std::size_t>(&a - actors_.data());
    wrong_ = "robot " + std::to_string(i) + " at " + (now_ < zero_ ? "-" : "") + seconds(std::abs(now_ - zero_)) +
             ": " + what + " [" + a.robot->state() + "]";
  }

  // --- time ---

  void step() {
    now_ += kind_.step_ns;
    for (Actor& a : actors_) {
      a.robot->live(now_);
      if (hub_runs_ && hub_holds_links_) a.robot->pump(now_);
      if (a.guarded && a.robot->guard(now_) && !a.confirmed) {
        a.confirmed = true;
        if (!a.rests()) fail(a, "its stop is confirmed, and it moves");
      }
    }
    if (hub_runs_ && hub_holds_links_ && loop_runs_ && now_ >= next_tick_) loop();
    for (Actor& a : actors_) watch(a);
  }
  template <class Check>
  void run_until(TimeNs until, const Check& check) {
    while (now_ < until && well()) {
      step();
      for (Actor& a : actors_) check(a);
    }
  }
  void run_until(TimeNs until) {
    run_until(until, [](Actor&) {});
  }

  /// One tick of the hub's loop. The speed changes each tick, and is never 0.
  void loop() {
    ++tick_;
    next_tick_ = now_ + kTick;
    const double told = 0.05 + 0.01 * static_cast<double>(tick_ % 4);
    for (Actor& a : actors_) {
      a.robot->latch(tick_, now_);
      check_fresh(a);
      a.robot->command(story_.supervised ? allowed(a, told) : told);
      a.robot->commit(now_);
    }
    hub_froze_ = false;
  }
  double allowed(Actor& a, double told) {
    mixed_reality::Conditions c;
    c.run = phase_;
    c.link = a.robot->health();
    c.pose = hal::Validity::Fresh;
    const std::uint64_t interruptions = a.robot->interruptions();
    c.robot_stopped_itself = interruptions != a.interruptions;
    a.interruptions = interruptions;
    c.hub_was_frozen = hub_froze_;
    a.supervisor.judge(c, now_);
    if (a.supervisor.awaits_rearm()) a.supervisor.rearm();  // a person who is quick
    hal::WheelSpeeds wheels;
    wheels.set(told, told);
    return a.supervisor.allowed(wheels, now_).left_m_s;
  }

  void check_fresh(Actor& a) {
    const hal::Light& light = a.robot->light();
    if (light.validity != hal::Validity::Fresh || now_ < a.damaged_until) return;
    const TimeNs age = age_of_light(static_cast<double>(light.level[0]), now_);
    if (age > kind_.fresh_ns + a.delay + 40 * kMs) fail(a, "a reading that is " + seconds(age) + " old is fresh");
  }
  void watch(Actor& a) {
    const TestedRobot::Speed speed = a.robot->speed();
    if (a.confirmed && !hub_holds_links_ && !speed.none()) fail(a, "it moves after its stop was confirmed");
    const auto note = [&](TimeNs& since, bool is) { since = !is ? -1 : since < 0 ? now_ : since; };
    note(a.drives_since, speed.least > 0.0 && speed.greatest < 0.085);
    note(a.obeys_since, speed.least > 0.045 && speed.greatest < 0.085);
  }

  // --- the acts ---

  void begin() {
    for (Actor& a : actors_) a.robot->open_link(now_);
    run_until(kind_.start_ns);
    for (Actor& a : actors_) {
      if (a.obeys_since < 0) fail(a, "it did not drive at first");
      a.interruptions = a.robot->interruptions();
    }
    zero_ = back_from_ = now_;
  }

  void begin_faults() {
    for (std::size_t i = 0; i < actors_.size(); ++i) {
      Actor& a = actors_[i];
      std::vector<std::string> texts;
      for (const DrawnFault& f : story_.robots[i]) {
        texts.push_back(f.text);
        a.delay += f.delay_ns;
        back_from_ = std::max(back_from_, zero_ + f.until + f.repeat_ns);
        if (f.damages) a.damaged_until = std::max(a.damaged_until, zero_ + f.until + 500 * kMs);
      }
      a.faultless = texts.empty();
      a.end = zero_ + story_.end(i);
      a.robot->begin_faults(texts, story_.seed * 31 + i, zero_);
    }
  }

  void hub_fault() {
    hub_from_ = zero_ + story_.hub_from;
    hub_until_ = zero_ + story_.hub_until;
    if (story_.hub == HubFault::None) return;
    run_until(hub_from_);
    if (story_.hub == HubFault::Stall) stall();
    if (story_.hub == HubFault::Freeze) freeze();
    if (story_.hub == HubFault::Clock) {
      for (Actor& a : actors_) a.robot->jump_clock(story_.jump_ns);
    }
    if (story_.hub == HubFault::End) hub_ends();
    if (story_.hub_goes()) hub_is_gone();
    back_from_ = std::max(back_from_, now_);
  }

  void stall() {
    loop_runs_ = false;
    run_until(hub_until_, [&](Actor& a) {
      if (!a.faultless || now_ <= hub_from_ + kCommandTimeout + 150 * kMs + kind_.coast_ns) return;
      if (!a.rests()) fail(a, "nobody commands it, and it drives");
    });
    loop_runs_ = true;
    next_tick_ = now_;
  }

  void freeze() {
    hub_runs_ = false;
    run_until(std::min(hub_until_, hub_from_ + kFrozenAfter));
    hub_runs_ = true;
    next_tick_ = now_;
    if (hub_until_ - hub_from_ <= kFrozenAfter) {
      for (Actor& a : actors_) a.delay += hub_until_ - hub_from_;  // bytes wait, and nobody stamps them
      return;
    }
    hub_runs_ = false;
    guard_all(false);
    const auto check = [&](Actor& a) {
      const TimeNs reached = a.faultless ? hub_from_ : std::max(a.end + 500 * kMs, hub_from_);
      if (now_ > reached + 500 * kMs + kind_.coast_ns && !a.rests()) fail(a, "the hub sleeps, and it drives");
    };
    run_until(hub_until_, check);
    // The hub is back: its links hang up, all robots are stopped once more, then it is its turn again.
    hub_runs_ = true;
    close_links();
    guard_all(false);
    const auto all_confirmed = [&] {
      return std::all_of(actors_.begin(), actors_.end(), [](const Actor& a) { return a.confirmed; });
    };
    for (const TimeNs by = now_ + kHandBack; now_ < by && !all_confirmed() && well();) run_until(now_ + 1, check);
    for (Actor& a : actors_) {
      a.robot->end_guarding(now_);
      a.guarded = a.confirmed = false;
      a.robot->open_link(now_);
    }
    hub_holds_links_ = hub_froze_ = true;
    next_tick_ = now_;
  }

  void hub_ends() {
    loop_runs_ = false;
    for (Actor& a : actors_) a.robot->stop(now_);
    const auto all_rest = [&] {
      return std::all_of(actors_.begin(), actors_.end(), [](const Actor& a) { return a.robot->at_rest(); });
    };
    for (const TimeNs by = now_ + kHubWaits; now_ < by && !all_rest() && well();) {
      run_until(now_ + 1, [&](Actor& a) { check_belief(a); });
    }
    for (Actor& a : actors_) a.robot->end(now_);
    const auto all_ended = [&] {
      return std::all_of(actors_.begin(), actors_.end(), [](const Actor& a) { return a.robot->ended(); });
    };
    for (const TimeNs by = now_ + kShutdown; now_ < by && !all_ended() && well();) run_until(now_ + 1);
    for (Actor& a : actors_) {
      check_belief(a);
      a.confirmed = a.robot->at_rest();
    }
  }
  void check_belief(const Actor& a) {
    if (a.robot->at_rest() && !a.rests()) fail(a, "the hub believes that it rests, and it moves");
  }

  void hub_is_gone() {
    hub_runs_ = false;
    const TimeNs gone = now_;
    close_links();
    run_until(now_ + kGuardianWakes);
    for (Actor& a : actors_) {
      if (a.confirmed) continue;
      a.guarded = true;
      a.robot->begin_guarding(now_, true);
    }
    run_until(std::max(gone, back_from_) + 3 * kSecond + kind_.coast_ns + kind_.land_ns, [&](Actor& a) {
      const bool reachable = a.faultless || a.end + kSecond <= gone;
      const TimeNs rest_by =
          (reachable ? gone + 250 * kMs : std::max(gone + 250 * kMs, a.end + kSecond)) + kind_.coast_ns;
      if (!a.rests()) {
        figures_.rest_ns = std::max(figures_.rest_ns, now_ - std::max(gone, a.end));
        if (now_ > rest_by) fail(a, "the hub is gone, and it drives");
      }
      if (now_ > rest_by + kSecond + kind_.land_ns && !a.confirmed)
        fail(a, "it can be reached, and its stop is not confirmed");
    });
  }

  void check_back() {
    run_until(back_from_ + kind_.back_ns + kRamp + kSecond);
    for (Actor& a : actors_) {
      if (a.obeys_since < 0) fail(a, "it does not drive as told, long after the faults");
      const TimeNs back = std::max<TimeNs>(0, a.drives_since - back_from_);
      figures_.back_ns = std::max(figures_.back_ns, back);
      if (back > kind_.back_ns + 2 * kind_.step_ns) fail(a, "it drives only " + seconds(back) + " after the faults");
      if (a.obeys_since > back_from_ + back + kRamp) fail(a, "its ramp does not end");
    }
  }

  void end() {
    phase_ = RunPhase::Stopping;
    for (Actor& a : actors_) a.robot->stop(now_);
    run_until(now_ + kSecond + kind_.coast_ns, [&](Actor& a) { check_belief(a); });
    for (Actor& a : actors_) {
      if (!a.robot->at_rest()) fail(a, "its stop is not confirmed at the end");
      if (!a.rests()) fail(a, "it drives at the end");
    }
  }

  void close_links() {
    for (Actor& a : actors_) a.robot->close_link(now_);
    hub_holds_links_ = false;
  }
  void guard_all(bool gone) {
    for (Actor& a : actors_) {
      a.guarded = true;
      a.confirmed = false;
      a.robot->begin_guarding(now_, gone);
    }
  }

  const Story& story_;
  const Kind& kind_;
  Figures& figures_;
  std::vector<Actor> actors_;
  std::string wrong_;
  RunPhase phase_ = RunPhase::Running;
  bool loop_runs_ = true, hub_runs_ = true, hub_holds_links_ = true, hub_froze_ = false;
  hal::Tick tick_ = 0;
  TimeNs now_ = 0, next_tick_ = 0;
  TimeNs zero_ = 0;                      // the faults begin
  TimeNs hub_from_ = 0, hub_until_ = 0;  // the hub's
  TimeNs back_from_ = 0;                 // nothing is wrong from here on
};

std::uint64_t number_in(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr || *text == '\0' ? otherwise : std::strtoull(text, nullptr, 10);
}

std::string play(const Kind& kind, std::uint64_t seed, Figures& figures, golden::Digest& logs) {
  const Story story = draw_story(seed, kind.choices);
  const std::string wrong = Run(story, kind, figures).play(logs);
  return wrong.empty() ? "" : to_text(story) + "\n  " + wrong + "\n";
}

}  // namespace

std::string play_one(const Kind& kind, std::uint64_t seed) {
  Figures figures;
  golden::Digest logs;
  return play(kind, seed, figures, logs);
}

std::string play_all(const Kind& kind, std::uint64_t short_runs) {
  constexpr int kMostTold = 20;
  Figures figures;
  golden::Digest logs;
  std::string text;
  int failed = 0;
  const std::uint64_t only = number_in("TANDEM_FAULT_SEED", 0);
  const std::uint64_t runs = only != 0 ? 1 : number_in("TANDEM_FAULT_RUNS", short_runs);
  for (std::uint64_t i = 1; i <= runs; ++i) {
    const std::string wrong = play(kind, only != 0 ? only : i, figures, logs);
    if (wrong.empty()) continue;
    if (++failed <= kMostTold) text += wrong;
  }
  std::printf("%llu runs, %d failed; driving within %s of the last fault, at rest within %s of being reachable\n",
              static_cast<unsigned long long>(runs), failed, seconds(figures.back_ns).c_str(),
              seconds(figures.rest_ns).c_str());
  if (only == 0 && runs == short_runs) golden::expect("fault_stories.txt", kind.name, logs.text());
  return text;
}

}  // namespace tandem::faults
