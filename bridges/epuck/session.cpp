#include "bridges/epuck/session.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "bridges/epuck/conversions.hpp"

namespace tandem::bridges::epuck {
namespace {

using hal::TimeNs;

constexpr TimeNs kNever = std::numeric_limits<TimeNs>::max();
constexpr TimeNs kByteNs = 86'806;       // 10 bits at 115200 baud
constexpr std::size_t kSpeedsSize = 4;   // answer of E
constexpr std::size_t kFlushZeros = 40;  // the longest payload of a binary command has 35 bytes

// No e-puck turns its wheels faster [e-puck2, MOTOR_SPEED_LIMIT].
constexpr double kFastestSteps_s = 1100.0;
// Readings may be this much older or younger than their arrival says.
constexpr double kStampDoubt_s = 0.25;
// Beyond this the 16-bit counters may have gone round once.
constexpr TimeNs kCountersAmbiguous = 25 * hal::kNsPerSecond;

void append_zeros(Packet& packet, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) packet.append({0});
}

void append_stop(Packet& packet) noexcept {
  append_speeds(packet, {}, {});
  append_end(packet);
  append_line(packet, 'S');
}

bool known_probe_size(Quantity quantity, std::size_t size) noexcept {
  if (quantity == Quantity::Battery) return size == 0 || size == 2;
  return size == 0 || size == 6 || size == 8 || size == 10;
}

}  // namespace

const char* state_name(SessionState state) noexcept {
  switch (state) {
    case SessionState::Absent:
      return "absent";
    case SessionState::Handshake:
      return "handshake";
    case SessionState::Ready:
      return "ready";
    case SessionState::Active:
      return "active";
    case SessionState::Suspect:
      return "suspect";
    case SessionState::Lost:
      return "lost";
  }
  return "";
}

// --- link ---

void Session::link_up(TimeNs now) noexcept {
  if (phase_ != Phase::Down) return;
  if (state_ == SessionState::Absent) state_ = SessionState::Handshake;
  layout_known_ = false;  // another robot may be at this port now
  attempts_ = 1;
  begin_handshake(now, true);
}

void Session::link_down(TimeNs) noexcept {
  if (phase_ == Phase::Down) return;
  phase_ = Phase::Down;
  state_ = SessionState::Lost;
  trouble_ = "the link hung up";
  ++statistics_.links_lost;
  output_.clear();
  pending_ = false;
}

// --- handshake ---

void Session::begin_handshake(TimeNs now, bool quick) noexcept {
  ++statistics_.handshakes;
  handshaking_ = true;
  stop_line_due_ = false;
  pending_ = false;
  wanted_.left = wanted_.right = {};
  lines_.clear();
  output_.clear();
  append_zeros(output_, kFlushZeros);
  append_speeds(output_, {}, {});  // a robot that hears but is not heard stops as well
  append_end(output_);
  output_.append({'\r'});
  if (quick) {
    ask_version();
    deadline_ns_ = now + 2 * timing_.answer_ns + 150 * kByteNs;
  } else {
    phase_ = Phase::Drain;
    deadline_ns_ = now + timing_.drain_ns;
  }
}

void Session::ask_version() noexcept {
  append_line(output_, 'V');
  append_line(output_, 'S');
  phase_ = Phase::Version;
}

void Session::attempt_failed(TimeNs now) noexcept {
  ++statistics_.handshake_failures;
  if (attempts_ < timing_.tries) {
    ++attempts_;
    begin_handshake(now, false);
    return;
  }
  if (*trouble_ == '\0') trouble_ = "no e-puck answers";
  rest(now);
}

void Session::rest(TimeNs now) noexcept {
  state_ = SessionState::Lost;
  phase_ = Phase::Rest;
  handshaking_ = false;
  pending_ = false;
  wanted_.left = wanted_.right = {};
  say_stop_blindly();
  deadline_ns_ = now + timing_.retry_ns;
}

void Session::send_probe(Phase phase, Quantity quantity, TimeNs now) noexcept {
  // Speeds 0 first, so that E answers four zeros: they show that this is the answer, and where it ends.
  append_speeds(output_, {}, {});
  append_query(output_, quantity);
  append_query(output_, Quantity::CommandedSpeeds);
  append_end(output_);
  phase_ = phase;
  answer_size_ = 0;
  deadline_ns_ = now + timing_.answer_ns + timing_.gap_ns + 32 * kByteNs;
}

