#include "tests/scenarios/identities/identity_story.hpp"

#include <algorithm>
#include <cstdlib>

namespace tandem::identities {
namespace {

using mixed_reality::RearmBy;
using mixed_reality::RearmPolicy;

constexpr TimeNs kStart = 6 * kSecond;    // within which it drives at first
constexpr TimeNs kSettled = 5 * kSecond;  // within which it is found again after its return
constexpr TimeNs kNoticed = 250 * kMs;    // within which its return is
constexpr TimeNs kWatched = 4 * kSecond;  // for which it must not move by itself

/// Switched off and on; another robot in its place; the same on another device; a radio that does not pass for a while;
/// a part of the robot off and on, while the rest of it goes on; a robot that hears nothing for a while, and speaks.
enum class What : std::uint8_t { SwitchedOff, Exchanged, Renumbered, Silent, PartOff, Deaf };

struct Event {
  What what;
  TimeNs away_ns;
  bool hangs_up;  // the link notices
  /// Whether a person must arm the robot afterwards.
  bool needs_a_person() const {
    return (what != What::Silent && what != What::Deaf) || hangs_up || away_ns > 2 * kSecond;
  }
};

class Story {
 public:
  Story(const MakeRig& make, std::uint64_t seed) : chance_(seed), rig_(make(seed)), hub_(*rig_.hub) {
    constexpr std::array<RearmPolicy, 3> kPolicies = {
        {{RearmBy::Proved, 0.0}, {RearmBy::Time, 0.5}, {RearmBy::Operator, 0.0}}};
    policy_ = kPolicies[chance_() % kPolicies.size()];
    steady_ = chance_() % 2 == 0;
    mixed_reality::RealRobotParams params;
    params.rearm.policy = policy_;
    robot_ = std::make_unique<mixed_reality::LoneRobot>("r", std::move(rig_.bridge), params, kTick, hal::Log());
  }

  std::string play() {
    hub_.open("port 0", now_);
    hub_.lead_to(0, now_);
    phase_ = mixed_reality::RunPhase::Joining;
    until(kStart, [this] { return robot_->real().verdict().may_drive; });
    phase_ = mixed_reality::RunPhase::Running;
    if (!until(2 * kSecond, [this] { return moves(); })) fail("it did not drive at first");
    for (int i = 0; i < 3 && wrong_.empty(); ++i) happen(draw());
    return wrong_;
  }

 private:
  Event draw() {
    const auto shortly = static_cast<TimeNs>(5 + chance_() % 1695) * kMs;
    const std::array<TimeNs, 6> away = {shortly, 300 * kMs, 1200 * kMs, 3 * kSecond, 15 * kSecond, 60 * kSecond};
    std::vector<What> possible = {What::SwitchedOff, What::Exchanged, What::Renumbered, What::Silent};
    if (rig_.bodies[here_]->parts() > 0) possible.push_back(What::PartOff);
    if (hub_.deafen(false)) possible.push_back(What::Deaf);
    Event event{possible[chance_() % possible.size()], away[chance_() % away.size()], chance_() % 2 == 0};
    // Nobody exchanges robots within 2 s; where no link hangs up and both are of one firmware, nothing would tell it.
    if (event.what == What::Exchanged) event.away_ns = std::max(event.away_ns, 3 * kSecond);
    if (event.what == What::PartOff || event.what == What::Deaf) event.hangs_up = false;
    return event;
  }

  void happen(const Event& event) {
    constexpr std::array<const char*, 6> kTold = {"off", "exchanged", "renumbered", "silent", "part off", "deaf"};
    told_ += std::string(kTold[static_cast<std::size_t>(event.what)]) + (event.hangs_up ? ", hangs up " : " ") +
             std::to_string(event.away_ns / kMs) + " ms; ";
    if (event.what == What::PartOff) return fail_part(event);
    if (event.what == What::Deaf) return deafen(event);
    const bool gone = event.hangs_up || event.what == What::Renumbered;
    gone ? hub_.hang_up(now_) : hub_.lead_to(-1, now_);
    if (event.what == What::SwitchedOff) on_[here_] = false;
    if (event.what == What::Exchanged) on_[here_] = chance_() % 2 == 0;  // or it is carried away as it is
    run(event.away_ns);
    if (event.what == What::Exchanged) here_ = 1 - here_;
    on_[here_] = true;
    if (event.what == What::Renumbered) device_ = 1 - device_;
    if (gone) hub_.open("port " + std::to_string(device_), now_);
    hub_.lead_to(static_cast<int>(here_), now_);
    run(kNoticed);
    // It drives on as it was told last until it is told otherwise; from its first rest on it stands.
    until(kSettled, [this] { return !moves(); });
    if (!event.needs_a_person()) return goes_on(event);
    stands_until_a_person();
  }

