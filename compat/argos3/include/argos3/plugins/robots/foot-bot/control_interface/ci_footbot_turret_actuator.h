// The foot-bot's turret.
#ifndef TANDEM_ARGOS3_CI_FOOTBOT_TURRET_ACTUATOR_H
#define TANDEM_ARGOS3_CI_FOOTBOT_TURRET_ACTUATOR_H
#include <argos3/core/control_interface/ci_actuator.h>
#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/range.h>

namespace argos {

class CCI_FootBotTurretActuator : public CCI_Actuator {
 public:
  enum ETurretModes { MODE_OFF, MODE_PASSIVE, MODE_SPEED_CONTROL, MODE_POSITION_CONTROL };
  static const CRange<SInt32> SPEED_RANGE;
  static const CRange<Real> NORMALIZED_SPEED_RANGE;

  virtual void SetRotation(const CRadians& angle) = 0;
  /// In turns a minute.
  virtual void SetRotationSpeed(SInt32 speed) = 0;
  virtual void SetMode(ETurretModes mode) = 0;
  void SetActiveWithRotation(const CRadians& angle) {
    SetPositionControlMode();
    SetRotation(angle);
  }
  void SetSpeedControlMode() { SetMode(MODE_SPEED_CONTROL); }
  void SetPositionControlMode() { SetMode(MODE_POSITION_CONTROL); }
  void SetPassiveMode() { SetMode(MODE_PASSIVE); }
};

}  // namespace argos

#endif
