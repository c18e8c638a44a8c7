// First motion of one real robot before a run.
#include <algorithm>
#include <cmath>

#include "mixed_reality/session/mixed_session.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr double kWheel_m_s = 0.03;                        // slow enough for anybody who stands beside it
constexpr double kGetUnderWay_s = 2.0;                     // to settle, as the safety table asks
constexpr hal::TimeNs kLookEvery_ns = 10 * hal::kNsPerMs;  // for an emergency stop

}  // namespace

hal::Status MixedSession::turn(std::string_view robot, double turn_rad, const std::atomic<bool>& stop) {
  const auto chosen = real_robots(robot);
  if (!chosen.ok()) return chosen.error();
  if (robot == "*") return hal::Error{"one robot at a time is turned: name it"};
  if (phase_ != RunPhase::Waiting)
    return hal::Error{"the run has begun: first motion is tried before, while it is held (--hold)"};
  Twin& turned = *twins_[chosen.value().front()];
  const hal::DifferentialDrive* const drive = world_->space().kind(turned.robot()).drive();
  if (drive == nullptr) return hal::Error{"robot '" + turned.id() + "' has no wheels"};
  if (const hal::Status started = start_bridges(); !started.ok()) return started;
  stopped_ = false;
  const double sign = turn_rad < 0.0 ? -1.0 : 1.0;
  hal::WheelSpeeds on_the_spot;
  on_the_spot.left_m_s = -sign * kWheel_m_s;
  on_the_spot.right_m_s = sign * kWheel_m_s;
  const double turn_s = std::abs(turn_rad) * drive->wheel_base_m / (2.0 * kWheel_m_s);
  const hal::TimeNs tick_ns = hal::time_of_tick(1, world_->ticks_per_second());
  const hal::TimeNs began_ns = time_.now_ns();
  double turned_s = 0.0;
  hal::Status result;
  while (turned_s < turn_s) {
    now_ = {time_.now_ns() - began_ns, time_.now_ns()};
    obey_emergency_stop();
    trackers_.latch(now_);
    for (const auto& twin : twins_) {
      const bool this_one = twin.get() == &turned;
      twin->real_robot().set_guarded(!options_.guarded || options_.guarded());
      twin->latch(now_, this_one ? RunPhase::Running : RunPhase::Waiting);
      if (this_one) twin->steer(on_the_spot);
    }
    send_commands();
    if (stop.load(std::memory_order_relaxed)) result = hal::Error{"interrupted"};
    if (turned.verdict().may_drive) {
      turned_s += hal::to_seconds(tick_ns);
    } else if (turned_s > 0.0 || hal::to_seconds(now_.run_ns) > kGetUnderWay_s) {
      result = hal::Error{"it may not drive: " + turned.real_robot().reason()};
    }
    if (!result.ok()) break;
    const hal::TimeNs next_ns = now_.monotonic_ns + tick_ns;
    while (time_.now_ns() < next_ns && !stop.load(std::memory_order_relaxed)) {
      time_.sleep_until(std::min(next_ns, time_.now_ns() + kLookEvery_ns), stop);
      obey_emergency_stop();
    }
  }
  turned.steer(std::nullopt);
  now_ = {time_.now_ns() - began_ns, time_.now_ns()};
  for (const auto& twin : twins_) {  // stands
    twin->latch(now_, RunPhase::Waiting);
    twin->after_filter(now_);
  }
  note_states();
  return result;
}

}  // namespace tandem::mixed_reality
