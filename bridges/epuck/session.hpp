// The conversation with one e-puck, without I/O and without a clock: bytes and times go in, bytes come out.
//
//   absent --link up--> handshake --version, stop, probes--> ready --first answer--> active
//   active --no, short, odd or unasked answer--> suspect --resynchronised--> ready        (tens of milliseconds)
//   suspect, handshake --3 tries in vain, or link down--> lost --it answers again--> ready
//   any --greeting: the robot was restarted--> handshake
//
// Resynchronising: 40 zeros end a half-received binary packet, CR ends a half-received line; `V` asks who is there and
// speeds 0 and `S` stop the robot. Answers come in order, so when `s` has come nothing older can follow, and nothing
// need be waited for. Where firmwares answer with different lengths (`M`, `b`) the robot is asked once, followed by
// `E`, which every firmware answers: what comes before E's four zeros is the length. Whenever synchronisation was lost,
// the wanted speeds are forgotten: the robot stands until it is asked anew. The wheel counters go on where they were.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "bridges/epuck/codec.hpp"
#include "bridges/epuck/line.hpp"
#include "hal/device/leds.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::epuck {

enum class SessionState : std::uint8_t {
  Absent,     ///< there was no link yet
  Handshake,  ///< finding out who is there
  Ready,      ///< known and stopped; the first answer is awaited
  Active,     ///< answers come
  Suspect,    ///< out of step or silent; resynchronising
  Lost        ///< no link any more, or no answer to repeated tries; tried again each second
};
const char* state_name(SessionState state) noexcept;

struct SessionTiming {
  hal::TimeNs answer_ns =
      100 * hal::kNsPerMs;  ///< to wait for an answer, beyond the time its bytes take; Bluetooth: 500 ms
  hal::TimeNs version_ns = hal::kNsPerSecond;  ///< to wait for `V`, but in the first quick try
  hal::TimeNs drain_ns = 300 * hal::kNsPerMs;  ///< to let old bytes come before a slow try
  hal::TimeNs gap_ns = 60 * hal::kNsPerMs;     ///< silence that ends an answer of unknown length
  hal::TimeNs retry_ns = hal::kNsPerSecond;    ///< between tries when lost
  hal::TimeNs refresh_ns =
      hal::kNsPerSecond;  ///< speeds and LEDs are sent on change, and this often against lost bytes
  int tries = 3;
};

/// What the robot is to do.
struct Actuation {
  StepsPerS left, right;
  std::array<hal::Rgb, 8> ring{};
  bool body = false;
  bool front = false;
  friend bool operator==(const Actuation&, const Actuation&) = default;
};

/// The newest value of each quantity.
struct Samples {
  RawSensors raw;
  QuantitySet known;                                   ///< which were ever received
  std::array<hal::TimeNs, kQuantityCount> taken_ns{};  ///< arrival of each
  std::int64_t left_steps = 0;                         ///< since the session was made; no wrap, no jump on restarts
  std::int64_t right_steps = 0;
  double left_steps_per_s = 0.0;  ///< mean between the last two readings
  double right_steps_per_s = 0.0;
};

/// Every kind of trouble has its counter.
struct SessionStatistics {
  std::uint64_t packets = 0;        ///< binary packets sent
  std::uint64_t answers = 0;        ///< complete and plausible
  std::uint64_t replaced = 0;       ///< requests overtaken by a newer one before they could be sent
  std::uint64_t silent = 0;         ///< time-outs without a byte
  std::uint64_t cut_short = 0;      ///< time-outs with part of an answer
  std::uint64_t implausible = 0;    ///< values that cannot be
  std::uint64_t encoder_jumps = 0;  ///< wheel counters farther on than a wheel can turn
  std::uint64_t encoder_rebased =
      0;  ///< counters taken up anew after a restart or a long loss: motion in between unknown
  std::uint64_t unasked_bytes = 0;   ///< while nothing was asked
  std::uint64_t not_understood = 0;  ///< "z,Command not found"
  std::uint64_t cut_lines = 0;       ///< longer than any line that the firmware sends
  std::uint64_t probe_failures = 0;  ///< lengths that no firmware answers
  std::uint64_t handshakes = 0;      ///< begun
  std::uint64_t handshake_failures = 0;
  std::uint64_t resynchronised = 0;  ///< handshakes that brought a suspect or lost robot back
  std::uint64_t restarts = 0;        ///< greetings in the middle of a session
  std::uint64_t links_lost = 0;
  std::uint64_t stops = 0;  ///< asked for with `stop`
  std::uint64_t stops_confirmed = 0;
  hal::TimeNs last_round_trip_ns = 0;
  hal::TimeNs max_round_trip_ns = 0;
  hal::TimeNs sum_round_trip_ns = 0;  ///< over `answers`
};

/// One conversation. After every call the caller sends `output()` and clears it. Times never run backwards.
/// Allocates nothing. Not thread-safe.
class Session {
 public:
  /// No packet is longer, so that a stop always fits into the robot's buffer behind it.
  static constexpr std::size_t kLongestRequest = 56;

