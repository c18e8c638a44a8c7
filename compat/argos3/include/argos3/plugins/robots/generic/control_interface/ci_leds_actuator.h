// Coloured LEDs.
#ifndef TANDEM_ARGOS3_CI_LEDS_ACTUATOR_H
#define TANDEM_ARGOS3_CI_LEDS_ACTUATOR_H
#include <vector>

#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/datatypes/color.h>

namespace argos {

/// A foot-bot has 12 around its rim and, as number 12, its beacon.
class CCI_LEDsActuator : public CCI_Actuator {
 public:
  typedef std::vector<CColor> TSettings;

  size_t GetNumLEDs() const { return m_tSettings.size(); }
  /// @throws CARGoSException for an LED that the robot does not have, here and below
  virtual void SetSingleColor(UInt32 led, const CColor& color) = 0;
  virtual void SetAllColors(const CColor& color) = 0;
  virtual void SetAllColors(const TSettings& colors) = 0;
  /// 0 is dark, 255 the full colour.
  virtual void SetSingleIntensity(UInt32 led, UInt8 intensity) = 0;
  virtual void SetAllIntensities(UInt8 intensity) = 0;

 protected:
  TSettings m_tSettings;
};

}  // namespace argos

#endif
