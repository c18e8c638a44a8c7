// One eye-bot without threads: what it says becomes readings, commands become what it is told, safety lies between;
// driven by the owner of the time.
//
//   absent --a heartbeat--> ready --its status, a valid place, and no other hub for 300 ms--> active
//   active --three heartbeats missing, or its status, or a second robot of its name, or a new start of it, or its own
//            fail-safe--> suspect --all is well--> active
//   active, suspect --no heartbeat for two seconds--> lost --it beats again--> active
//
// A tick of the caller:   latch(tick, now) -> controller step -> commit(now)
// Between ticks, whenever something came or `next_deadline()` is due: pump(now).
// Commands leave within `commit`.
//
// A robot in the air must not be left to itself, and never with its motors off:
//   not active, or no commit for `command_timeout_ns` -> hover, until the next commit
//   it was restarted, saved itself, its clock was set -> counted as a stop, even when it is well at once
//   `stop`                                            -> hover until `resume`; land when its battery is low
//   `land`                                            -> land, then motors off
//   command not finite, or beyond the limits          -> hover, or clamped; counted
//   nothing of ours reaches it                        -> it hovers by itself after 2 s, and lands after 10 s
//   another hub commands it, and it is not ours       -> nothing is said to it
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bridges/bridged_robot.hpp"
#include "bridges/clock_estimator.hpp"
#include "bridges/eyebot/flight_plan.hpp"
#include "bridges/eyebot/inbox.hpp"
#include "bridges/eyebot/liveness.hpp"
#include "bridges/eyebot/mode_orders.hpp"
#include "bridges/eyebot/place_gate.hpp"
#include "bridges/eyebot/topic.hpp"
#include "bridges/eyebot/world_frame.hpp"
#include "bridges/eyebot_messages/messages.hpp"
#include "bridges/link/stall_meter.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/log.hpp"
#include "hal/robot/eyebot.hpp"

namespace tandem::bridges::eyebot {

/// Every port class that an eye-bot has: sensors first. Range-and-bearing and distance scanner are in both halves.
const std::vector<const hal::PortType*>& port_types();

class EyebotRobot final : public BridgedRobot {
 public:
  explicit EyebotRobot(RobotSettings settings)
      : BridgedRobot("eye-bot", hal::eyebot::kind(), std::move(settings), port_types()) {
    never_had = " that can be reached over LCM";
  }
};

enum class RobotState : std::uint8_t { Absent, Ready, Active, Suspect, Lost };
const char* state_name(RobotState state) noexcept;

// How often it is told again what it was told.
inline constexpr hal::TimeNs kBeat = 200 * hal::kNsPerMs;
inline constexpr hal::TimeNs kVelocityAgain = 100 * hal::kNsPerMs;
inline constexpr hal::TimeNs kPositionAgain = 500 * hal::kNsPerMs;

/// Destination of commands.
class Outbox {
 public:
  virtual ~Outbox() = default;
  /// False: the system did not take it.
  virtual bool publish(const std::string& channel, std::span<const std::byte> data) noexcept = 0;
};

/// Nanoseconds since 1970 by this machine's clock.
hal::TimeNs unix_ns() noexcept;

struct DriverSettings {
  RobotSettings robot = {};
  std::string name;          ///< in the robot's channels; "": `robot.id`
  std::string hub;           ///< in the channel of our heartbeat; "": "tandem-" and the session
  std::int32_t session = 1;  ///< ours, a number that no other start of any hub has; not 0
  WorldFrame world = {};
  /// The robot hovers when no commit came for so long: the loop hangs, or the controller does.
  hal::TimeNs command_timeout_ns = 500 * hal::kNsPerMs;
  bool observe = false;        ///< nothing is ever said
  std::int32_t first_seq = 0;  ///< of every channel
  bool controlled = false;     ///< `session` has been given control of the robot before
  hal::TimeNs (*unix_clock)() noexcept = &unix_ns;
};

struct DriverStatistics {
  std::uint64_t commits = 0;
  std::uint64_t said = 0;             ///< messages
  std::uint64_t unsent = 0;           ///< that the system did not take
  std::uint64_t not_understood = 0;   ///< messages of the robot that are damaged
  std::uint64_t clamped = 0;          ///< commands beyond the robot's limits
  std::uint64_t not_finite = 0;       ///< commands with NaN or infinity: made safe
  std::uint64_t rearmed = 0;          ///< times that flying started again after an interruption
  std::uint64_t watchdog_stops = 0;   ///< for want of commits
  std::uint64_t link_stops = 0;       ///< because the robot was not active any more, or had restarted by itself
  std::uint64_t saved_itself = 0;     ///< times that it went to safety: not for a command that came late
  std::uint64_t recovered = 0;        ///< times it became Active again
  std::uint64_t lost = 0;             ///< times it became Lost
  std::uint64_t stalls = 0;           ///< times that our own thread came too late
  std::uint64_t refused_control = 0;  ///< orders refused because another hub controls the robot
};

/// The robot's last report of itself.
struct FlightStatus {
  bool known = false;
  Mode mode = Mode::Off;
  bool armed = false, magnet_on = false;
  hal::FlightFailsafe failsafe = hal::FlightFailsafe::None;
  std::int32_t rejected = 0;  ///< commands, since its start
  hal::TimeNs taken_ns = 0;   ///< when it was so, by our clock
};

/// Not thread-safe, but that others may deliver into the inbox.
class EyebotDriver {
 public:
  /// `inbox` and `outbox` must outlive this.
  EyebotDriver(DriverSettings settings, Inbox& inbox, Outbox& outbox, hal::Log log = {});
  EyebotDriver(const EyebotDriver&) = delete;
  EyebotDriver& operator=(const EyebotDriver&) = delete;

