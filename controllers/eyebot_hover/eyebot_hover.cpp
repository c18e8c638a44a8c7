#include "controllers/eyebot_hover/eyebot_hover.hpp"

namespace tandem::controllers {

EyebotHover::EyebotHover(hal::Robot& robot, const Params& params)
    : aloft_(robot), position_(robot.actuator<hal::QuadrotorPosition>()), params_(params) {}

void EyebotHover::step() noexcept {
  position_.hover();
  const bool ready = aloft_.ready();
  const hal::Positioning& here = aloft_.place();
  if (!knows_place_ && here.validity == hal::Validity::Fresh) {
    knows_place_ = true;
    for (std::size_t k = 0; k < 3; ++k) place_m_[k] = here.p_WB[k] + params_.offset_m[k];
    place_m_[2] += params_.height_m;
    heading_rad_ = aloft_.heading_rad();
  }
  if (!ready) return;
  const hal::TimeNs now_ns = aloft_.clock().now_ns;
  if (since_ns_ == 0) since_ns_ = now_ns;
  if (params_.duration_s > 0.0 && static_cast<double>(now_ns - since_ns_) * 1e-9 >= params_.duration_s) {
    aloft_.land();
    return;
  }
  position_.set(place_m_[0], place_m_[1], place_m_[2], heading_rad_);
}

}  // namespace tandem::controllers
