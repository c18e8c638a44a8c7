// Foot-bots that flash in unison, as fireflies do.
#pragma once
#include "hal/controller.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/leds.hpp"

namespace tandem::controllers {

/// Each robot counts through a period, flashes red with all its LEDs at the end, and starts again. While it sees a red
/// light it counts faster, the more so the farther its own count is: who is a little late jumps to the end and flashes
/// with the others. Such oscillators fall into step [Mirollo and Strogatz 1990, "Synchronization of pulse-coupled
/// biological oscillators", SIAM J. Appl. Math. 50(6)], on robots that see their neighbours alone as well [Christensen
/// et al. 2009, "From fireflies to fault-tolerant swarms of robots", IEEE Trans. Evol. Comput. 13(4)]. It stands still,
/// and starts at a count of its own chance. Without a fresh picture it keeps its own time.
class FootbotSynchronization final : public hal::Controller {
 public:
  struct Params {
    double period_s = 5.0;
    double flash_s = 0.5;
    double coupling = 0.06;
    void describe(hal::ParamVisitor& v) {
      v.number("period", period_s, hal::unit::s, {0.1, 1e6}, "Between flashes of a robot that sees no other.");
      v.number("flash", flash_s, hal::unit::s, {0.0, 1e6}, "How long a flash lasts; at least one tick.");
      v.number("coupling", coupling, hal::unit::none, {0.0, 1.0},
               "In each tick that it sees a flash, the part by which its count grows at once.");
    }
  };

  FootbotSynchronization(hal::Robot& robot, const Params& params);

  void step() noexcept override;

 private:
  bool sees_flash() const noexcept;

  const hal::OmnidirectionalCamera& camera_;
  const hal::Clock& clock_;
  hal::RingLeds& leds_;
  Params params_;
  double count_;                  // 0 to 1, of the period
  hal::TimeNs dark_from_ns_ = 0;  // end of the flash
};

}  // namespace tandem::controllers
