// A real eye-bot behind the control interface, with its own I/O thread.
//
//   EyebotBridge bridge(settings, opener, log);
//   controller = type.construct(memory, bridge.robot(), params);   // takes its ports: they decide what is told
//   bridge.start();
//   each tick:  bridge.latch(tick, now);  controller step;  bridge.commit(now);
//   ~EyebotBridge: the robot hovers, then lands.
//
// The thread takes in what arrives, beats the hub's heart, says again what is not answered, reopens the link when
// our own heartbeat does not come back to us, and has the robot hover when the loop stops committing. When this process
// is killed its guardian (bridges/guardian) has the robot hover and land; without one, the robot does so
// itself.
#pragma once
#include <atomic>
#include <functional>
#include <memory>

#include "bridges/driver_bridge.hpp"
#include "bridges/eyebot/driver.hpp"
#include "bridges/eyebot/shutdown_sequence.hpp"
#include "bridges/lcm/lcm_link.hpp"
#include "bridges/send_permit.hpp"

namespace tandem::bridges::eyebot {

/// Opens the LCM link, or shares one that is open already.
using LcmOpener = std::function<hal::Result<std::shared_ptr<lcm_bus::LcmLink>>()>;

struct BridgeSettings {
  DriverSettings driver;  ///< session 0: one is drawn
  ShutdownSettings shutdown = {};
  std::string url = {};    ///< of the link, as the next to open it must write it
  SendPermit permit = {};  ///< asked before everything that is said
};

/// A copy of everything known about the bridge.
struct BridgeStatus {
  RobotState state = RobotState::Absent;
  std::string trouble;       ///< why it is not active, or what is amiss; `link_trouble` when there is some
  std::string link_trouble;  ///< why there is no link
  std::string link;
  bool stopped = false;  ///< by `stop` or `fault`
  bool at_rest = false;  ///< and the robot has confirmed it
  bool landed = false;
  FlightStatus flight;
  std::string name;
  std::int32_t session = 0;  ///< the robot's
  std::uint64_t restarts = 0, other_senders = 0;
  bool controlled = false;
  std::uint64_t clock_jumps = 0;
  DriverStatistics driver;
  OrderStatistics orders;
  TopicStatistics messages;
  std::array<TopicStatistics, kTopics> topics;
  std::uint64_t links_opened = 0;
};

/// For a guardian: all that it takes to go on in the hub's name.
struct StopDetails {
  std::string url;
  std::string name;
  std::string hub;
  std::int32_t session = 0;
  bool land = true;
  std::int32_t first_seq = 0;  ///< newer than any number of ours for years
};

/// Owns the thread.
class EyebotBridge final : public DriverBridge<EyebotBridge, EyebotRobot>, private Outbox {
 public:
  /// `opener` is called by the bridge's thread, and again whenever the link is dead. Times given to the bridge are
  /// CLOCK_MONOTONIC.
  EyebotBridge(BridgeSettings settings, LcmOpener opener, hal::Log log = {});
  /// Has the robot hover and land, as the settings say, and waits as long as they say.
  ~EyebotBridge() override;

  void land(hal::TimeNs now) noexcept override;

  std::string advice() const override { return "is it switched on, in the same network, and called so?"; }
  /// The body is that of stop_body.hpp.
  StopMessages stop_messages() const override;
  std::uint64_t stop_version() const noexcept override;
  LinkReport report() const override;
  void describe(StatusVisitor& visitor) const override;

  // What a loop asks in every tick; `status` copies much more.
  BridgeStatus status() const;
  StopDetails stop_details() const;

 private:
  /// What handlers of the link write to; theirs as long as the link lives.
  struct Mail {
    Inbox inbox;
    std::atomic<hal::TimeNs> echo_ns{0};  // our own heartbeat came back
  };

  bool publish(const std::string& channel, std::span<const std::byte> data) noexcept override;
  friend DriverBridge;
  void run();
  void wake() { mail_->inbox.wake(); }
  Interruptions interruptions() const noexcept;
  void before_latch(hal::TimeNs now) noexcept { driver_.pump(now); }
  void keep_link();
  hal::Result<std::shared_ptr<lcm_bus::LcmLink>> open();
  void run_shutdown();
  std::string noun() const { return "eye-bot"; }
  const std::string& link_trouble() const { return link_trouble_; }
  std::string robot_trouble() const { return driver_.trouble(); }
  std::string silence() const { return driver_.trouble(); }
  RobotIdentity who() const;

  BridgeSettings settings_;
  LcmOpener opener_;
  std::shared_ptr<Mail> mail_;
  std::shared_ptr<lcm_bus::LcmLink> link_;
  std::string link_trouble_;
  std::uint32_t turn_ = 0;  // of the permit, when the link was opened
  std::atomic<std::uint32_t> withdrawals_{0};
  hal::TimeNs opened_ns_ = 0, tried_ns_ = 0;
  std::uint64_t links_opened_ = 0;
  EyebotDriver driver_;
};

}  // namespace tandem::bridges::eyebot
