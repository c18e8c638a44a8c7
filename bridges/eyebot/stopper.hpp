// Stops an eye-bot whose hub is gone: has it hover, and land where that was its hub's will.
#pragma once
#include "bridges/eyebot/stop_body.hpp"
#include "bridges/guardian/stopper.hpp"

namespace tandem::bridges::eyebot {

/// Speaks in the hub's name, with newer numbers than the hub's. Confirmed once the robot says that it hovers or stands,
/// and, where its hub will not come back, that it has landed. A robot that a frozen hub leaves hovering lands by itself
/// after 10 s.
class EyebotStopper final : public guardian::Stopper, private Outbox {
 public:
  EyebotStopper(const StopDetails& details, guardian::StopCause cause);

  guardian::StopState step(hal::TimeNs now) override;
  std::string trouble() const override { return link_trouble_.empty() ? driver_.trouble() : link_trouble_; }

 private:
  bool open();
  bool publish(const std::string& channel, std::span<const std::byte> data) noexcept override;

  StopDetails details_;
  bool land_;
  std::shared_ptr<Inbox> inbox_;
  EyebotDriver driver_;
  std::shared_ptr<lcm_bus::LcmLink> link_;
  hal::TimeNs opened_ns_ = 0;
  hal::TimeNs begun_ns_ = 0;  // to have it hover
  std::string link_trouble_;
};

/// Understands bodies as `to_stop_body` makes them.
const guardian::StopperType& stopper_type() noexcept;

}  // namespace tandem::bridges::eyebot
