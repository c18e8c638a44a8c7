// Place and orientation in the world.
#ifndef TANDEM_ARGOS3_CI_POSITIONING_SENSOR_H
#define TANDEM_ARGOS3_CI_POSITIONING_SENSOR_H
#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/vector3.h>

namespace argos {

class CCI_PositioningSensor : public CCI_Sensor {
 public:
  struct SReading {
    CVector3 Position;  ///< of the body's base, in m
    CQuaternion Orientation;
  };
  const SReading& GetReading() const { return m_sReading; }

 protected:
  SReading m_sReading;
};

}  // namespace argos

#endif
