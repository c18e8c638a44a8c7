#include "hal/spec/robots.hpp"

#include "hal/spec/epuck.hpp"
#include "hal/spec/eyebot.hpp"
#include "hal/spec/footbot.hpp"

namespace tandem::hal {

void register_robots(Registrar& registrar) {
  for (const DataSheet* sheet : {&epuck::kDataSheet, &eyebot::kDataSheet, &footbot::kDataSheet}) registrar.add(*sheet);
}

}  // namespace tandem::hal