void Session::on_probe_byte(std::uint8_t byte, TimeNs at) noexcept {
  const std::size_t longest = kSpeedsSize + (phase_ == Phase::ProbeBattery ? 2 : 10);
  answer_[answer_size_++] = byte;
  deadline_ns_ = answer_size_ < kSpeedsSize ? std::max(deadline_ns_, at + timing_.gap_ns) : at + timing_.gap_ns;
  if (answer_size_ == longest) finish_probe(at);
}

void Session::finish_probe(TimeNs now) noexcept {
  const bool battery = phase_ == Phase::ProbeBattery;
  const std::size_t size = answer_size_ - std::min(answer_size_, kSpeedsSize);
  const auto tail = std::span(answer_).subspan(size, kSpeedsSize);
  const bool ends_well =
      answer_size_ >= kSpeedsSize && std::all_of(tail.begin(), tail.end(), [](std::uint8_t b) { return b == 0; });
  if (!ends_well || !known_probe_size(battery ? Quantity::Battery : Quantity::Ground, size)) {
    ++statistics_.probe_failures;
    attempt_failed(now);
    return;
  }
  if (battery) {
    layout_.battery_bytes = static_cast<std::uint8_t>(size);
    send_probe(Phase::ProbeGround, Quantity::Ground, now);
    return;
  }
  layout_.ground_bytes = static_cast<std::uint8_t>(size);
  layout_.gyro_bytes = identity_.firmware == Firmware::GCtronic || identity_.is_epuck2() ? 6 : 0;
  layout_known_ = true;
  finish_handshake();
}

void Session::finish_handshake() noexcept {
  if (state_ == SessionState::Suspect || state_ == SessionState::Lost) ++statistics_.resynchronised;
  state_ = SessionState::Ready;
  phase_ = Phase::Idle;
  handshaking_ = false;
  ++epoch_;
  sent_known_ = false;
  counters_doubtful_ = true;
  pending_ = true;  // the first exchange makes it active
}

void Session::lose_step(const char* why, TimeNs now) noexcept {
  state_ = SessionState::Suspect;
  trouble_ = why;
  if (++odd_answers_ >= 2) layout_known_ = false;
  if (odd_answers_ > timing_.tries) {
    // It shakes hands well and then answers oddly, again and again: no hammering.
    rest(now);
    return;
  }
  attempts_ = 1;
  begin_handshake(now, true);
}

// --- bytes in ---

void Session::on_bytes(std::span<const std::uint8_t> bytes, TimeNs at) noexcept {
  for (const std::uint8_t byte : bytes) on_byte(byte, at);
  // Only now: bytes that follow an answer at once cannot be the answer to what is sent here.
  if (phase_ == Phase::Idle) send_pending(at);
}

void Session::on_byte(std::uint8_t byte, TimeNs at) noexcept {
  if (phase_ == Phase::Down) return;
  if (greeting_.push(byte)) {
    on_greeting(at);
    return;
  }
  switch (phase_) {
    case Phase::Version:
    case Phase::StopLine:
      if (lines_.push(byte)) on_line(lines_.line(), at);
      statistics_.cut_lines = lines_.cut_lines();
      break;
    case Phase::ProbeBattery:
    case Phase::ProbeGround:
      on_probe_byte(byte, at);
      break;
    case Phase::Answer:
      answer_[answer_size_++] = byte;
      if (answer_size_ == answer_expected_) on_answer(at);
      break;
    case Phase::Idle:
      ++statistics_.unasked_bytes;
      lose_step("bytes came that were not asked for", at);
      break;
    case Phase::Drain:
    case Phase::Rest:
    case Phase::Down:
      break;
  }
}

void Session::on_greeting(TimeNs at) noexcept {
  restarted_ = true;
  layout_known_ = false;
  if (epoch_ > 0) {
    ++statistics_.restarts;
    trouble_ = "the robot was restarted";
    state_ = SessionState::Handshake;
  }
  attempts_ = 1;
  begin_handshake(at, true);
}

