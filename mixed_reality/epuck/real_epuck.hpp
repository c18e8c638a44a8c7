// Fits the e-puck's bridge to mixed reality.
#pragma once
#include <memory>

#include "bridges/epuck/bridge.hpp"
#include "hal/log.hpp"
#include "mixed_reality/session/mixed_session.hpp"
#include "mixed_reality/twin/real_robot.hpp"

namespace tandem::mixed_reality {

/// A real e-puck. The conversation begins with the first `latch`; until then devices can be asked for.
/// Its range-and-bearing is left to the twin, and the clock to the run. CLOCK_MONOTONIC is the only clock it may be
/// given.
class RealEpuck final : public RealRobot {
 public:
  /// `firmware`: which one it must run (auto: any); a robot with another one never becomes Active.
  RealEpuck(bridges::epuck::BridgeSettings settings, bridges::LinkOpener opener, const hal::Log& log,
            std::string firmware = "auto");

  void latch(const Moment& now) noexcept override;
  LinkHealth health() const noexcept override { return health_; }
  std::string trouble() const override;
  const void* reading(const hal::PortType& type) const noexcept override;
  bool command(const hal::PortType& type, const void* port) noexcept override;
  void commit(const Moment& now) noexcept override;
  void stop(const Moment& now) noexcept override;
  bool stopped() const noexcept override;
  LinkReport report() const override;

 private:
  void* port(const hal::PortType& type) const noexcept;

  std::unique_ptr<bridges::epuck::EpuckBridge> bridge_;
  std::string firmware_;
  bool wrong_firmware_ = false;
  bool started_ = false;
  bool was_active_ = false;
  std::uint64_t handshakes_ = 0;
  LinkHealth health_ = LinkHealth::Connecting;
  bool stop_asked_ = false;
  std::uint64_t resynchronised_at_stop_ = 0;
  std::uint64_t confirmed_at_stop_ = 0;
};

/// The maker of real robots for experiment files: e-pucks on serial links.
/// Errors: another kind of robot, or a link that is no serial one.
hal::Result<std::unique_ptr<RealRobot>> make_real_robot(const RealRobotRequest& request, const hal::Log& log);

}  // namespace tandem::mixed_reality
