#include "bridges/epuck/session.hpp"

#include <algorithm>
#include <limits>

#include "bridges/epuck/conversions.hpp"

namespace tandem::bridges::epuck {
namespace {

using hal::TimeNs;

constexpr TimeNs kNever = std::numeric_limits<TimeNs>::max();

// Zeros behind "set speeds": however many of its own four bytes are lost, what follows is not taken for speeds.
constexpr std::size_t kBehindSpeeds = 8;
constexpr std::size_t kBehindLamps = 2;
constexpr std::size_t kVersionBytes = 100;  // of both lines
constexpr TimeNs kMostAllowed = 500 * hal::kNsPerMs;

void append_zeros(Packet& packet, std::size_t n) noexcept {
  for (std::size_t i = 0; i < n; ++i) packet.append({0});
}

bool known_probe_size(Quantity quantity, std::size_t size) noexcept {
  if (quantity == Quantity::Battery) return size == 0 || size == 2;
  return size == 0 || size == 6 || size == 8 || size == 10;
}

bool same_lamps(const Actuation& a, const Actuation& b) noexcept {
  return a.ring == b.ring && a.body == b.body && a.front == b.front;
}

}  // namespace

Session::Session(const SessionTiming& timing) noexcept
    : Conversation(timing), stop_(StopTiming{.quiet_ns = timing.quiet_ns, .answer_ns = timing.answer_ns}) {}

// --- link ---

void Session::link_up(TimeNs now) noexcept {
  if (phase_ != Phase::Down) return;
  if (state_ == SessionState::Absent) state_ = SessionState::Handshake;
  identity_known_ = layout_known_ = false;  // another robot may be at this port now
  samples_.ground = samples_.gyro = {};
  at_rest_ = false;
  attempts_ = 0;
  begin_handshake(now);
}

void Session::link_down(TimeNs) noexcept {
  if (!lose_link("the link hung up")) return;
  phase_ = Phase::Down;
  pending_ = false;
}

void Session::stalled(TimeNs duration) noexcept {
  const TimeNs by = std::clamp<TimeNs>(duration, 0, kMostAllowed - allowed_ns_);
  allowed_ns_ += by;
  if (phase_ == Phase::Stop)
    stop_.extend(by);
  else if (phase_ != Phase::Rest && phase_ != Phase::Idle && phase_ != Phase::Down)
    deadline_ns_ += by;
}

// --- stop and handshake ---

void Session::begin_handshake(TimeNs now) noexcept {
  ++statistics_.handshakes;
  handshaking_ = true;
  pending_ = false;
  pending_quantities_ = {};
  wanted_.left = wanted_.right = {};
  version_asks_ = 0;
  asked_again_ = told_again_ = false;
  begin_stop(now);
}

void Session::begin_stop(TimeNs now) noexcept {
  at_rest_ = false;      // a doubled or flipped byte of it may move the robot, until its last words come
  lamps_known_ = false;  // S puts the ring out as well
  speeds_due_ = false;
  failed_rounds_ = 0;
  allowed_ns_ = 0;
  phase_ = Phase::Stop;
  stop_.begin(now, 2 * latency_ns_);
  go_on_stopping(now);
}

void Session::go_on_stopping(TimeNs now) noexcept {
  stop_.poll(now, output_);
  for (; failed_rounds_ < stop_.failed_rounds(); ++failed_rounds_) {
    allowed_ns_ = 0;
    ++statistics_.handshake_failures;
    if (!handshaking_) {  // so the robot has lost step, not only been stopped
      handshaking_ = true;
      ++statistics_.handshakes;
      state_ = SessionState::Suspect;
      trouble_ = "a stop was not confirmed";
    }
    count_attempt();
  }
}

void Session::on_rest(TimeNs now) noexcept {
  note_rest();
  rest_doubted_ = false;
  sent_.left = sent_.right = {};
  speeds_before_ = {};
  if (ending_ || resting_) {
    phase_ = Phase::Rest;
    deadline_ns_ = ending_ ? kNever : now + timing_.retry_ns;
    resting_ = false;
  } else if (!handshaking_) {
    phase_ = Phase::Idle;
  } else if (identity_known_) {
    introduced(now);
  } else {
    ask_version(now);
  }
}

void Session::attempt_failed(TimeNs now) noexcept {
  ++statistics_.handshake_failures;
  count_attempt();
  begin_handshake(now);
}

void Session::count_attempt() noexcept {
  if (++attempts_ < timing_.tries) return;
  state_ = SessionState::Lost;
  identity_known_ = layout_known_ = false;  // whoever answers next is asked who it is
  if (*trouble_ == '\0') trouble_ = "no e-puck answers";
}

void Session::ask_version(TimeNs now) noexcept {
  ++version_asks_;
  lines_.clear();
  output_.clear();
  output_.append({'V', '\r'});  // after CR LF the firmware would take the next byte for one of a line
  phase_ = Phase::Version;
  allowed_ns_ = 0;
  deadline_ns_ = now + timing_.answer_ns + transfer_ns(kVersionBytes);
}

void Session::introduced(TimeNs now) noexcept {
  if (layout_known_)
    finish_handshake();
  else
    send_probe(Phase::ProbeBattery, Quantity::Battery, now);
}

void Session::send_probe(Phase phase, Quantity quantity, TimeNs now) noexcept {
  // The robot's commanded speeds are 0, so E answers four zeros: they show that this is the answer, and where it ends.
  append_query(output_, quantity);
  append_query(output_, Quantity::CommandedSpeeds);
  append_end(output_);
  append_end(output_);
  phase_ = phase;
  answer_size_ = 0;
  allowed_ns_ = 0;
  deadline_ns_ = now + timing_.answer_ns + timing_.gap_ns;
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
  layout_.microphone_bytes = identity_.is_epuck2() ? 8 : 6;
  layout_.time_of_flight_bytes = identity_.is_epuck2() ? 2 : 0;
  layout_.selector_bytes = identity_.is_epuck2() ? kAllSensorsSize : 0;
  layout_known_ = true;
  finish_handshake();
}

void Session::finish_handshake() noexcept {
  note_handshake();
  phase_ = Phase::Idle;
  attempts_ = 0;
  pending_ = true;  // the first exchange makes it active
  pending_quantities_ = wanted_quantities_;
}

void Session::lose_step(const char* why, TimeNs now) noexcept {
  state_ = SessionState::Suspect;
  trouble_ = why;
  attempts_ = 0;
  if (++odd_answers_ >= 2) identity_known_ = layout_known_ = false;
  if (odd_answers_ > timing_.tries) {
    // It shakes hands well and then answers oddly, again and again: no hammering.
    state_ = SessionState::Lost;
    resting_ = true;
  }
  begin_handshake(now);
}

// --- bytes in ---

void Session::on_bytes(std::span<const std::uint8_t> bytes, TimeNs at) noexcept {
  for (const std::uint8_t byte : bytes) on_byte(byte, at);
  // Only now: bytes that follow an answer at once cannot be the answer to what is sent here.
  if (phase_ == Phase::Idle) send_pending(at);
  if (phase_ == Phase::Stop) go_on_stopping(at);
}

void Session::on_byte(std::uint8_t byte, TimeNs at) noexcept {
  if (phase_ == Phase::Down) return;
  if (greeting_.push(byte)) {
    on_greeting(at);
    return;
  }
  switch (phase_) {
    case Phase::Stop:
      stop_.on_byte(byte, at);
      if (stop_.confirmed()) on_rest(at);
      break;
    case Phase::Hardware:
      deadline_ns_ = std::max(deadline_ns_, at + timing_.gap_ns);
      [[fallthrough]];
    case Phase::Version:
      if (lines_.push(byte)) on_line(lines_.line(), at);
      statistics_.cut_lines = lines_.cut_lines();
      break;
    case Phase::ProbeBattery:
    case Phase::ProbeGround:
      on_probe_byte(byte, at);
      break;
    case Phase::Answer:
      on_answer_byte(byte, at);
      break;
    case Phase::Again:
      deadline_ns_ = std::min(std::max(deadline_ns_, at + timing_.quiet_ns), given_up_ns_);
      on_answer_byte(byte, at);
      break;
    case Phase::Idle:
      ++statistics_.unasked_bytes;
      lose_step("bytes came that were not asked for", at);
      break;
    case Phase::Rest:
    case Phase::Down:
      break;
  }
}

void Session::on_greeting(TimeNs at) noexcept {
  restarted_ = true;
  identity_known_ = layout_known_ = false;
  attempts_ = 0;
  if (epoch_ > 0) {
    ++statistics_.restarts;
    trouble_ = "the robot was restarted";
    state_ = SessionState::Handshake;
  }
  begin_handshake(at);
}

void Session::on_line(std::string_view line, TimeNs at) noexcept {
  if (line.starts_with("z,")) ++statistics_.not_understood;
  if (phase_ == Phase::Hardware) {
    if (parse_hardware(line, identity_.hardware)) on_version(at);
    return;
  }
  Identity heard;
  if (!parse_version(line, heard)) return;  // greeting, rests of older answers
  const bool clean = is_known_version(heard.version_text());
  if (!clean) ++statistics_.odd_versions;
  // What no known firmware says is believed when it is said twice alike, and in the end anyhow.
  const bool twice = version_asks_ > 1 && heard.version_text() == identity_.version_text();
  identity_ = heard;
  identity_known_ = clean || twice || version_asks_ >= timing_.tries;
  phase_ = Phase::Hardware;
  deadline_ns_ = at + timing_.gap_ns;
}

// Both lines have come, or the second does not.
void Session::on_version(TimeNs at) noexcept {
  if (!identity_known_) {
    ask_version(at);
    return;
  }
  samples_.accelerometer.reset(identity_.firmware);
  introduced(at);
}

// --- time-outs ---

TimeNs Session::next_deadline() const noexcept {
  if (phase_ == Phase::Stop) return stop_.next_deadline();
  if (phase_ == Phase::Answer) return answer_deadline();
  return phase_ == Phase::Down || phase_ == Phase::Idle ? kNever : deadline_ns_;
}

void Session::poll(TimeNs now) noexcept {
  if (phase_ == Phase::Idle) send_pending(now);
  if (now < next_deadline()) return;
  switch (phase_) {
    case Phase::Stop:
      go_on_stopping(now);
      break;
    case Phase::Version:
      if (version_asks_ < timing_.tries)
        ask_version(now);
      else
        attempt_failed(now);
      break;
    case Phase::Hardware:
      on_version(now);
      break;
    case Phase::ProbeBattery:
    case Phase::ProbeGround:
      finish_probe(now);
      break;
    case Phase::Rest:
      attempts_ = timing_.tries;
      begin_handshake(now);
      break;
    case Phase::Answer:
      judge_answers(now);
      break;
    case Phase::Again:
      speeds_due_ = true;
      pending_ = true;
      pending_quantities_.add(question_.asked);
      send_pending(now);
      break;
    case Phase::Idle:
    case Phase::Down:
      break;
  }
}

void Session::begin_again(TimeNs now) noexcept {
  asked_again_ = true;
  ++statistics_.asked_again;
  append_zeros(output_, kBehindSpeeds);  // end what may be half-received
  phase_ = Phase::Again;
  deadline_ns_ = now + timing_.quiet_ns;
  given_up_ns_ = now + 10 * timing_.quiet_ns;
}

TimeNs Session::expected_round_trip(QuantitySet quantities) const noexcept {
  quantities.add({Quantity::Encoders, Quantity::CommandedSpeeds});
  constexpr std::size_t kQuestion = kQuantityCount + 2;  // and fewer bytes where less is asked
  return transfer_ns(kQuestion + answer_size(quantities, layout_)) + 2 * latency_ns_;
}

// --- bytes out ---

void Session::command(const Actuation& actuation, TimeNs now) noexcept {
  keep(actuation);
  if (!talking()) return;
  const bool due = !lamps_known_ || now - refreshed_ns_ >= timing_.refresh_ns;
  if (!wants_other_speeds() && !due && same_lamps(wanted_, sent_)) return;
  pending_ = true;
  if (phase_ == Phase::Idle) send_pending(now);
}

void Session::ask(QuantitySet quantities, TimeNs now) noexcept {
  wanted_quantities_ = quantities;
  wanted_quantities_.add(Quantity::Encoders);
  if (!talking()) return;
  if (!pending_quantities_.empty() && phase_ != Phase::Idle) ++statistics_.replaced;
  pending_quantities_.add(wanted_quantities_);
  pending_ = true;
  if (phase_ == Phase::Idle) send_pending(now);
}

void Session::send_pending(TimeNs now) noexcept {
  if (!pending_) return;
  pending_ = false;
  if (state_ == SessionState::Active) odd_answers_ = 0;  // nothing followed the last answer that should not have
  output_.clear();
  append_lamps(now);
  append_wheels();
  if (at_rest_ && !output_.empty()) {
    // A single wrong bit makes "light a lamp" a "set speeds", or another speed of 0: the answer tells whether it did.
    at_rest_ = false;
    rest_doubted_ = true;
  }
  append_question(now);
  ++statistics_.packets;
}

void Session::append_question(TimeNs now) noexcept {
  earlier_awaited_ = phase_ == Phase::Again;
  if (earlier_awaited_) earlier_ = question_;
  earlier_size_ = earlier_awaited_ ? answer_size_ : 0;
  answer_size_ = earlier_size_;
  heard_ns_ = 0;
  question_.asked = pending_quantities_;
  question_.asked.add(Quantity::CommandedSpeeds);
  pending_quantities_ = {};
  const std::size_t size = answer_size(question_.asked, layout_);
  question_.marked = earlier_awaited_ && earlier_.answer_size - earlier_size_ != size + kSpeedsSize;
  question_.answer_size = size + (question_.marked ? kSpeedsSize : 0);
  if (question_.marked) append_query(output_, Quantity::CommandedSpeeds);
  append_queries(output_, question_.asked, layout_);
  append_end(output_);
  append_end(output_);  // one of them may be lost
  if (layout_.battery_bytes == 0) question_.asked.remove(Quantity::Battery);
  if (layout_.ground_bytes == 0) question_.asked.remove(Quantity::Ground);
  if (layout_.gyro_bytes == 0) question_.asked.remove(Quantity::Gyro);
  if (layout_.time_of_flight_bytes == 0) question_.asked.remove(Quantity::TimeOfFlight);
  if (layout_.selector_bytes == 0) question_.asked.remove(Quantity::Selector);
  question_.question_size = output_.size();
  question_.told = {sent_.left, sent_.right};
  question_.asked_ns = now;
  allowed_ns_ = 0;
  deadline_ns_ = now + timing_.answer_ns + transfer_ns(question_.question_size + question_.answer_size) +
                 (asked_again_ ? patience_ns_ : 0);
  phase_ = Phase::Answer;
}

void Session::append_wheels() noexcept {
  const bool other = wants_other_speeds();
  // Each speed setting switches the motor phases off for an instant: only on change.
  if (!other && !speeds_due_) return;
  append_speeds(output_, wanted_.left, wanted_.right);
  append_zeros(output_, kBehindSpeeds);
  if (other) speeds_before_ = {sent_.left, sent_.right};
  sent_.left = wanted_.left;
  sent_.right = wanted_.right;
  speeds_due_ = false;
  if (sent_.left.value != 0 || sent_.right.value != 0) at_rest_ = false;
}

void Session::append_lamps(TimeNs now) noexcept {
  const bool all = !lamps_known_ || now - refreshed_ns_ >= timing_.refresh_ns;
  const auto led = [&](std::uint8_t index, bool on, bool was_on) {
    if (all || on != was_on) append_led(output_, index, on ? LedAction::On : LedAction::Off);
  };
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
  if (!output_.empty()) append_zeros(output_, kBehindLamps);
  if (all) refreshed_ns_ = now;
  sent_.ring = wanted_.ring;
  sent_.body = wanted_.body;
  sent_.front = wanted_.front;
  lamps_known_ = true;
}

void Session::say_stop(TimeNs now) noexcept {
  pending_ = false;
  pending_quantities_ = {};
  if (phase_ != Phase::Stop) begin_stop(now);
}

}  // namespace tandem::bridges::epuck
