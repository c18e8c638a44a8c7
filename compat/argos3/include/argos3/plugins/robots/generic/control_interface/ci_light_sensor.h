// Light sensors of any robot.
#ifndef TANDEM_ARGOS3_CI_LIGHT_SENSOR_H
#define TANDEM_ARGOS3_CI_LIGHT_SENSOR_H
#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>

namespace argos {

/// 0 dark to 1. Counter-clockwise from forward.
class CCI_LightSensor : public CCI_Sensor {
 public:
  const std::vector<Real>& GetReadings() const { return m_tReadings; }

 protected:
  std::vector<Real> m_tReadings;
};

}  // namespace argos

#endif
