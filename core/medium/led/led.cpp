#include "core/medium/led/led.hpp"

#include <cmath>

namespace tandem::core {

/// As far as cameras see; nothing where there are none.
void LedMedium::index(const SpaceStores& s) {
  double reach_m = 0.0;
  for (const RobotGroup& group : s.groups) {
    if (const MediumUse* use = group.use_of(*this); use != nullptr) reach_m = std::max(reach_m, use->reach_m);
  }
  if (reach_m == 0.0) return;
  double farthest2 = 0.0;
  bool any = false;
  bool movable = false;
  for (const Object& o : s.objects) {
    if (o.leds.empty() || !o.alive) continue;
    any = true;
    movable = movable || o.movable;
    for (const ObjectLed& led : o.leds) farthest2 = std::max(farthest2, led.x_m * led.x_m + led.y_m * led.y_m);
  }
  if (!any && objects_.empty()) return;
  reach_m += std::sqrt(farthest2);
  if (!movable && reach_m == reach_m_ && immovables_version_ == s.immovables_version &&
      leds_version_ == s.object_leds_version)
    return;
  objects_.build_lit(s.objects, movable, s.min_x_m, s.min_y_m, s.max_x_m, s.max_y_m, reach_m);
  reach_m_ = reach_m;
  immovables_version_ = s.immovables_version;
  leds_version_ = s.object_leds_version;
}

void register_led_medium(hal::Registrar& registrar) {
  static constexpr MediumType kType{
      LedMedium::kKind,
      "Light of LEDs and lamps. Cameras that name a medium see its LEDs alone, and those that name none.",
      [](hal::ParamVisitor&) {}, []() -> std::unique_ptr<Medium> { return std::make_unique<LedMedium>(); }};
  registrar.add(kType);
}

}  // namespace tandem::core
