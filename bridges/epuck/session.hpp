// The conversation with one e-puck, without I/O and without a clock: bytes and times go in, bytes come out.
//
//   absent --link up--> handshake --stop confirmed, version, lengths--> ready --first answer--> active
//   active --no, short, odd or unasked answer, other speeds than told--> suspect --resynchronised--> ready
//   suspect, handshake --3 tries in vain, or link down--> lost --it answers again--> ready
//   any --greeting: the robot was restarted--> handshake
//
// Every loss of synchronisation begins with the stop of stop.hpp, which goes on until the robot confirms it: nothing
// else is said to a robot that may be reading something else. Then `V` asks who is there. Where firmwares answer with
// different lengths (`M`, `b`) the robot is asked once, followed by `E`, which every firmware answers: what comes
// before E's four zeros is the length. After a short outage of a robot that is known both are left out: 0.12 s over a
// cable. Whenever synchronisation was lost, the wanted speeds are forgotten: the robot stands until it is asked anew.
// The wheel counters go on where they were.
//
// What is told and what is asked leave separately: commands at once, questions when their answer is needed. Each packet
// asks for the commanded speeds as well (`E`): when they are not those that were told, the robot is told again once,
// and stopped if it tells its old ones no longer. An answer that does not come is asked for again once, with the
// speeds.
//
// An answer that did not come may be late, not lost. So after asking again up to two answers are awaited, in order: the
// second question asks for one quantity more where their sizes would not tell them apart, and what has come is judged
// by size and speeds once both have come or the line is quiet. The robot is stopped when neither comes, or anything
// else does. When only the first one comes the second is overdue in its turn. A late answer is dated with its question:
// nobody knows when after that the robot measured.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "bridges/epuck/accelerometer.hpp"
#include "bridges/epuck/codec.hpp"
#include "bridges/epuck/line.hpp"
#include "bridges/epuck/stop.hpp"
#include "hal/device/leds.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::epuck {

enum class SessionState : std::uint8_t {
  Absent,     ///< there was no link yet
  Handshake,  ///< finding out who is there
  Ready,      ///< known and stopped; the first answer is awaited
  Active,     ///< answers come
  Suspect,    ///< out of step or silent; resynchronising
  Lost        ///< no link any more, or no answer to repeated tries; they go on
};
const char* state_name(SessionState state) noexcept;

struct SessionTiming {
  hal::TimeNs answer_ns =
      100 * hal::kNsPerMs;  ///< to wait for an answer, beyond the time its bytes take; Bluetooth: 500 ms
  hal::TimeNs gap_ns = 60 * hal::kNsPerMs;     ///< silence that ends an answer of unknown length
  hal::TimeNs quiet_ns = 20 * hal::kNsPerMs;   ///< silence after which what was under way has come; Bluetooth: more
  hal::TimeNs retry_ns = 200 * hal::kNsPerMs;  ///< before a robot is tried again that answers oddly for ever
  hal::TimeNs refresh_ns = hal::kNsPerSecond;  ///< LEDs are sent on change, and this often against lost bytes
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
  std::array<hal::TimeNs, kQuantityCount> taken_ns{};  ///< when the robot measured each
  std::int64_t left_steps = 0;                         ///< since the session was made; no wrap, no jump on restarts
  std::int64_t right_steps = 0;
  double left_steps_per_s = 0.0;  ///< mean between the last two readings
  double right_steps_per_s = 0.0;
  AccelerometerCheck accelerometer;
};

/// Every kind of trouble has its counter.
struct SessionStatistics {
  std::uint64_t packets = 0;        ///< binary packets sent
  std::uint64_t answers = 0;        ///< complete and plausible
  std::uint64_t replaced = 0;       ///< requests overtaken by a newer one before they could be sent
  std::uint64_t silent = 0;         ///< time-outs without a byte
  std::uint64_t cut_short = 0;      ///< time-outs with part of an answer
  std::uint64_t implausible = 0;    ///< values that cannot be
  std::uint64_t asked_again = 0;    ///< answers that did not come at once
  std::uint64_t overdue = 0;        ///< answers that came after all, when they had been asked for again
  std::uint64_t wrong_speeds = 0;   ///< readings of other commanded speeds than told
  std::uint64_t encoder_jumps = 0;  ///< wheel counters farther on than a wheel can turn
  std::uint64_t encoder_rebased =
      0;  ///< counters taken up anew after a restart or a long loss: motion in between unknown
  std::uint64_t unasked_bytes = 0;       ///< while nothing was asked
  std::uint64_t not_understood = 0;      ///< "z,Command not found"
  std::uint64_t cut_lines = 0;           ///< longer than any line that the firmware sends
  std::uint64_t odd_versions = 0;        ///< answers to `V` that are no firmware's, or maimed
  std::uint64_t probe_failures = 0;      ///< lengths that no firmware answers
  std::uint64_t handshakes = 0;          ///< begun
  std::uint64_t handshake_failures = 0;  ///< rounds of the stop, versions and lengths that were not answered
  std::uint64_t resynchronised = 0;      ///< handshakes that brought a suspect or lost robot back
  std::uint64_t restarts = 0;            ///< greetings in the middle of a session
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
  /// No packet is longer.
  static constexpr std::size_t kLongestRequest = 60;

