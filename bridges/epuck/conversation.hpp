// Interface of a conversation with one e-puck, without I/O and without a clock, and what conversations have in common:
// states, what was measured, counts. `Session` talks over a serial line, `WifiSession` with an e-puck2's radio.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "bridges/epuck/accelerometer.hpp"
#include "bridges/epuck/codec.hpp"
#include "bridges/epuck/line.hpp"
#include "bridges/round_trips.hpp"
#include "hal/device/leds.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::epuck {

/// How the robot's bytes look on their way.
enum class WireForm : std::uint8_t {
  Serial,  ///< the stock firmware's commands: cable, Bluetooth, a serial server in the network
  Wifi     ///< the e-puck2's packets over its own radio
};

enum class SessionState : std::uint8_t {
  Absent,     ///< there was no link yet
  Handshake,  ///< identifying the robot
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

/// Command to the robot.
struct Actuation {
  StepsPerS left, right;
  std::array<hal::Rgb, 8> ring{};
  bool body = false;
  bool front = false;
  friend bool operator==(const Actuation&, const Actuation&) = default;
};

/// Whether there is a device behind readings that firmwares answer with zeros where it is missing. What measures never
/// reads exactly 0 on all its channels for long: ground sensors have an offset in the dark, gyroscopes noise.
struct Presence {
  static constexpr std::uint32_t kMissing = 20;  ///< so many answers of nothing but zeros, and people are informed

  bool measured = false;    ///< something other than 0 came: it is there
  std::uint32_t zeros = 0;  ///< answers before that
  void note(bool all_zero) noexcept {
    measured = measured || !all_zero;
    if (!measured) ++zeros;
  }
  bool missing() const noexcept { return !measured && zeros >= kMissing; }
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
  Presence ground;  ///< the board under the body, cliff sensors included
  Presence gyro;    ///< of firmwares whose robots may lack it: hardware before 1.3
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
      0;  ///< counters taken up again after a restart or a long loss: motion in between unknown
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
  RoundTrips round_trips;  ///< of `answers`
};

/// After every call the caller sends `output()` and clears it. Times never run backwards. Allocates nothing. Not
/// thread-safe.
class Conversation {
 public:
  explicit Conversation(const SessionTiming& timing) noexcept : timing_(timing) {}
  virtual ~Conversation() = default;

  virtual void link_up(hal::TimeNs now) noexcept = 0;
  virtual void link_down(hal::TimeNs now) noexcept = 0;
  /// Bytes that arrived at `at`, in order.
  virtual void on_bytes(std::span<const std::uint8_t> bytes, hal::TimeNs at) noexcept = 0;
  /// Applies time-outs. Call it at `next_deadline()` at the latest.
  virtual void poll(hal::TimeNs now) noexcept = 0;
  virtual hal::TimeNs next_deadline() const noexcept = 0;

  /// The caller was kept from calling for so long: what is awaited may take as much longer, within 0.5 s an answer.
  virtual void stalled(hal::TimeNs duration) noexcept = 0;
  /// What the second of two questions may take longer than the first, from now on: the robot is stopped when its
  /// answer does not come.
  void be_patient(hal::TimeNs duration) noexcept { patience_ns_ = duration; }

  /// Sets `actuation`. Outside Ready and Active only the LEDs are kept.
  virtual void command(const Actuation& actuation, hal::TimeNs now) noexcept = 0;
  /// Asks for `quantities` and the wheel counters.
  virtual void ask(QuantitySet quantities, hal::TimeNs now) noexcept = 0;
  /// Both in one packet.
  void request(const Actuation& actuation, QuantitySet quantities, hal::TimeNs now) noexcept {
    keep(actuation);
    ask(quantities, now);
  }
  /// How long a question for `quantities` has lately taken at most, from asking to the last byte of the answer.
  virtual hal::TimeNs expected_round_trip(QuantitySet quantities) const noexcept = 0;

