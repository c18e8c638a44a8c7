#include "bridges/eyebot/shutdown_sequence.hpp"

namespace tandem::bridges::eyebot {

bool ShutdownSequence::step(EyebotDriver& driver, hal::TimeNs now) noexcept {
  if (driver.settings().observe) return true;
  if (stage_ == Stage::Begin) {
    stage_ = Stage::Hover;
    begun_ns_ = since_ns_ = now;
    driver.stop(now);
  } else {
    driver.pump(now);
  }
  if (!driver.status().known) return now - begun_ns_ >= settings_.find_ns;
  if (stage_ == Stage::Hover) {
    if (!driver.at_rest() && now - since_ns_ < settings_.hover_ns) return false;
    stage_ = settings_.land ? Stage::Land : Stage::End;
    since_ns_ = now;
    if (settings_.land) driver.land(now);
  }
  if (stage_ == Stage::Land && (driver.landed() || now - since_ns_ >= settings_.land_ns)) stage_ = Stage::End;
  return stage_ == Stage::End;
}

}  // namespace tandem::bridges::eyebot
