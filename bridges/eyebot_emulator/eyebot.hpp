// An eye-bot as its LCM channels show it: messages and times in, messages and times out.
#pragma once
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/emulation/delays.hpp"
#include "bridges/emulation/event_log.hpp"
#include "bridges/eyebot_emulator/battery.hpp"
#include "bridges/eyebot_emulator/body.hpp"
#include "bridges/eyebot_emulator/pilot.hpp"
#include "bridges/eyebot_emulator/supervisor.hpp"
#include "bridges/eyebot_emulator/telemetry.hpp"

namespace tandem::bridges::eyebot_emulator {

/// A message on its way to the hub.
struct Datagram {
  std::string channel{};
  Bytes data{};
  hal::TimeNs at = 0;
};

/// The firmware with its body: a state machine in explicit time, without a clock, thread or file; what it does depends
/// on its inputs alone. Looks at its devices, steers and reports every 10 ms.
///
/// Events for the sink; all have `robot`:
///   boot       session: it is there from now on
///   command    channel, session, seq, utime, age_us (as its own clock sees it), verdict, why, again (a repetition of
///   an
///              order that has been answered), what was asked; state_seq and state_sent_ns of the state that it
///              reported last, first: no other command of this session came since
///   heartbeat  of a hub that was not heard before: name, session
///   control    session of the hub in control from now on; 0: none
///   mode, failsafe  from, to
///   motion     x, y, z, vx, vy, vz, yaw (SI, W), ten times a second while it moves or its motors run
///   landed     speed_m_s: it has come down on the ground
///   lights, pan_tilt, scanner, radio: what the devices do now
///   malformed  channel, why, count of the channel: at most once in ten seconds a channel
///   sent       channel, count, last_seq: at the end, a line a channel
class Eyebot {
 public:
  struct Options {
    std::string name = "eb0";  ///< in the names of channels: letters, digits, _ and -, at most 24
    std::int32_t session = 1;  ///< drawn by its starter; not 0
    bool clock_synced = true;  ///< orders and setpoints whose stamps are 250 ms off are stale
    double flight_s = 600.0;   ///< on a full battery
    double image_hz = 0.0;     ///< 0 to 2
    Fence fence{};
    hal::TimeNs boot_ns = 100 * hal::kNsPerMs;  ///< from power to the first sign of life; deaf meanwhile
    Delays delays{};                            ///< those of the link are its server's
  };

  /// `body` must outlive the robot. Nothing happens before `power_on`.
  Eyebot(const Options& options, EmulatedBody& body, EventSink sink);

  /// `unix_us`: what the robot's clock shows at `at`, in microseconds since the Unix epoch.
  void power_on(hal::TimeNs at, std::int64_t unix_us);
  /// A message has come in at `at`, on whatever channel; others' are ignored. Times of all calls must not decrease.
  void receive(std::string_view channel, std::span<const std::byte> payload, hal::TimeNs at);
  /// Does everything that the robot does until `now`.
  void run_until(hal::TimeNs now);
  /// Moves what is to be sent to the end of `out`.
  void take_sent(std::vector<Datagram>& out);
  /// When `run_until` will have something to do.
  hal::TimeNs next_event() const noexcept { return next_loop_; }
  /// A state report has left the robot at `at`, later than it was made.
  void state_left(hal::TimeNs at) noexcept { state_sent_at_ = at; }
  /// Tells the sink how much was sent on each channel.
  void tell_sent(hal::TimeNs at) const;

  /// Power is lost and comes back: motors off, everything forgotten.
  void restart(std::int32_t session, hal::TimeNs at);
  void jump_clock(std::int64_t by_us) noexcept { clock_us_ += by_us; }
  void set_charge(double charge) noexcept;
  void set_position_lost(bool lost) noexcept { position_lost_ = lost; }
  /// It believes itself so far east of where it is.
  void set_place_error(double east_m) noexcept { place_error_m_ = east_m; }
  void set_hardware_fault(bool fault) noexcept { hardware_fault_ = fault; }
  /// How often the state is reported: `kStateRate_Hz` unless something is wrong.
  void set_state_rate_Hz(int rate) noexcept { state_rate_Hz_ = rate; }
  static constexpr int kStateRate_Hz = 50;