  /// Stops the robot now, also while an answer is awaited, and goes on until it confirms; the wanted speeds become 0. A
  /// later request moves it again.
  void stop(hal::TimeNs now) noexcept;
  /// Stops the robot for good, whatever it may be reading at the moment. Then wait for `idle()`: it has confirmed.
  void shut_down(hal::TimeNs now) noexcept;
  /// Nothing is awaited or waits to be sent.
  virtual bool idle() const noexcept = 0;
  /// The link is of no more use, although it is open: close it and reopen it.
  virtual bool wants_new_link() const noexcept { return false; }
  /// Of `output()`, only a part could be sent.
  virtual void sent_in_part() noexcept {}

  /// The robot itself has confirmed that it stands, and nothing that may move it was sent since; a new stop may, when
  /// its bytes are damaged.
  bool at_rest() const noexcept { return at_rest_; }
  const Packet& output() const noexcept { return output_; }
  void clear_output() noexcept { output_.clear(); }
  SessionState state() const noexcept { return state_; }
  /// Why the state last left Active or never came there; "" when all is well. For people.
  const char* trouble() const noexcept { return trouble_; }
  /// Handshakes that succeeded. Changes whenever the robot was stopped behind the user's back.
  std::uint64_t epoch() const noexcept { return epoch_; }
  const Identity& identity() const noexcept { return identity_; }
  const AnswerLayout& layout() const noexcept { return layout_; }
  const Samples& samples() const noexcept { return samples_; }
  const SessionStatistics& statistics() const noexcept { return statistics_; }

 protected:
  Conversation(const Conversation&) = default;
  Conversation& operator=(const Conversation&) = default;

  /// When the robot measured what an answer tells.
  struct Measured {
    hal::TimeNs taken_ns, latest_ns;  // most likely, or earliest; and latest
  };
  void take_samples(QuantitySet asked, const RawSensors& raw, const Measured& when) noexcept;
  /// False: a wheel cannot have turned so far since they were last read, or they may have gone round.
  bool encoders_plausible(const std::array<std::int16_t, 2>& counters, hal::TimeNs latest) const noexcept;

  /// There is no link.
  virtual bool is_down() const noexcept = 0;
  /// The wanted speeds are 0: begins the stop, unless it is under way.
  virtual void say_stop(hal::TimeNs now) noexcept = 0;
  /// Keeps what is wanted; the speeds only where they may be told.
  void keep(const Actuation& actuation) noexcept {
    wanted_ = actuation;
    if (!talking() || ending_ || is_stopping()) wanted_.left = wanted_.right = {};
  }
  virtual bool is_stopping() const noexcept { return false; }
  bool talking() const noexcept { return state_ == SessionState::Ready || state_ == SessionState::Active; }
  bool wants_other_speeds() const noexcept { return wanted_.left != sent_.left || wanted_.right != sent_.right; }
  /// The stop is confirmed.
  void note_rest() noexcept;
  /// The robot is identified, and it stands.
  void note_handshake() noexcept;
  /// The link hung up. False: there was none.
  bool lose_link(const char* why) noexcept;

  SessionTiming timing_;
  Actuation wanted_, sent_;
  hal::TimeNs allowed_ns_ = 0;  // for stalls, of the answer that is awaited
  hal::TimeNs patience_ns_ = 0;
  hal::TimeNs latency_ns_ = 0;  // follows its peaks
  bool handshaking_ = false;
  bool asked_again_ = false;
  bool stop_asked_ = false;  // by `stop`, and not yet confirmed
  bool ending_ = false;      // by `shut_down`
  SessionState state_ = SessionState::Absent;
  const char* trouble_ = "";
  bool at_rest_ = false;
  bool restarted_ = false;  // since the wheel counters were last read
  bool counters_known_ = false;
  bool counters_doubtful_ = false;  // first reading after a handshake
  std::uint64_t epoch_ = 0;
  Packet output_;
  Identity identity_;
  AnswerLayout layout_;
  Samples samples_;
  SessionStatistics statistics_;

 private:
  void take_encoders(const std::array<std::int16_t, 2>& counters, const Measured& when) noexcept;
};

/// The conversation for a wire.
std::unique_ptr<Conversation> make_conversation(WireForm wire, const SessionTiming& timing);

}  // namespace tandem::bridges::epuck