  explicit Session(const SessionTiming& timing = {}) noexcept : timing_(timing) {}

  void link_up(hal::TimeNs now) noexcept;
  void link_down(hal::TimeNs now) noexcept;
  /// Bytes that arrived at `at`, in order.
  void on_bytes(std::span<const std::uint8_t> bytes, hal::TimeNs at) noexcept;
  /// Applies time-outs. Call it at `next_deadline()` at the latest.
  void poll(hal::TimeNs now) noexcept;
  hal::TimeNs next_deadline() const noexcept;

  /// Asks for `quantities` (and always for the wheel counters) and sets `actuation`: at once when no answer is awaited,
  /// else as soon as it has come. A newer request replaces one that waits. Outside Ready and Active only the LEDs are
  /// kept.
  void request(const Actuation& actuation, QuantitySet quantities, hal::TimeNs now) noexcept;
  /// Stops the robot now, also while an answer is awaited; the wanted speeds become 0. A later request moves it again.
  void stop(hal::TimeNs now) noexcept;
  /// Stops the robot for good, whatever it may be reading at the moment. Then wait for `idle()`, for a little while.
  void farewell(hal::TimeNs now) noexcept;

  const Packet& output() const noexcept { return output_; }
  void clear_output() noexcept { output_.clear(); }

  SessionState state() const noexcept { return state_; }
  /// Why the state last left Active or never came there; "" when all is well. For people.
  const char* trouble() const noexcept { return trouble_; }
  /// Nothing is awaited or waits to be sent.
  bool idle() const noexcept {
    return phase_ == Phase::Down || phase_ == Phase::Rest || (phase_ == Phase::Idle && !pending_);
  }
  /// Handshakes that succeeded. Changes whenever the robot was stopped behind the user's back.
  std::uint64_t epoch() const noexcept { return epoch_; }
  const Identity& identity() const noexcept { return identity_; }
  const AnswerLayout& layout() const noexcept { return layout_; }
  const Samples& samples() const noexcept { return samples_; }
  const SessionStatistics& statistics() const noexcept { return statistics_; }

 private:
  enum class Phase : std::uint8_t { Down, Drain, Version, StopLine, ProbeBattery, ProbeGround, Idle, Answer, Rest };

  void on_byte(std::uint8_t byte, hal::TimeNs at) noexcept;
  void on_line(std::string_view line, hal::TimeNs at) noexcept;
  void on_probe_byte(std::uint8_t byte, hal::TimeNs at) noexcept;
  void on_answer(hal::TimeNs at) noexcept;
  void on_greeting(hal::TimeNs at) noexcept;

  void begin_handshake(hal::TimeNs now, bool quick) noexcept;
  void ask_version() noexcept;
  void say_stop_blindly() noexcept;
  void attempt_failed(hal::TimeNs now) noexcept;
  void rest(hal::TimeNs now) noexcept;
  void send_probe(Phase phase, Quantity quantity, hal::TimeNs now) noexcept;
  void finish_probe(hal::TimeNs now) noexcept;
  void finish_handshake() noexcept;
  void lose_step(const char* why, hal::TimeNs now) noexcept;

  void send_pending(hal::TimeNs now) noexcept;
  void append_actuation(hal::TimeNs now) noexcept;
  void take_encoders(const std::array<std::int16_t, 2>& counters, hal::TimeNs at) noexcept;
  bool encoders_plausible(const std::array<std::int16_t, 2>& counters, hal::TimeNs at) const noexcept;
  hal::TimeNs answer_deadline(std::size_t bytes_in, hal::TimeNs now) const noexcept;

  SessionTiming timing_;
  SessionState state_ = SessionState::Absent;
  Phase phase_ = Phase::Down;
  const char* trouble_ = "";
  hal::TimeNs deadline_ns_ = 0;
  hal::TimeNs asked_ns_ = 0;
  int attempts_ = 0;
  bool handshaking_ = false;
  bool stop_line_due_ = false;  // an `s` follows the answer that is awaited
  bool layout_known_ = false;
  bool restarted_ = false;  // since the wheel counters were last read
  bool counters_known_ = false;
  bool counters_doubtful_ = false;  // first reading after a handshake
  int odd_answers_ = 0;             // in a row; two make the layout doubtful, more than `tries` the robot
  std::uint64_t epoch_ = 0;

  Packet output_;
  LineReader lines_;
  GreetingSpotter greeting_;
  std::array<std::uint8_t, kLongestAnswer> answer_{};
  std::size_t answer_size_ = 0;
  std::size_t answer_expected_ = 0;
  QuantitySet asked_;

  bool pending_ = false;
  Actuation wanted_;
  QuantitySet wanted_quantities_{Quantity::Encoders};
  Actuation sent_;
  bool sent_known_ = false;
  hal::TimeNs refreshed_ns_ = 0;

  Identity identity_;
  AnswerLayout layout_;
  Samples samples_;
  SessionStatistics statistics_;
};

}  // namespace tandem::bridges::epuck
