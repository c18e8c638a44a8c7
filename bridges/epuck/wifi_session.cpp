#include "bridges/epuck/wifi_session.hpp"

#include <algorithm>
#include <limits>
#include <string_view>

#include "bridges/epuck/conversions.hpp"

namespace tandem::bridges::epuck {
namespace {

using hal::TimeNs;

constexpr TimeNs kNever = std::numeric_limits<TimeNs>::max();
constexpr TimeNs kSayStopAgain = 50 * hal::kNsPerMs;
constexpr TimeNs kSettle = 100 * hal::kNsPerMs;    // what came sooner may have been measured before the stop
constexpr TimeNs kSame = 200 * hal::kNsPerMs;      // that wheels which stand have the same counters
constexpr TimeNs kSilence = 1500 * hal::kNsPerMs;  // then another link is tried
constexpr TimeNs kPace = 5 * hal::kNsPerMs;        // the robot takes 11 ms or more for each
constexpr TimeNs kMostAllowed = 500 * hal::kNsPerMs;
constexpr TimeNs kUsualLatency = 40 * hal::kNsPerMs;  // before any was seen
// Radio and robot talk over a serial line of 115200 baud: the sensors' 103 bytes are so old when the radio has them.
constexpr TimeNs kInside = 103 * 86'806;

/// LED bits of a command, in the order of the ring's even places, body, front.
std::uint8_t lamp_bits(const Actuation& a) noexcept {
  unsigned bits = 0;
  for (std::size_t i = 0; i < 4; ++i) bits |= lamp_on(a.ring[2 * i]) ? 1U << i : 0U;
  bits |= a.body ? 0x10U : 0U;
  bits |= a.front ? 0x20U : 0U;
  return static_cast<std::uint8_t>(bits);
}

AllActuators to_wire(const Actuation& a) noexcept {
  AllActuators all;
  all.left = a.left.value;
  all.right = a.right.value;
  all.leds = lamp_bits(a);
  for (std::size_t i = 0; i < 4; ++i) {
    const hal::Rgb c = a.ring[2 * i + 1];
    all.rgb_percent[3 * i] = to_percent(c.r);
    all.rgb_percent[3 * i + 1] = to_percent(c.g);
    all.rgb_percent[3 * i + 2] = to_percent(c.b);
  }
  return all;
}

/// Nothing else speaks so, and it does not tell its version.
Identity radio() noexcept {
  constexpr std::string_view kText = "WiFi (version not told)";
  Identity identity;
  identity.firmware = Firmware::Epuck2;
  std::copy(kText.begin(), kText.end(), identity.version.begin());
  return identity;
}

const QuantitySet kTold{Quantity::Encoders,     Quantity::Proximity, Quantity::Ambient, Quantity::Acceleration,
                        Quantity::Microphones,  Quantity::Gyro,      Quantity::Battery, Quantity::Ground,
                        Quantity::TimeOfFlight, Quantity::Selector};

}  // namespace

// --- link ---

void WifiSession::link_up(TimeNs now) noexcept {
  if (phase_ != Phase::Down) return;
  if (state_ == SessionState::Absent) state_ = SessionState::Handshake;
  identity_ = radio();
  layout_ = {.ground_bytes = 6, .microphone_bytes = 8, .time_of_flight_bytes = 2, .selector_bytes = kAllSensorsSize};
  samples_.ground = samples_.gyro = {};
  samples_.accelerometer.reset(Firmware::Unknown);  // its zero here is another than that of the command `a`
  reader_.clear();
  newest_.any = false;
  at_rest_ = false;
  backlog_ = false;
  silent_ns_ = 0;
  begin_handshake(now);
}

void WifiSession::link_down(TimeNs) noexcept {
  if (!lose_link(wants_new_link_ ? trouble_ : "the link hung up")) return;
  phase_ = Phase::Down;
  wants_new_link_ = false;
}

void WifiSession::give_up_link(const char* why) noexcept {
  trouble_ = why;
  state_ = SessionState::Lost;
  wants_new_link_ = true;
}

void WifiSession::stalled(TimeNs duration) noexcept {
  allowed_ns_ += std::clamp<TimeNs>(duration, 0, kMostAllowed - allowed_ns_);
}

// --- stop and handshake ---

void WifiSession::begin_handshake(TimeNs now) noexcept {
  ++statistics_.handshakes;
  handshaking_ = true;
  wanted_.left = wanted_.right = {};
  begin_stop(now);
}

void WifiSession::begin_stop(TimeNs now) noexcept {
  phase_ = Phase::Stop;
  stop_ns_ = say_due_ns_ = now;
  same_ns_ = 0;
  asked_again_ = false;
  waiting_ns_ = 0;
  allowed_ns_ = 0;
}

void WifiSession::judge_rest(const std::array<std::int16_t, 2>& counters, TimeNs at) noexcept {
  if (at < stop_ns_ + kSettle) return;
  if (same_ns_ == 0 || counters != same_) {
    same_ = counters;
    same_ns_ = at;
  } else if (at - same_ns_ >= kSame) {
    on_rest(at);
  }
}

void WifiSession::on_rest(TimeNs now) noexcept {
  note_rest();
  phase_ = ending_ ? Phase::Rest : Phase::Talk;
  if (ending_ || !handshaking_) return;
  note_handshake();
  say(now);  // the answer makes it active
}

void WifiSession::lose_step(const char* why, TimeNs now) noexcept {
  state_ = SessionState::Suspect;
  trouble_ = why;
  at_rest_ = false;
  begin_handshake(now);
}

// --- bytes in ---

void WifiSession::on_bytes(std::span<const std::uint8_t> bytes, TimeNs at) noexcept {
  if (phase_ == Phase::Down || wants_new_link_) return;
  for (const std::uint8_t byte : bytes) {
    switch (reader_.push(byte)) {
      case WifiReader::Event::None:
      case WifiReader::Event::Empty:
        break;
      case WifiReader::Event::Sensors:
        newest_.any = !is_backlog(at);
        newest_.at_ns = at;
        if (decode_all_sensors(reader_.sensors(), newest_.sensors) == Decoded::Ok) break;
        [[fallthrough]];
      case WifiReader::Event::OutOfStep:
        ++statistics_.implausible;
        newest_.any = false;
        give_up_link("what came are no sensors of an e-puck2");
        return;
    }
  }
}

/// Whether sensors that came at `at` are older than their arrival says.
bool WifiSession::is_backlog(TimeNs at) noexcept {
  const bool at_pace = at - arrived_ns_ >= kPace;
  arrived_ns_ = at;
  if (backlog_) return backlog_ = !at_pace;
  return backlog_ = silent_ns_ != 0;
}

void WifiSession::take_sensors(const AllSensors& sensors, TimeNs at, TimeNs now) noexcept {
  if (waiting_ns_ != 0) {
    const TimeNs round_trip = std::max<TimeNs>(0, at - waiting_ns_);
    ++statistics_.answers;
    statistics_.round_trips.add(round_trip);
    latency_ns_ = std::max(round_trip, latency_ns_ - (latency_ns_ - round_trip) / 8);
  }
  waiting_ns_ = silent_ns_ = allowed_ns_ = 0;
  asked_again_ = false;
  RawSensors raw = sensors.common;
  raw.cliffs = 0;
  const TimeNs taken = std::max<TimeNs>(1, at - kInside);
  if (counters_known_ && !counters_doubtful_ && !encoders_plausible(raw.encoders, at)) {
    ++statistics_.encoder_jumps;
    restarted_ = true;
    counters_doubtful_ = true;
    ++statistics_.restarts;
    return lose_step("the wheel counters jumped: the robot was restarted", now);
  }
  const bool moved = at_rest_ && counters_known_ && raw.encoders != samples_.raw.encoders;
  take_samples(kTold, raw, {taken, at});
  if (phase_ == Phase::Stop) return judge_rest(raw.encoders, at);
  if (phase_ != Phase::Talk) return;
  if (moved) {
    ++statistics_.wrong_speeds;
    return lose_step("it moves although it was told to stand", now);
  }
  state_ = SessionState::Active;
  trouble_ = "";
}

// --- time-outs ---

TimeNs WifiSession::answer_by() const noexcept {
  return waiting_ns_ + allowed_ns_ + timing_.answer_ns + (asked_again_ ? patience_ns_ : 0);
}

TimeNs WifiSession::next_deadline() const noexcept {
  if (phase_ == Phase::Down || phase_ == Phase::Rest || wants_new_link_) return kNever;
  const TimeNs answer = waiting_ns_ != 0 ? answer_by() + 1 : kNever;
  return phase_ == Phase::Stop ? std::min(answer, say_due_ns_) : answer;
}

void WifiSession::judge_silence(TimeNs now) noexcept {
  if (waiting_ns_ == 0 || now <= answer_by()) return;
  if (silent_ns_ == 0) silent_ns_ = waiting_ns_;
  if (now - silent_ns_ > kSilence) {
    ++statistics_.handshake_failures;
    return give_up_link(epoch_ == 0 ? "it lets us in and tells nothing; does another program drive it? it serves one"
                                    : "no answer");
  }
  ++statistics_.silent;
  if (phase_ == Phase::Stop) {
    if (now - silent_ns_ > timing_.tries * timing_.answer_ns && state_ != SessionState::Lost) {
      state_ = SessionState::Lost;
      if (*trouble_ == '\0') trouble_ = "no e-puck2 answers";
    }
    waiting_ns_ = now;
    allowed_ns_ = 0;
    return;
  }
  if (!asked_again_) {
    asked_again_ = true;
    ++statistics_.asked_again;
    waiting_ns_ = 0;  // anew, from the second command
    allowed_ns_ = 0;
    return say(now);
  }
  lose_step("no answer", now);
}

void WifiSession::poll(TimeNs now) noexcept {
  if (phase_ == Phase::Down || wants_new_link_) return;
  if (newest_.any) {
    newest_.any = false;
    take_sensors(newest_.sensors, newest_.at_ns, now);
  }
  judge_silence(now);
  if (phase_ != Phase::Stop || now < say_due_ns_ || wants_new_link_) return;
  output_.clear();  // nothing may stand before it that is not to be obeyed
  say(now);
  say_due_ns_ = now + kSayStopAgain;
}

TimeNs WifiSession::expected_round_trip(QuantitySet) const noexcept {
  return latency_ns_ != 0 ? latency_ns_ : kUsualLatency;
}

// --- bytes out ---

void WifiSession::say(TimeNs now) noexcept {
  if (!append_wifi_command(output_, to_wire(wanted_))) {
    output_.clear();  // only the newest counts
    append_wifi_command(output_, to_wire(wanted_));
  }
  ++statistics_.packets;
  sent_ = wanted_;
  said_ns_ = now;
  if (sent_.left.value != 0 || sent_.right.value != 0) at_rest_ = false;
  if (waiting_ns_ == 0) waiting_ns_ = now;
}

void WifiSession::command(const Actuation& actuation, TimeNs now) noexcept {
  keep(actuation);
  if (phase_ == Phase::Talk && talking() && wanted_ != sent_) say(now);
}

void WifiSession::ask(QuantitySet, TimeNs now) noexcept {
  if (phase_ == Phase::Talk && talking()) say(now);
}

void WifiSession::say_stop(TimeNs now) noexcept {
  if (ending_) wanted_ = {};
  if (phase_ == Phase::Stop) return;
  begin_stop(now);
  poll(now);
}

}  // namespace tandem::bridges::epuck
