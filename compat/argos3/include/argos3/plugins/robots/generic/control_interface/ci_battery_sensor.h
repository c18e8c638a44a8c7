// The battery.
#ifndef TANDEM_ARGOS3_CI_BATTERY_SENSOR_H
#define TANDEM_ARGOS3_CI_BATTERY_SENSOR_H
#include <limits>

#include <argos3/core/control_interface/ci_sensor.h>

namespace argos {

class CCI_BatterySensor : public CCI_Sensor {
 public:
  struct SReading {
    Real AvailableCharge = 1.0;                                 ///< 0 empty to 1 full
    Real TimeLeft = std::numeric_limits<Real>::infinity();  ///< the robot cannot know: infinite
  };
  const SReading& GetReading() const { return m_sReading; }

 protected:
  SReading m_sReading;
};

}  // namespace argos

#endif
