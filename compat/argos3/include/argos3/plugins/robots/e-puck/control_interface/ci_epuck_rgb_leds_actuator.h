// The three coloured LEDs of the e-puck's upper board.
#ifndef TANDEM_ARGOS3_CI_EPUCK_RGB_LEDS_ACTUATOR_H
#define TANDEM_ARGOS3_CI_EPUCK_RGB_LEDS_ACTUATOR_H
#include <vector>

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/logging/argos_log.h>

namespace argos {

class CCI_EPuckRGBLEDsActuator : public CCI_Actuator {
 public:
  typedef std::vector<CColor> TLEDSettings;

  virtual void SetColor(size_t led, const CColor& color) = 0;
  virtual void SetColors(const CColor& color) = 0;
  virtual void SetColors(const TLEDSettings& colors) = 0;

 protected:
  TLEDSettings m_tLEDSettings;
};

}  // namespace argos

#endif
