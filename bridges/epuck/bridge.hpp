// A real e-puck behind the control interface, with its own I/O thread.
//
//   EpuckBridge bridge(settings, opener, log);
//   controller = type.construct(memory, bridge.robot(), params);   // takes its ports: they decide what is asked for
//   bridge.start();                                                 // opens the link, shakes hands, makes the first
//   reading if (auto ready = bridge.wait_active(5 s); !ready) … each tick:  bridge.latch(tick, now);  controller step;
//   bridge.commit(now);      (bridge.fault(now, what) if it threw) ~EpuckBridge: the robot is stopped.
//
// The thread stamps bytes when they arrive, answers time-outs, reopens the link when it was lost, and stops the
// robot when the loop stops committing. The stock firmware has no watchdog of its own: when the link is cut while the
// robot moves, it drives on until the link is back; when this process is killed, until a guardian (bridges/guardian),
// where one was started, stops it. Keep speeds small where that matters.
#pragma once
#include <memory>

#include "bridges/driver_bridge.hpp"
#include "bridges/epuck/driver.hpp"
#include "bridges/epuck/link.hpp"
#include "bridges/link/link_text.hpp"

namespace tandem::bridges::epuck {

struct BridgeSettings {
  DriverSettings driver;
  std::string link = {};                          ///< as the experiment says it, to stop the robot without us
  std::string firmware = "auto";                  ///< which one it must run; with another one it never becomes Active
  hal::TimeNs reopen_ns = 100 * hal::kNsPerMs;    ///< between tries to open the link
  hal::TimeNs shutdown_ns = 300 * hal::kNsPerMs;  ///< how long the end waits for the robot to confirm its stop
};

/// Timing for a link of this name: Bluetooth (rfcomm) devices and those in a network answer late.
SessionTiming timing_for(std::string_view link_name) noexcept;

/// A copy of everything known about the bridge.
struct BridgeStatus {
  SessionState state = SessionState::Absent;
  std::string trouble;   ///< why it is not active; the opener's message when the link does not open
  std::string link;      ///< "" while there is none
  bool stopped = false;  ///< by `stop` or `fault`
  Identity identity;
  AnswerLayout layout;
  Samples samples;
  Odometry odometry;
  SessionStatistics session;
  DriverStatistics driver;
  LinkStatistics bytes;  ///< over all links that were opened
  std::uint64_t links_opened = 0;
};

/// Owns link and thread.
class EpuckBridge final : public DriverBridge<EpuckBridge, EpuckRobot> {
 public:
  /// `opener` is called from threads of the bridge, again after each hang-up. Times given to the bridge are
  /// CLOCK_MONOTONIC.
  EpuckBridge(BridgeSettings settings, LinkOpener opener, hal::Log log = {});
  /// Stops the robot, waits at most `shutdown_ns` for it to confirm, closes the link.
  ~EpuckBridge() override;

  bool mismatched() const noexcept override;
  bool at_rest() const noexcept override;
  std::string advice() const override;
  StopMessages stop_messages() const override;
  std::uint64_t stop_version() const noexcept override;
  LinkReport report() const override;
  void describe(StatusVisitor& visitor) const override;

  Odometry odometry() const noexcept;
  BridgeStatus status() const;

 private:
  friend DriverBridge;
  void run();
  Interruptions interruptions() const noexcept;
  bool is_another() const noexcept;
  void after_command(hal::TimeNs now) noexcept { pump_now(now); }
  std::unique_ptr<ByteLink> open_link();
  void serve(ByteLink& link);
  void run_shutdown(ByteLink& link);
  void pump_now(hal::TimeNs now) noexcept;
  bool wants_new_link() const noexcept;
  void note_link(ByteLink& link);
  std::string noun() const { return "e-puck"; }
  const std::string& link_trouble() const { return link_error_; }
  std::string robot_trouble() const;
  std::string silence() const;
  RobotIdentity who() const;

  BridgeSettings settings_;
  LinkOpener opener_;
  hal::Log log_;
  EpuckDriver driver_;
  ByteLink* link_ = nullptr;  // while served
  std::string link_error_;
  RobotIdentity reached_;        // by the last link that was opened, without the robot's own words
  LinkStatistics bytes_before_;  // of links that are gone
};

}  // namespace tandem::bridges::epuck