void Session::on_line(std::string_view line, TimeNs at) noexcept {
  if (line.starts_with("z,")) ++statistics_.not_understood;
  if (phase_ == Phase::Version) {
    if (!parse_version(line, identity_)) return;  // greeting, rests of older answers
    phase_ = Phase::StopLine;
    deadline_ns_ = answer_deadline(48, at);
    return;
  }
  if (parse_hardware(line, identity_.hardware) || line != "s") return;
  if (!handshaking_) {
    ++statistics_.stops_confirmed;
    phase_ = Phase::Idle;
  } else if (layout_known_) {
    finish_handshake();
  } else {
    send_probe(Phase::ProbeBattery, Quantity::Battery, at);
  }
}

void Session::on_answer(TimeNs at) noexcept {
  phase_ = stop_line_due_ ? Phase::StopLine : Phase::Idle;
  stop_line_due_ = false;
  RawSensors raw = samples_.raw;
  if (decode_answer(std::span(answer_.data(), answer_size_), asked_, layout_, raw) != Decoded::Ok) {
    ++statistics_.implausible;
    lose_step("an answer held values that cannot be", at);
    return;
  }
  if (!counters_doubtful_ && counters_known_ && !encoders_plausible(raw.encoders, at)) {
    ++statistics_.encoder_jumps;
    lose_step("the wheel counters jumped", at);
    return;
  }
  take_encoders(raw.encoders, at);
  samples_.raw = raw;
  samples_.known.add(asked_);
  for (std::size_t i = 0; i < kQuantityCount; ++i) {
    if (asked_.has(static_cast<Quantity>(i))) samples_.taken_ns[i] = at;
  }
  state_ = SessionState::Active;
  trouble_ = "";
  ++statistics_.answers;
  statistics_.last_round_trip_ns = at - asked_ns_;
  statistics_.max_round_trip_ns = std::max(statistics_.max_round_trip_ns, statistics_.last_round_trip_ns);
  statistics_.sum_round_trip_ns += statistics_.last_round_trip_ns;
}

// --- wheel counters ---

bool Session::encoders_plausible(const std::array<std::int16_t, 2>& counters, TimeNs at) const noexcept {
  const TimeNs since = at - samples_.taken_ns[static_cast<std::size_t>(Quantity::Encoders)];
  if (since > kCountersAmbiguous) return false;
  const double most = kFastestSteps_s * (hal::to_seconds(since) + kStampDoubt_s);
  return std::abs(encoder_difference(counters[0], samples_.raw.encoders[0])) <= most &&
         std::abs(encoder_difference(counters[1], samples_.raw.encoders[1])) <= most;
}