  void fail_part(const Event& event) {
    Body& body = *rig_.bodies[here_];
    part_off_ = static_cast<int>(chance_() % static_cast<std::uint64_t>(body.parts()));
    run(event.away_ns);
    part_off_ = kNoPart;
    run(kNoticed);
    until(kSettled, [this] { return !moves(); });
    stands_until_a_person();
  }

  void deafen(const Event& event) {
    (void)hub_.deafen(true);
    run(event.away_ns);
    (void)hub_.deafen(false);
    run(kNoticed);
    until(kSettled, [this] { return !moves(); });
    event.needs_a_person() ? stands_until_a_person() : goes_on(event);
  }

  void goes_on(const Event& event) {
    if (policy_.by == RearmBy::Operator || event.away_ns > kSecond) {  // found again perhaps after 2 s
      until(kSettled, [this] { return moves() || robot_->real().awaits_rearm(); });
      robot_->real().rearm();
    }
    if (!until(kSettled, [this] { return moves(); })) fail("proved, it does not go on: " + robot_->reason());
  }

  void stands_until_a_person() {
    if (until(kWatched, [this] { return moves(); })) return fail("it moves, and nobody has armed it");
    robot_->real().rearm_if_proved();
    if (until(kSecond, [this] { return moves(); })) return fail("armed with all that are proved");
    if (!until(kSettled, [this] { return robot_->real().awaits_rearm(); })) return fail("it waits for nobody");
    if (!robot_->real().unproved()) return fail("it counts as proved");
    robot_->real().rearm();
    if (!until(kSettled, [this] { return moves(); })) fail("re-armed by its name, it stands: " + robot_->reason());
  }

  bool moves() const { return on_[here_] && rig_.bodies[here_]->moves(); }
  void fail(const std::string& what) {
    if (wrong_.empty())
      wrong_ = what + " at " + std::to_string(now_ / kMs) + " ms, rearm=\"" + to_text(policy_) + "\", " + told_ +
               robot_->reason();
  }

  void run(TimeNs duration) {
    until(duration, [] { return false; });
  }
  template <class Done>
  bool until(TimeNs duration, Done&& done) {
    for (const TimeNs end = now_ + duration; now_ < end && wrong_.empty();) {
      now_ += kMs;
      for (std::size_t i = 0; i < 2; ++i) rig_.bodies[i]->live(now_, on_[i], i == here_ ? part_off_ : kNoPart);
      hub_.pump(now_);
      if (now_ >= next_tick_) tick();
      if (done()) return true;
    }
    return false;
  }
  /// Its controller wants to drive all the time.
  void tick() {
    next_tick_ = now_ + kTick;
    (void)robot_->latch(++tick_, now_, phase_);
    rig_.drive(speed_m_s());
    robot_->commit(now_);
  }

  double speed_m_s() const { return steady_ ? 0.05 : 0.04 + 0.001 * static_cast<double>(tick_ % 20); }

  std::mt19937_64 chance_;
  Rig rig_;
  HubSide& hub_;
  RearmPolicy policy_;
  bool steady_ = true;  // what its controller asks for
  std::unique_ptr<mixed_reality::LoneRobot> robot_;
  mixed_reality::RunPhase phase_ = mixed_reality::RunPhase::Joining;
  std::array<bool, 2> on_ = {true, true};
  std::size_t here_ = 0;  // the robot at the hub's link
  int part_off_ = kNoPart;
  int device_ = 0;
  TimeNs now_ = kSecond, next_tick_ = 0;
  hal::Tick tick_ = 0;
  std::string told_, wrong_;
};

}  // namespace

std::string play_all(const MakeRig& make, std::uint64_t usual) {
  const char* const wanted = std::getenv("TANDEM_IDENTITY_RUNS");
  const std::uint64_t runs = wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : usual;
  std::string all;
  int told = 0;
  for (std::uint64_t seed = getenv("SEED") ? strtoull(getenv("SEED"), 0, 10) : 1; seed <= runs && told < 10; ++seed) {
    const std::string wrong = Story(make, seed).play();
    if (wrong.empty()) continue;
    ++told;
    all += "seed " + std::to_string(seed) + ": " + wrong + "\n";
  }
  return all;
}

}  // namespace tandem::identities