  explicit Session(const SessionTiming& timing = {}) noexcept;

  void link_up(hal::TimeNs now) noexcept;
  void link_down(hal::TimeNs now) noexcept;
  /// Bytes that arrived at `at`, in order.
  void on_bytes(std::span<const std::uint8_t> bytes, hal::TimeNs at) noexcept;
  /// Applies time-outs. Call it at `next_deadline()` at the latest.
  void poll(hal::TimeNs now) noexcept;
  hal::TimeNs next_deadline() const noexcept;

  /// The caller was kept from calling for so long: what is awaited may take as much longer, within 0.5 s an answer.
  void stalled(hal::TimeNs duration) noexcept;
  /// What the second of two questions may take longer than the first, from now on: the robot is stopped when its
  /// answer does not come.
  void be_patient(hal::TimeNs duration) noexcept { patience_ns_ = duration; }

  /// Sets `actuation`: at once when no answer is awaited, else as soon as it has come. Outside Ready and Active only
  /// the LEDs are kept.
  void command(const Actuation& actuation, hal::TimeNs now) noexcept;
  /// Asks for `quantities` and the wheel counters, as soon as no answer is awaited. A newer question joins one that
  /// waits.
  void ask(QuantitySet quantities, hal::TimeNs now) noexcept;
  /// Both in one packet.
  void request(const Actuation& actuation, QuantitySet quantities, hal::TimeNs now) noexcept;
  /// How long a question for `quantities` has lately taken at most, from asking to the last byte of the answer.
  hal::TimeNs expected_round_trip(QuantitySet quantities) const noexcept;

  /// Stops the robot now, also while an answer is awaited, and goes on until it confirms; the wanted speeds become 0. A
  /// later request moves it again.
  void stop(hal::TimeNs now) noexcept;
  /// Stops the robot for good, whatever it may be reading at the moment. Then wait for `idle()`: it has confirmed.
  void shut_down(hal::TimeNs now) noexcept;
  /// The robot itself has confirmed that it stands, and nothing that moves it was sent since.
  bool at_rest() const noexcept { return at_rest_; }

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
  enum class Phase : std::uint8_t {
    Down,
    Stop,  // the stop of stop.hpp is under way
    Version,
    Hardware,  // a second line may follow the version
    ProbeBattery,
    ProbeGround,
    Idle,
    Answer,
    Again,  // an answer did not come; what is under way may still come before it is asked for again
    Rest
  };
  struct Question {
    QuantitySet asked;
    bool marked = false;          // speeds first as well
    std::size_t answer_size = 0;  // in bytes
    std::size_t question_size = 0;
    std::array<StepsPerS, 2> told{};  // with it, or before
    hal::TimeNs asked_ns = 0;
  };

  void on_byte(std::uint8_t byte, hal::TimeNs at) noexcept;
  void on_line(std::string_view line, hal::TimeNs at) noexcept;
  void on_version(hal::TimeNs at) noexcept;
  void on_probe_byte(std::uint8_t byte, hal::TimeNs at) noexcept;
  void on_answer_byte(std::uint8_t byte, hal::TimeNs at) noexcept;
  void judge_answers(hal::TimeNs now) noexcept;
  void take_late_answer(hal::TimeNs now) noexcept;
  bool decode(const Question& question, std::span<const std::uint8_t> bytes, RawSensors& raw) noexcept;
  void on_answer(const Question& question, std::span<const std::uint8_t> bytes, hal::TimeNs at) noexcept;
  void on_greeting(hal::TimeNs at) noexcept;