void Session::take_encoders(const std::array<std::int16_t, 2>& counters, TimeNs at) noexcept {
  const double since_s = hal::to_seconds(at - samples_.taken_ns[static_cast<std::size_t>(Quantity::Encoders)]);
  const bool continues = counters_known_ && !restarted_ && encoders_plausible(counters, at);
  if (counters_known_ && !continues) ++statistics_.encoder_rebased;
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

// --- time-outs ---

TimeNs Session::answer_deadline(std::size_t bytes_in, TimeNs now) const noexcept {
  return now + timing_.answer_ns + static_cast<TimeNs>(output_.size() + bytes_in) * kByteNs;
}

TimeNs Session::next_deadline() const noexcept {
  return phase_ == Phase::Down || phase_ == Phase::Idle ? kNever : deadline_ns_;
}

void Session::poll(TimeNs now) noexcept {
  if (phase_ == Phase::Idle) send_pending(now);
  if (now < next_deadline()) return;
  switch (phase_) {
    case Phase::Drain:
      ask_version();
      deadline_ns_ = now + timing_.version_ns;
      break;
    case Phase::ProbeBattery:
    case Phase::ProbeGround:
      finish_probe(now);
      break;
    case Phase::Rest:
      attempts_ = timing_.tries;  // one try, then rest again
      begin_handshake(now, false);
      break;
    case Phase::Answer:
      ++(answer_size_ == 0 ? statistics_.silent : statistics_.cut_short);
      lose_step(answer_size_ == 0 ? "no answer" : "an answer was cut short", now);
      break;
    case Phase::Version:
    case Phase::StopLine:
      if (handshaking_) {
        attempt_failed(now);
      } else {
        ++statistics_.silent;
        lose_step("a stop was not confirmed", now);
      }
      break;
    case Phase::Idle:
    case Phase::Down:
      break;
  }
}

// --- bytes out ---

void Session::request(const Actuation& actuation, QuantitySet quantities, TimeNs now) noexcept {
  const bool talking = state_ == SessionState::Ready || state_ == SessionState::Active;
  wanted_ = actuation;
  if (!talking) wanted_.left = wanted_.right = {};
  wanted_quantities_ = quantities;
  wanted_quantities_.add(Quantity::Encoders);
  if (!talking) return;
  if (pending_ && phase_ != Phase::Idle) ++statistics_.replaced;
  pending_ = true;
  if (phase_ == Phase::Idle) send_pending(now);
}

void Session::send_pending(TimeNs now) noexcept {
  if (!pending_) return;
  pending_ = false;
  if (state_ == SessionState::Active) odd_answers_ = 0;  // nothing followed the last answer that should not have
  output_.clear();
  append_actuation(now);
  append_queries(output_, wanted_quantities_, layout_);
  append_end(output_);
  asked_ = wanted_quantities_;
  if (layout_.battery_bytes == 0) asked_.remove(Quantity::Battery);
  if (layout_.ground_bytes == 0) asked_.remove(Quantity::Ground);
  if (layout_.gyro_bytes == 0) asked_.remove(Quantity::Gyro);
  answer_expected_ = answer_size(asked_, layout_);
  answer_size_ = 0;
  asked_ns_ = now;
  deadline_ns_ = answer_deadline(answer_expected_, now);
  phase_ = Phase::Answer;
  ++statistics_.packets;
}

void Session::append_actuation(TimeNs now) noexcept {
  const bool all = !sent_known_ || now - refreshed_ns_ >= timing_.refresh_ns;
  const auto led = [&](std::uint8_t index, bool on, bool was_on) {
    if (all || on != was_on) append_led(output_, index, on ? LedAction::On : LedAction::Off);
  };
  // Each speed setting switches the motor phases off for an instant: only on change.
  if (all || wanted_.left != sent_.left || wanted_.right != sent_.right)
    append_speeds(output_, wanted_.left, wanted_.right);
  bool rgb_changed = all;
  std::array<std::uint8_t, 12> rgb_percent{};
  for (std::size_t i = 0; i < wanted_.ring.size(); ++i) {
    if (identity_.is_epuck2() && i % 2 == 1) {
      const hal::Rgb c = wanted_.ring[i];
      rgb_changed = rgb_changed || c != sent_.ring[i];
      rgb_percent[3 * (i / 2)] = to_percent(c.r);
      rgb_percent[3 * (i / 2) + 1] = to_percent(c.g);
      rgb_percent[3 * (i / 2) + 2] = to_percent(c.b);
    } else {
      led(static_cast<std::uint8_t>(i), lamp_on(wanted_.ring[i]), lamp_on(sent_.ring[i]));
    }
  }
  if (identity_.is_epuck2() && rgb_changed) append_rgb_leds(output_, rgb_percent);
  led(kBodyLedIndex, wanted_.body, sent_.body);
  led(kFrontLedIndex, wanted_.front, sent_.front);
  if (all) refreshed_ns_ = now;
  sent_ = wanted_;
  sent_known_ = true;
}

void Session::stop(TimeNs now) noexcept {
  wanted_.left = wanted_.right = {};
  pending_ = false;
  sent_known_ = false;  // S puts the ring out as well
  const bool stopping = stop_line_due_ || phase_ == Phase::StopLine;
  if (phase_ == Phase::Down || handshaking_ || stopping) return;  // a handshake stops the robot itself
  ++statistics_.stops;
  if (phase_ == Phase::Rest) {
    say_stop_blindly();
    return;
  }
  lines_.clear();
  append_stop(output_);
  stop_line_due_ = phase_ == Phase::Answer;
  deadline_ns_ = std::max(stop_line_due_ ? deadline_ns_ : 0, answer_deadline(3, now));
  if (!stop_line_due_) phase_ = Phase::StopLine;
}

void Session::farewell(TimeNs now) noexcept {
  stop(now);
  if (!handshaking_) return;
  say_stop_blindly();
  handshaking_ = false;
  state_ = SessionState::Lost;
  phase_ = Phase::Rest;
  deadline_ns_ = kNever;
}

void Session::say_stop_blindly() noexcept {
  output_.clear();
  append_zeros(output_, kFlushZeros);
  append_stop(output_);
}

}  // namespace tandem::bridges::epuck