  /// To construct a controller with, and to take further ports from.
  EyebotRobot& robot() noexcept { return robot_; }
  const EyebotRobot& robot() const noexcept { return robot_; }

  /// Fills the ports that were taken with the newest values.
  void latch(hal::Tick tick, hal::TimeNs now) noexcept;
  /// Filters the commands and says what has changed, or is due to be said again.
  void commit(hal::TimeNs now) noexcept;
  /// Takes in what has arrived, applies time-outs, says what is due. Never waits.
  void pump(hal::TimeNs now) noexcept;
  hal::TimeNs next_deadline() const noexcept;
  /// The link is dead: whoever is at the end of the next one is told nothing to fly by before the next commit.
  void link_gone() noexcept { interrupt(); }

  /// Hovers now, and until `resume`.
  void stop(hal::TimeNs now) noexcept;
  void resume() noexcept { set_goal(Goal::Obey, 0); }
  /// Lands, and switches the motors off on the ground. One that hangs at the ceiling stays there. Until `resume`.
  void land(hal::TimeNs now) noexcept;
  /// Its battery is so low that it should not stay in the air.
  bool battery_low() const noexcept;

  RobotState state() const noexcept { return state_; }
  bool stopped() const noexcept { return goal_ != Goal::Obey; }
  /// After `stop` or `land`: the robot has said since that nothing drives it on, or it is not ours.
  bool at_rest() const noexcept { return goal_ != Goal::Obey && reached_; }
  /// After `land`: it stands or hangs with its motors off, or it is not ours.
  bool landed() const noexcept { return goal_ == Goal::Land && reached_; }
  bool controlled() const noexcept { return controlled_; }
  /// Why it is not Active, or what else is amiss; for people.
  std::string trouble() const;

  const DriverSettings& settings() const noexcept { return settings_; }
  const DriverStatistics& statistics() const noexcept { return statistics_; }
  const FlightStatus& status() const noexcept { return status_; }
  const Liveness& liveness() const noexcept { return liveness_; }
  const ClockEstimator& clock() const noexcept { return clock_; }
  const ModeOrders& orders() const noexcept { return orders_; }
  const PlaceGate& places() const noexcept { return place_gate_; }
  /// Goes on with numbers that are so much newer: another has spoken in our name meanwhile. The order that is out
  /// is given again.
  void skip_ahead(std::uint32_t by) noexcept;

 private:
  /// What is said on one channel.
  struct Voice {
    std::string channel;
    std::int32_t seq = 0;  // of the next message
    hal::TimeNs said_ns = 0;
    std::array<std::byte, 256> bytes{};
    std::size_t size = 0;  // 0: nothing was said yet
  };
  /// The newest message of a topic. `next` is for decoding.
  template <class Message>
  struct Newest {
    Message message{};
    Message next{};
  };
  struct Newests {
    Newest<eyebot_messages::Heartbeat> heartbeat;
    Newest<eyebot_messages::Status> status;
    Newest<eyebot_messages::State> state;
    Newest<eyebot_messages::Altitude> altitude;
    Newest<eyebot_messages::Battery> battery;
    Newest<eyebot_messages::Scan> scan;
    Newest<eyebot_messages::Rab> rab;
    Newest<eyebot_messages::Prox> prox;
    Newest<eyebot_messages::Light> light;
    Newest<eyebot_messages::PanTilt> pan_tilt;
    Newest<eyebot_messages::Blobs> blobs;
    Newest<eyebot_messages::Ack> ack;
  };

  /// When, by our clock, the newest values of a topic were taken; 0: none came.
  hal::TimeNs& taken(Topic topic) noexcept { return taken_ns_[static_cast<std::size_t>(topic)]; }
  hal::TimeNs taken(Topic topic) const noexcept { return taken_ns_[static_cast<std::size_t>(topic)]; }
  Voice& voice(Told told) noexcept { return voices_[static_cast<std::size_t>(told)]; }

