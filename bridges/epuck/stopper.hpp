// Stops an e-puck whose hub is gone: opens its serial line and repeats the stop until the robot confirms it.
#pragma once
#include "bridges/epuck/stop.hpp"
#include "bridges/guardian/stopper.hpp"
#include "bridges/link/link.hpp"

namespace tandem::bridges::epuck {

/// The stop procedure over a link that is opened again whenever it hangs up.
class EpuckStopper final : public guardian::Stopper {
 public:
  EpuckStopper(LinkOpener opener, const StopTiming& timing) : opener_(std::move(opener)), procedure_(timing) {}

  guardian::StopState step(hal::TimeNs now) override;
  std::string trouble() const override { return trouble_; }

 private:
  bool open(hal::TimeNs now);
  void hang_up();

  LinkOpener opener_;
  StopProcedure procedure_;
  std::unique_ptr<ByteLink> link_;
  std::string trouble_;
};

/// Understands stop messages without a body: the link says all.
const guardian::StopperType& stopper_type() noexcept;

}  // namespace tandem::bridges::epuck
