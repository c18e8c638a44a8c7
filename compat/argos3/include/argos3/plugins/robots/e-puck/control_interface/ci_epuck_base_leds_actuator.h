// The red LEDs of the e-puck's ring.
#ifndef TANDEM_ARGOS3_CI_EPUCK_BASE_LEDS_ACTUATOR_H
#define TANDEM_ARGOS3_CI_EPUCK_BASE_LEDS_ACTUATOR_H
#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/logging/argos_log.h>

namespace argos {

class CCI_EPuckBaseLEDsActuator : public CCI_Actuator {
 public:
  virtual void SwitchLED(size_t led, bool on) = 0;
  virtual void SwitchLEDs(bool on) = 0;
};

}  // namespace argos

#endif
