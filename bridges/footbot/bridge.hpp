// A real foot-bot behind the control interface, with its own I/O thread.
//
//   FootbotBridge bridge(settings, opener, log);
//   controller = type.construct(memory, bridge.robot(), params);   // takes its ports: they decide what is asked for
//   bridge.start();
//   each tick:  bridge.latch(tick, now);  controller step;  bridge.commit(now);
//   ~FootbotBridge: the robot is stopped.
//
// The thread takes in what arrives, answers time-outs, opens the link anew when it was lost, and stops the robot when
// the loop stops committing. Modules have no watchdog: when the link is cut while the robot moves, it drives on until
// the link is back; when this process is killed, until a guardian (bridges/guardian), where one was started, stops it.
// A program on the motors' modules that sets the speed to 0 when nothing was written for a while is the only remedy.
#pragma once
#include <atomic>
#include <vector>

#include "bridges/aseba/reopening_messages.hpp"
#include "bridges/driver_bridge.hpp"
#include "bridges/footbot/driver.hpp"

namespace tandem::bridges::footbot {

struct BridgeSettings {
  DriverSettings driver;
  std::string link = {};                          ///< as the experiment says it, for whoever stops the robot without us
  hal::TimeNs shutdown_ns = 300 * hal::kNsPerMs;  ///< how long the end waits for the robot to confirm its stop
};

/// A copy of everything that can be told about the bridge.
struct BridgeStatus {
  RobotState state = RobotState::Absent;
  std::string trouble;       ///< why it is not active, or what is missing; `link_trouble` when there is some
  std::string link_trouble;  ///< the opener's message, when it has failed since the link was last open
  std::string link;
  bool stopped = false;  ///< by `stop`
  bool at_rest = false;  ///< and the robot has confirmed it
  std::vector<NodeStatus> nodes;
  DriverStatistics driver;
  WiringStatistics wiring;
  aseba::NetworkStatistics network;
  aseba::MessageLinkStatistics messages;  ///< over all links that were opened
  std::uint64_t links_opened = 0;
};

/// Owns link and thread.
class FootbotBridge final : public DriverBridge<FootbotBridge, FootbotRobot> {
 public:
  /// `opener` is called from threads of the bridge, from now on, and again whenever the link is gone. Times given to
  /// the bridge are CLOCK_MONOTONIC.
  FootbotBridge(BridgeSettings settings, aseba::MessageLinkOpener opener, hal::Log log = {});
  /// Stops the robot, waits at most `shutdown_ns` for it to confirm, closes the link.
  ~FootbotBridge() override;

  /// Errors: not active within `timeout_ns`; says what is known (link does not open, which node is missing …).
  hal::Status wait_active(hal::TimeNs timeout_ns);

  bool at_rest() const noexcept override;
  std::string trouble() const override;
  std::string advice() const override;
  /// The modules that are there.
  std::string identity() const override;
  std::string link() const override;
  /// The body is that of stop_body.hpp.
  StopMessages stop_messages() const override;
  std::uint64_t stop_version() const noexcept override { return stop_version_; }
  LinkReport report() const override;
  void describe(StatusVisitor& visitor) const override;

  // What a loop asks in every tick; `status` copies much more.
  BridgeStatus status() const;

 private:
  friend DriverBridge;
  void before_start();
  void run();
  Interruptions interruptions() const noexcept;
  void after_command(hal::TimeNs) noexcept { stop_version_ = driver_.wiring().rest_version(); }
  void run_shutdown();
  /// Waits for input without holding the link, at most `timeout_ns`.
  void wait_outside(hal::TimeNs timeout_ns, int descriptor);

  BridgeSettings settings_;
  aseba::ReopeningMessages link_;
  FootbotDriver driver_;
  std::atomic<std::uint64_t> stop_version_{0};
};

}  // namespace tandem::bridges::footbot
