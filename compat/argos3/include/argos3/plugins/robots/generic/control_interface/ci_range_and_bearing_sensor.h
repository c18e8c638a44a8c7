// Messages received in this tick.
#ifndef TANDEM_ARGOS3_CI_RANGE_AND_BEARING_SENSOR_H
#define TANDEM_ARGOS3_CI_RANGE_AND_BEARING_SENSOR_H
#include <vector>

#include <argos3/core/control_interface/ci_sensor.h>
#include <argos3/core/utility/datatypes/byte_array.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/quaternion.h>

namespace argos {

class CCI_RangeAndBearingSensor : public CCI_Sensor {
 public:
  struct SPacket {
    Real Range = 0.0;            ///< in cm
    CRadians HorizontalBearing;  ///< counter-clockwise from forward
    CRadians VerticalBearing;    ///< upwards
    CByteArray Data;
  };
  typedef std::vector<SPacket> TReadings;

  const TReadings& GetReadings() const { return m_tReadings; }

 protected:
  TReadings m_tReadings;
};

}  // namespace argos

#endif
