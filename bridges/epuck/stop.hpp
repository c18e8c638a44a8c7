// Stop sequence of an e-puck, safe against bytes lost, doubled or flipped on the way. Used by the session and by the
// guardian, which has no session.
//
// The stock firmware reads a stream without frames: a byte that is lost shifts all that follow into other places, and
// what stands behind a half-received "set speeds" becomes a speed. Hence three bursts with quiet times between them:
//
//   words    44 x 00, then 10 x "S\r"   zeros end any half-received binary command (the longest has 35 bytes and a 0)
//   zeros    BC, then 12 x 00           speeds 0, also in the variables that E tells and a maimed "D\r" would repeat
//   words    again                      last, because no single wrong byte turns them into a movement
//
// tests/bridges/epuck explores the firmware's parser as an automaton: from every state that it can be in, with at most
// eight bytes lost and one more doubled or with a flipped bit, the wheels end at 0. For a byte of the stop to become a
// speed, 53 must be lost, nearly all the zeros behind BC; or 40 of the lead-in when the hub's own "set speeds" was
// half-received.
//
// A doubled or flipped byte of the zeros may be a speed until the words come 14 ms later: during a stop nobody may take
// the robot for resting, although it was at rest before.
//
// Sending proves nothing. The stop is confirmed when the robot has answered twice that its commanded speeds are 0 and
// its wheel counters were the same both times; until then all is repeated.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "bridges/epuck/codec.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::epuck {

/// Bursts of one round of the stop, to be sent in this order, `kStopBurstGap` after one another. None is longer than
/// the robot's receive buffer.
inline constexpr std::size_t kStopBursts = 3;
inline constexpr hal::TimeNs kStopBurstGap = 10 * hal::kNsPerMs;
std::span<const std::uint8_t> stop_burst(std::size_t i) noexcept;

/// Asks for wheel counters and commanded speeds; answered with 8 bytes.
std::span<const std::uint8_t> rest_question() noexcept;

struct StopTiming {
  hal::TimeNs quiet_ns = 20 * hal::kNsPerMs;    ///< silence after which older answers are over; Bluetooth: more
  hal::TimeNs answer_ns = 100 * hal::kNsPerMs;  ///< to wait for an answer
  hal::TimeNs apart_ns = 40 * hal::kNsPerMs;    ///< between the two readings
};

/// Whether the robot is reached through a network.
bool in_network(std::string_view link_name) noexcept;
/// For a link of this name: Bluetooth (rfcomm) devices and those in a network answer late.
StopTiming stop_timing_for(std::string_view link_name) noexcept;

/// The stop of one wire as a conversation without I/O.
class StopTalk {
 public:
  virtual ~StopTalk() = default;
  /// A link was opened.
  virtual void begin(hal::TimeNs now) noexcept = 0;
  virtual void on_bytes(std::span<const std::uint8_t> bytes, hal::TimeNs at) noexcept = 0;
  /// Appends what is due to `out`.
  virtual void poll(hal::TimeNs now, Packet& out) noexcept = 0;
  virtual hal::TimeNs next_deadline() const noexcept = 0;
  virtual bool confirmed() const noexcept = 0;
  virtual bool answered() const noexcept = 0;
  /// The link is of no more use, although it is open.
  virtual bool wants_new_link() const noexcept { return false; }
  /// A packet that was sent in part only spoils what follows on the same link.
  virtual bool needs_whole_packets() const noexcept { return false; }
};

/// The stop over a serial line. Begun once, it says stop, asks, and begins a new round
/// until the robot confirms, however long that takes: in a dead link about every 150 ms. Where older answers are taken
/// for the right one because the line is slow, the silence that it waits for is doubled. Allocates nothing.
class StopProcedure final : public StopTalk {
 public:
  explicit StopProcedure(const StopTiming& timing = {}) noexcept : timing_(timing), quiet_ns_(timing.quiet_ns) {}

  /// Starts again: the first burst is due at once. What is under way may still come for `round_trip_ns`.
  void begin(hal::TimeNs now, hal::TimeNs round_trip_ns) noexcept;
  void begin(hal::TimeNs now) noexcept override { begin(now, 0); }
  void on_byte(std::uint8_t byte, hal::TimeNs at) noexcept;
  void on_bytes(std::span<const std::uint8_t> bytes, hal::TimeNs at) noexcept override {
    for (const std::uint8_t byte : bytes) on_byte(byte, at);
  }
  /// Appends what is due to `out`, which the caller sends at once; applies time-outs.
  void poll(hal::TimeNs now, Packet& out) noexcept override;
  /// When `poll` has something to do. Never, once confirmed.
  hal::TimeNs next_deadline() const noexcept override;
  /// Gives an answer that is awaited so much more time.
  void extend(hal::TimeNs by) noexcept {
    if (step_ == Step::Answer) due_ns_ += by;
  }

  bool confirmed() const noexcept override { return step_ == Step::Confirmed; }
  /// Rounds that ended without a confirmation since `begin`.
  int failed_rounds() const noexcept { return failed_rounds_; }
  /// Whether a whole answer came since `begin`: the robot hears and is heard.
  bool answered() const noexcept override { return answered_; }
  /// The newest reading of the wheel counters; valid when `answered`.
  const std::array<std::int16_t, 2>& counters() const noexcept { return counters_; }

 private:
  enum class Step : std::uint8_t { Burst, Settle, Answer, Apart, Confirmed };

  void ask(hal::TimeNs now, Packet& out) noexcept;
  void take_answer(hal::TimeNs at) noexcept;
  void fail_round(hal::TimeNs now) noexcept;

  StopTiming timing_;
  hal::TimeNs quiet_ns_;  // what the line turned out to need
  Step step_ = Step::Confirmed;
  std::size_t burst_ = 0;
  hal::TimeNs due_ns_ = 0;
  hal::TimeNs settled_by_ns_ = 0;  // however noisy the link is
  bool first_known_ = false;       // of the two readings
  bool answered_ = false;
  int failed_rounds_ = 0;
  std::array<std::uint8_t, 8> answer_{};
  std::size_t answer_size_ = 0;
  std::array<std::int16_t, 2> counters_{};
};

}  // namespace tandem::bridges::epuck
