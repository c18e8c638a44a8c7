// The e-puck's battery.
#ifndef TANDEM_ARGOS3_CI_EPUCK_BATTERY_SENSOR_H
#define TANDEM_ARGOS3_CI_EPUCK_BATTERY_SENSOR_H
#include <argos3/core/control_interface/ci_sensor.h>

namespace argos {

class CCI_EPuckBatterySensor : public CCI_Sensor {
 public:
  /// 0 empty to 1 full.
  Real GetBatteryLevel() const { return m_fBatteryLevel; }

 protected:
  Real m_fBatteryLevel = 1.0;
};

}  // namespace argos

#endif