  void begin_handshake(hal::TimeNs now) noexcept;
  void begin_stop(hal::TimeNs now) noexcept;
  void go_on_stopping(hal::TimeNs now) noexcept;
  void on_rest(hal::TimeNs now) noexcept;
  void ask_version(hal::TimeNs now) noexcept;
  void introduced(hal::TimeNs now) noexcept;
  void attempt_failed(hal::TimeNs now) noexcept;
  void send_probe(Phase phase, Quantity quantity, hal::TimeNs now) noexcept;
  void finish_probe(hal::TimeNs now) noexcept;
  void finish_handshake() noexcept;
  void lose_step(const char* why, hal::TimeNs now) noexcept;
  void miss_answer(hal::TimeNs now) noexcept;
  void begin_again(hal::TimeNs now) noexcept;
  hal::TimeNs answer_deadline() const noexcept;
  bool second_alone() const noexcept;
  std::span<const std::uint8_t> received(std::size_t from, std::size_t size) const noexcept;
  bool speeds_as_told(const std::array<std::int16_t, 2>& commanded, hal::TimeNs at) noexcept;

  bool talking() const noexcept { return state_ == SessionState::Ready || state_ == SessionState::Active; }
  void keep(const Actuation& actuation) noexcept;
  void send_pending(hal::TimeNs now) noexcept;
  void append_question(hal::TimeNs now) noexcept;
  void append_lamps(hal::TimeNs now) noexcept;
  void append_wheels() noexcept;
  struct Measured {
    hal::TimeNs taken_ns, latest_ns;  // most likely, or earliest; and latest
  };
  Measured measured(const Question& question, hal::TimeNs at) noexcept;
  void take_samples(QuantitySet asked, const RawSensors& raw, const Measured& when) noexcept;
  void take_encoders(const std::array<std::int16_t, 2>& counters, const Measured& when) noexcept;
  bool encoders_plausible(const std::array<std::int16_t, 2>& counters, hal::TimeNs latest) const noexcept;

  SessionTiming timing_;
  SessionState state_ = SessionState::Absent;
  Phase phase_ = Phase::Down;
  const char* trouble_ = "";
  hal::TimeNs deadline_ns_ = 0;
  hal::TimeNs heard_ns_ = 0;    // the last byte of the answers that are awaited; 0: none
  hal::TimeNs allowed_ns_ = 0;  // for stalls, of the answer that is awaited
  hal::TimeNs patience_ns_ = 0;
  hal::TimeNs given_up_ns_ = 0;  // Again: by then, however noisy the link is
  hal::TimeNs latency_ns_ = 0;   // one way, the bytes' own time aside; follows its peaks
  int attempts_ = 0;             // in vain since it was lost
  bool handshaking_ = false;
  bool identity_known_ = false;
  bool layout_known_ = false;
  bool resting_ = false;     // the stop is followed by a rest
  bool ending_ = false;      // or by nothing
  bool stop_asked_ = false;  // by `stop`, and not yet confirmed
  bool at_rest_ = false;
  bool rest_doubted_ = false;  // until the next answer
  bool restarted_ = false;     // since the wheel counters were last read
  bool counters_known_ = false;
  bool counters_doubtful_ = false;  // first reading after a handshake
  bool asked_again_ = false;
  bool told_again_ = false;
  int odd_answers_ = 0;  // in a row; two make the layout doubtful, more than `tries` the robot
  int version_asks_ = 0;
  std::uint64_t epoch_ = 0;

  StopProcedure stop_;
  int failed_rounds_ = 0;  // of the stop, that were counted
  Packet output_;
  LineReader lines_;
  GreetingSpotter greeting_;
  Question question_;  // the newest
  Question earlier_;   // whose answer may come before that of the newest
  bool earlier_awaited_ = false;
  std::size_t earlier_size_ = 0;                                 // bytes that came before the newest question was asked
  std::array<std::uint8_t, 2 * (kLongestAnswer + 4)> answer_{};  // of both
  std::size_t answer_size_ = 0;

  bool pending_ = false;
  Actuation wanted_;
  QuantitySet wanted_quantities_{Quantity::Encoders};  // of the newest question, also asked after a handshake
  QuantitySet pending_quantities_;
  Actuation sent_;
  bool lamps_known_ = false;
  bool speeds_due_ = false;                   // whatever the robot was told before
  std::array<StepsPerS, 2> speeds_before_{};  // what the robot was told last but one
  hal::TimeNs refreshed_ns_ = 0;

  Identity identity_;
  AnswerLayout layout_;
  Samples samples_;
  SessionStatistics statistics_;
};

}  // namespace tandem::bridges::epuck
