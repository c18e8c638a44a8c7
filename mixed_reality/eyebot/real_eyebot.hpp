// Fits the eye-bot's bridge to mixed reality.
#pragma once
#include <memory>

#include "bridges/eyebot/bridge.hpp"
#include "hal/log.hpp"
#include "mixed_reality/session/mixed_session.hpp"
#include "mixed_reality/settings/eyebot_parts.hpp"
#include "mixed_reality/twin/real_robot.hpp"

namespace tandem::mixed_reality {

/// A real eye-bot. The conversation begins with the first `latch`; until then devices can be asked for. The clock is
/// left to the run; messages that its own range-and-bearing board receives are its readings. To stop is to hover; once
/// that is confirmed it lands, if it is to, without anybody's waiting but the destructor's. CLOCK_MONOTONIC is the only
/// clock it may be given.
class RealEyebot final : public RealRobot {
 public:
  RealEyebot(bridges::eyebot::BridgeSettings settings, bridges::eyebot::LcmOpener opener, std::string url,
             const hal::Log& log);

  void latch(const Moment& now) noexcept override;
  LinkHealth health() const noexcept override { return health_; }
  std::string trouble() const override { return bridge_->status().trouble; }
  const void* reading(const hal::PortType& type) const noexcept override;
  bool command(const hal::PortType& type, const void* port) noexcept override;
  void commit(const Moment& now) noexcept override;
  void stop(const Moment& now) noexcept override;
  bool stopped() const noexcept override;
  LinkReport report() const override;

  /// For a guardian.
  bridges::eyebot::LastWords last_words() const { return bridge_->last_words(url_); }

 private:
  void* port(const hal::PortType& type) const noexcept;

  std::string url_;
  bool land_;  // at the end
  std::unique_ptr<bridges::eyebot::EyebotBridge> bridge_;
  bool started_ = false;
  bool was_active_ = false;
  std::uint64_t interruptions_ = 0;
  LinkHealth health_ = LinkHealth::Connecting;
  bool stop_asked_ = false;
  bool stop_confirmed_ = false;
};

/// The maker of real eye-bots for experiment files. Errors: as `eyebot_parts`.
hal::Result<std::unique_ptr<RealEyebot>> make_real_eyebot(const RealRobotRequest& request, const hal::Log& log);

}  // namespace tandem::mixed_reality
