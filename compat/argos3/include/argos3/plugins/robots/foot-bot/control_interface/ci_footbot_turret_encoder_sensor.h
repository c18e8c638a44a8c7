// Angle of the foot-bot's turret.
#ifndef TANDEM_ARGOS3_CI_FOOTBOT_TURRET_ENCODER_SENSOR_H
#define TANDEM_ARGOS3_CI_FOOTBOT_TURRET_ENCODER_SENSOR_H
#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/range.h>

namespace argos {

class CCI_FootBotTurretEncoderSensor : public CCI_Sensor {
 public:
  static const CRange<CRadians> ANGULAR_RANGE;
  const CRadians& GetRotation() const { return m_cRotation; }

 protected:
  CRadians m_cRotation;
};

}  // namespace argos

#endif
