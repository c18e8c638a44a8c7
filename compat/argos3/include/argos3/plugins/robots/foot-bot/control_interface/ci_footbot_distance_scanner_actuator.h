// Motor of the foot-bot's distance scanner.
#ifndef TANDEM_ARGOS3_CI_FOOTBOT_DISTANCE_SCANNER_ACTUATOR_H
#define TANDEM_ARGOS3_CI_FOOTBOT_DISTANCE_SCANNER_ACTUATOR_H
#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/math/angles.h>

namespace argos {

class CCI_FootBotDistanceScannerActuator : public CCI_Actuator {
 public:
  virtual void SetAngle(const CRadians& angle) = 0;
  /// In turns a minute.
  virtual void SetRPM(Real rpm) = 0;
  /// Measures; it does not at the start.
  virtual void Enable() = 0;
  virtual void Disable() = 0;
};

}  // namespace argos

#endif
