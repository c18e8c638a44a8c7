// Takes off, stays at a place whatever pushes it, and lands when its time is up.
#pragma once
#include <array>

#include "controllers/flight/aloft.hpp"
#include "hal/controller.hpp"

namespace tandem::controllers {

/// Rises from where it stands to a height over that place, or over another one, and keeps it and its heading: pushed
/// away, it comes back. While nothing is known of where it is, it hovers.
class EyebotHover final : public hal::Controller {
 public:
  struct Params {
    double height_m = 1.0;
    std::array<double, 3> offset_m{};
    double duration_s = 0.0;
    void describe(hal::ParamVisitor& v) {
      v.number("height", height_m, hal::unit::m, {0.1, 100.0}, "Of its base, over where it took off.");
      v.vector("offset", offset_m, hal::unit::m, "Of the place from above where it took off; in W.");
      v.number("duration", duration_s, hal::unit::s, hal::kNotNegative,
               "In the air, before it lands; 0: it does not land.");
    }
  };

  EyebotHover(hal::Robot& robot, const Params& params);

  void step() noexcept override;

 private:
  Aloft aloft_;
  hal::QuadrotorPosition& position_;
  Params params_;
  bool knows_place_ = false;
  std::array<double, 3> place_m_{};
  double heading_rad_ = 0.0;
  hal::TimeNs since_ns_ = 0;
};

}  // namespace tandem::controllers
