// The conversation with one e-puck over a serial line, without I/O and without a clock: bytes and times go in, bytes
// come out.
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
// cable. Whenever synchronisation was lost, the wanted speeds are forgotten: the robot stands until it is asked again.
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
// the robot measured at an unknown time after that.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "bridges/epuck/conversation.hpp"
#include "bridges/epuck/stop.hpp"

namespace tandem::bridges::epuck {

/// The conversation over a serial line, whatever carries it. Commands leave at once when no answer is awaited, else as
/// soon as it has come.
class Session final : public Conversation {
 public:
  /// No packet is longer.
  static constexpr std::size_t kLongestRequest = 60;

  explicit Session(const SessionTiming& timing = {}) noexcept;

  void link_up(hal::TimeNs now) noexcept override;
  void link_down(hal::TimeNs now) noexcept override;
  void on_bytes(std::span<const std::uint8_t> bytes, hal::TimeNs at) noexcept override;
  void poll(hal::TimeNs now) noexcept override;
  hal::TimeNs next_deadline() const noexcept override;
  void stalled(hal::TimeNs duration) noexcept override;
  void command(const Actuation& actuation, hal::TimeNs now) noexcept override;
  /// A newer question joins one that waits.
  void ask(QuantitySet quantities, hal::TimeNs now) noexcept override;
  hal::TimeNs expected_round_trip(QuantitySet quantities) const noexcept override;
  bool idle() const noexcept override {
    return phase_ == Phase::Down || phase_ == Phase::Rest || (phase_ == Phase::Idle && !pending_);
  }

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

  bool is_down() const noexcept override { return phase_ == Phase::Down; }
  void say_stop(hal::TimeNs now) noexcept override;
  static constexpr std::size_t kSpeedsSize = 4;  // answer of E
  /// 10 bits a byte at 115200 baud.
  static constexpr hal::TimeNs transfer_ns(std::size_t bytes) noexcept {
    return static_cast<hal::TimeNs>(bytes) * 86'806;
  }
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
  void count_attempt() noexcept;
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

  void send_pending(hal::TimeNs now) noexcept;
  void append_question(hal::TimeNs now) noexcept;
  void append_lamps(hal::TimeNs now) noexcept;
  void append_wheels() noexcept;
  Measured measured(const Question& question, hal::TimeNs at) noexcept;

  Phase phase_ = Phase::Down;
  hal::TimeNs deadline_ns_ = 0;
  hal::TimeNs heard_ns_ = 0;     // the last byte of the answers that are awaited; 0: none
  hal::TimeNs given_up_ns_ = 0;  // Again: by then, however noisy the link is
  int attempts_ = 0;             // in vain since it was lost
  bool identity_known_ = false;
  bool layout_known_ = false;
  bool resting_ = false;       // the stop is followed by a rest
  bool rest_doubted_ = false;  // until the next answer
  bool told_again_ = false;
  int odd_answers_ = 0;  // in a row; two make the layout doubtful, more than `tries` the robot
  int version_asks_ = 0;

  StopProcedure stop_;
  int failed_rounds_ = 0;  // of the stop, that were counted
  LineReader lines_;
  GreetingSpotter greeting_;
  Question question_;  // the newest
  Question earlier_;   // whose answer may come before that of the newest
  bool earlier_awaited_ = false;
  std::size_t earlier_size_ = 0;                                 // bytes that came before the newest question was asked
  std::array<std::uint8_t, 2 * (kLongestAnswer + 4)> answer_{};  // of both
  std::size_t answer_size_ = 0;

  bool pending_ = false;
  QuantitySet wanted_quantities_{Quantity::Encoders};  // of the newest question, also asked after a handshake
  QuantitySet pending_quantities_;
  bool lamps_known_ = false;
  bool speeds_due_ = false;                   // whatever the robot was told before
  std::array<StepsPerS, 2> speeds_before_{};  // what the robot was told last but one
  hal::TimeNs refreshed_ns_ = 0;
};

}  // namespace tandem::bridges::epuck
