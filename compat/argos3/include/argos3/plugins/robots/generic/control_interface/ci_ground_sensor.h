// Ground sensors of any robot.
#ifndef TANDEM_ARGOS3_CI_GROUND_SENSOR_H
#define TANDEM_ARGOS3_CI_GROUND_SENSOR_H
#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>

namespace argos {

/// 0 black to 1 white.
class CCI_GroundSensor : public CCI_Sensor {
 public:
  const std::vector<Real>& GetReadings() const { return m_tReadings; }

 protected:
  std::vector<Real> m_tReadings;
};

}  // namespace argos

#endif