  const Options& options() const noexcept { return options_; }
  /// When it first obeyed a setpoint: its mode became `position` or `velocity`.
  std::optional<hal::TimeNs> first_driven_at() const noexcept { return first_driven_at_; }
  const Supervisor& supervisor() const noexcept { return supervisor_; }
  const BodySenses& senses() const noexcept { return senses_; }
  std::int32_t rejected() const noexcept { return rejected_; }
  const BodyCommand& command() const noexcept { return command_; }
  std::int64_t utime(hal::TimeNs at) const noexcept { return at / 1000 + clock_us_; }

 private:
  struct Traffic {
    std::int32_t next_seq = 0;
    std::int64_t sent = 0;
  };
  struct Damage {
    std::int64_t count = 0;
    hal::TimeNs told_at = 0;
  };

  void loop(hal::TimeNs at);
  void look(hal::TimeNs at);
  void act(hal::TimeNs at);
  void report(hal::TimeNs at);
  void report_rings(hal::TimeNs at);
  void sample_scan(hal::TimeNs at);
  Conditions conditions() const;
  StatusReport status(hal::TimeNs at) const;
  void send(std::string_view topic, hal::TimeNs at, const std::function<Bytes(const Header&)>& write);
  void send_status(hal::TimeNs at) {
    send("status", at, [&](const Header& h) { return write_status(h, status(at)); });
  }

  void hear(const Command& command, std::size_t channel, hal::TimeNs at);
  void hear_hub(const Command& command, hal::TimeNs at);
  void hear_order(const Command& command, hal::TimeNs at);
  Answer decide(const Command& command, std::size_t channel, hal::TimeNs at);
  Answer obey(const CommandBody& body, std::int32_t session, hal::TimeNs at);
  bool is_stale(const Header& header, hal::TimeNs at) const;
  void damaged(std::string_view channel, const std::string& why, hal::TimeNs at);
  void tell_command(const Command& command, std::size_t channel, const Answer& answer, bool again, hal::TimeNs at);
  void tell_changes(hal::TimeNs at);
  void tell_devices(hal::TimeNs at, const BodyCommand& before) const;
  void tell(hal::TimeNs at, std::string_view event, EventFields fields) const;

  Options options_;
  EmulatedBody& body_;
  EventSink sink_;
  std::string prefix_;  // of its channels
  std::int32_t session_;
  Supervisor supervisor_;
  Pilot pilot_;
  Senders senders_;
  EmulatedBattery battery_;
  bool charge_is_set_ = false;
  bool position_lost_ = false;
  double place_error_m_ = 0.0;
  bool hardware_fault_ = false;
  int state_rate_Hz_ = kStateRate_Hz;
  std::int64_t clock_us_ = 0;  // what the clock shows, less the time that it is told

  BodySenses senses_;
  BodyCommand command_;
  DelayLine<BodyCommand> to_body_;
  DelayLine<BodySenses> from_body_;
  std::vector<Heard> heard_;
  std::vector<ScanSample> scan_;
  hal::TimeNs booted_at_ = 0;
  hal::TimeNs next_loop_ = 0;
  hal::TimeNs looked_at_ = 0;
  std::int64_t loops_ = 0;
  std::int64_t flooded_ = 0;

  std::map<std::string, Traffic, std::less<>> traffic_;
  std::map<std::string, Damage, std::less<>> damage_;
  std::vector<Datagram> outbox_;
  std::set<std::int32_t> hubs_;  // sessions that were told of
  Header last_obeyed_{};
  std::optional<hal::TimeNs> last_obeyed_at_{};
  std::int32_t rejected_ = 0;
  std::string text_;
  std::optional<hal::TimeNs> first_driven_at_{};
  std::int32_t state_seq_ = -1;
  hal::TimeNs state_sent_at_ = 0;
  std::int32_t answered_seq_ = -1;      // the last state after which a command has come
  std::int32_t answering_session_ = 0;  // from whom

  // As reported last.
  Mode told_mode_ = Mode::Off;
  Failsafe told_failsafe_ = Failsafe::None;
  std::int32_t told_controller_ = 0;
  bool told_armed_ = false;
};

}  // namespace tandem::bridges::eyebot_emulator
