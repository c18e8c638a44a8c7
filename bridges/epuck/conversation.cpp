#include "bridges/epuck/conversation.hpp"

#include <algorithm>
#include <cstdlib>

#include "bridges/epuck/conversions.hpp"
#include "bridges/epuck/session.hpp"
#include "bridges/epuck/wifi_session.hpp"

namespace tandem::bridges::epuck {
namespace {

using hal::TimeNs;

// No e-puck turns its wheels faster [e-puck2, MOTOR_SPEED_LIMIT].
constexpr double kFastestSteps_s = 1100.0;
// Readings may be this much older or younger than their stamp says.
constexpr double kStampDoubt_s = 0.25;
// Beyond this the 16-bit counters may have gone round once.
constexpr TimeNs kCountersAmbiguous = 25 * hal::kNsPerSecond;

}  // namespace

const char* state_name(SessionState state) noexcept {
  constexpr std::array kNames = {"absent", "handshake", "ready", "active", "suspect", "lost"};
  return kNames[static_cast<std::size_t>(state)];
}

std::unique_ptr<Conversation> make_conversation(WireForm wire, const SessionTiming& timing) {
  if (wire == WireForm::Wifi) return std::make_unique<WifiSession>(timing);
  return std::make_unique<Session>(timing);
}

void Conversation::stop(TimeNs now) noexcept {
  wanted_.left = wanted_.right = {};
  if (is_down() || stop_asked_) return;
  ++statistics_.stops;
  if (at_rest_) {
    ++statistics_.stops_confirmed;
    return;
  }
  stop_asked_ = true;
  say_stop(now);
}

void Conversation::shut_down(TimeNs now) noexcept {
  ending_ = true;
  wanted_.left = wanted_.right = {};
  if (is_down()) return;
  if (!stop_asked_) ++statistics_.stops;
  stop_asked_ = true;
  say_stop(now);
}

void Conversation::note_rest() noexcept {
  at_rest_ = true;
  if (stop_asked_) ++statistics_.stops_confirmed;
  stop_asked_ = false;
}

void Conversation::note_handshake() noexcept {
  if (state_ == SessionState::Suspect || state_ == SessionState::Lost) ++statistics_.resynchronised;
  state_ = SessionState::Ready;
  handshaking_ = false;
  ++epoch_;
  counters_doubtful_ = true;
}

bool Conversation::lose_link(const char* why) noexcept {
  if (is_down()) return false;
  state_ = SessionState::Lost;
  trouble_ = why;
  ++statistics_.links_lost;
  output_.clear();
  return true;
}

void Conversation::take_samples(QuantitySet asked, const RawSensors& raw, const Measured& when) noexcept {
  const bool stands =
      asked.has(Quantity::Encoders) && counters_known_ && at_rest_ && raw.encoders == samples_.raw.encoders;
  if (stands && asked.has(Quantity::Acceleration)) samples_.accelerometer.at_rest(raw.acceleration);
  if (asked.has(Quantity::Encoders)) take_encoders(raw.encoders, when);
  const auto zero = [](const auto& values) { return std::ranges::all_of(values, [](auto v) { return v == 0; }); };
  if (asked.has(Quantity::Ground)) samples_.ground.note(zero(raw.ground) && zero(raw.cliff));
  if (asked.has(Quantity::Gyro)) samples_.gyro.note(zero(raw.gyro) && !identity_.is_epuck2());
  samples_.raw = raw;
  samples_.known.add(asked);
  for (std::size_t i = 0; i < kQuantityCount; ++i) {
    if (asked.has(static_cast<Quantity>(i))) samples_.taken_ns[i] = when.taken_ns;
  }
}

bool Conversation::encoders_plausible(const std::array<std::int16_t, 2>& counters, TimeNs latest) const noexcept {
  const TimeNs since = latest - samples_.taken_ns[static_cast<std::size_t>(Quantity::Encoders)];
  if (since > kCountersAmbiguous) return false;
  const double most = kFastestSteps_s * (hal::to_seconds(since) + kStampDoubt_s);
  return std::abs(encoder_difference(counters[0], samples_.raw.encoders[0])) <= most &&
         std::abs(encoder_difference(counters[1], samples_.raw.encoders[1])) <= most;
}

void Conversation::take_encoders(const std::array<std::int16_t, 2>& counters, const Measured& when) noexcept {
  // Over the longest time that it may have been: where stamps are in doubt a wheel is not faster than it was.
  const TimeNs since = when.latest_ns - samples_.taken_ns[static_cast<std::size_t>(Quantity::Encoders)];
  const double since_s = hal::to_seconds(since);
  const bool continues = counters_known_ && !restarted_ && encoders_plausible(counters, when.latest_ns);
  if (counters_known_ && !continues) ++statistics_.encoder_rebased;
  // A greeting may be lost: counters tell the restart as well, or that another robot answers.
  const bool anew = counters == std::array<std::int16_t, 2>{} || since <= kCountersAmbiguous;
  if (counters_known_ && !continues && !restarted_ && anew) ++statistics_.restarts;
  const std::int32_t left = continues ? encoder_difference(counters[0], samples_.raw.encoders[0]) : 0;
  const std::int32_t right = continues ? encoder_difference(counters[1], samples_.raw.encoders[1]) : 0;
  samples_.left_steps += left;
  samples_.right_steps += right;
  samples_.left_steps_per_s = since_s > 0.0 ? left / since_s : 0.0;
  samples_.right_steps_per_s = since_s > 0.0 ? right / since_s : 0.0;
  counters_known_ = true;
  counters_doubtful_ = false;
  restarted_ = false;
}

}  // namespace tandem::bridges::epuck