  /// Before lines of the log.
  std::string who() const { return "eye-bot '" + settings_.robot.id + "': "; }

  // What it says.
  void take_all(hal::TimeNs now);
  template <class Message, class... Use>
  void take_in(Topic topic, Newest<Message>& newest, hal::TimeNs now, Use... use);
  bool accept(const eyebot_messages::Header& header, hal::TimeNs received_ns);
  void complain(Topic topic, const char* flaw, hal::TimeNs now);
  void use_ack(hal::TimeNs received_ns);
  void use_status();
  void use_state();
  void begin_anew();
  void interrupt() noexcept;
  void watch_clock();
  void watch_own_clock(hal::TimeNs now) noexcept;
  void report_silence(hal::TimeNs now);
  template <class Port, class Message>
  void fill(Topic topic, const Newest<Message>& newest, hal::TimeNs now) noexcept;
  void fill_flight(hal::TimeNs now) noexcept;

  // What it does.
  void advance(hal::TimeNs now) noexcept;
  RobotState judge(hal::TimeNs now) const noexcept;
  bool others_robot(hal::TimeNs now) const noexcept;
  void update_state(hal::TimeNs now);
  bool overdue(hal::TimeNs now) const noexcept;
  Goal goal(hal::TimeNs now) const noexcept;
  void note_order() noexcept;
  void guide(hal::TimeNs now) noexcept;
  void set_goal(Goal goal, hal::TimeNs now) noexcept;
  void end_flying() noexcept;
  std::string missing_readings() const;
  std::string refused_order() const;

  // Its commands.
  void count(const hal::Limited& limited) noexcept;
  void say_setpoint(hal::TimeNs now) noexcept;
  void say_devices(hal::TimeNs now) noexcept;
  void say_order(hal::TimeNs now) noexcept;
  void say_heartbeat(hal::TimeNs now) noexcept;
  template <class Message>
  void say(Told told, Message& message, hal::TimeNs again_ns, hal::TimeNs now) noexcept;
  void send(Voice& voice, hal::TimeNs now) noexcept;
  hal::TimeNs stamp_ns(hal::TimeNs now) const noexcept;

  DriverSettings settings_;
  Inbox& inbox_;
  Outbox& outbox_;
  hal::Log log_;
  EyebotRobot robot_;
  Liveness liveness_;
  ClockEstimator clock_;
  ModeOrders orders_;
  DriverStatistics statistics_;
  std::array<Voice, kTold> voices_;

  Letter letter_;
  Newests newests_;
  std::array<hal::TimeNs, kTopics> taken_ns_{};
  const hal::Quadrotor& flight_;
  PlaceGate place_gate_;
  eyebot_messages::State place_{};  // the newest whose place was valid and is believed, taken at
  hal::TimeNs place_taken_ns_ = 0;
  hal::TimeNs exchanged_ns_ = 0;             // when it last answered an order
  std::uint64_t clock_jumps_ = 0;            // that were noticed
  std::optional<hal::TimeNs> own_clock_ns_;  // how far this machine's clock is ahead of CLOCK_MONOTONIC
  bool robots_clock_ = false;                // commands are stamped by the robot's clock: it refuses those by ours
  bool silence_told_ = false;
  hal::RangeAndBearing heard_;  // since the last `latch`
  hal::TimeNs complained_ns_ = 0;

  RobotState state_ = RobotState::Absent;
  bool was_active_ = false;
  FlightStatus status_;
  bool controlled_ = false;
  bool doubts_control_ = false;  // it did not go where we told it: perhaps another hub's
  bool refused_ = false;         // another hub controls it

  Goal goal_ = Goal::Obey;
  hal::TimeNs goal_since_ns_ = 0;
  bool reached_ = false;  // the goal, while it is not to obey
  bool steers_ = false;   // flight is commanded
  hal::FlightOrder order_ = hal::FlightOrder::Fly;
  float order_m_s_ = 0.0F;
  bool pending_ = false;
  bool may_fly_ = false;
  Action ordered_ = Action::Nop;     // which was said last
  Told setpoint_ = Told::Heartbeat;  // which was said last; Heartbeat: none
  bool interrupted_ = false;         // the next flying starts again
  StallMeter stalls_;
  hal::TimeNs now_ns_ = 0;  // of the last `advance`
  bool committed_ = false;
  hal::TimeNs last_commit_ns_ = 0;

  eyebot_messages::Heartbeat own_heartbeat_{};
  eyebot_messages::Leds leds_{};
  eyebot_messages::CmdRab radio_{};
  std::int64_t started_ns_ = 0;
};

}  // namespace tandem::bridges::eyebot
