// Fits the foot-bot's bridge to mixed reality.
#pragma once
#include <memory>

#include "bridges/footbot/bridge.hpp"
#include "hal/log.hpp"
#include "mixed_reality/session/mixed_session.hpp"
#include "mixed_reality/twin/real_robot.hpp"

namespace tandem::mixed_reality {

/// A real foot-bot. The conversation begins with the first `latch`; until then devices can be asked for. The clock is
/// left to the run; messages that its own range-and-bearing board receives are its readings. CLOCK_MONOTONIC is the
/// only clock it may be given.
class RealFootbot final : public RealRobot {
 public:
  RealFootbot(bridges::footbot::BridgeSettings settings, bridges::aseba::MessageLinkOpener opener, const hal::Log& log);

  void latch(const Moment& now) noexcept override;
  LinkHealth health() const noexcept override { return health_; }
  std::string trouble() const override { return bridge_->status().trouble; }
  const void* reading(const hal::PortType& type) const noexcept override;
  bool command(const hal::PortType& type, const void* port) noexcept override;
  void commit(const Moment& now) noexcept override;
  void stop(const Moment& now) noexcept override;
  bool stopped() const noexcept override;
  LinkReport report() const override;

  /// For a guardian; empty as long as no node is there.
  std::vector<bridges::footbot::LastWords> last_words() const { return bridge_->last_words(); }

 private:
  void* port(const hal::PortType& type) const noexcept;

  std::unique_ptr<bridges::footbot::FootbotBridge> bridge_;
  bool started_ = false;
  bool was_active_ = false;
  std::uint64_t interruptions_ = 0;
  LinkHealth health_ = LinkHealth::Connecting;
  bool stop_asked_ = false;
};

/// The maker of real foot-bots for experiment files. Errors: as `footbot_parts`.
hal::Result<std::unique_ptr<RealFootbot>> make_real_footbot(const RealRobotRequest& request, const hal::Log& log);

}  // namespace tandem::mixed_reality
