// The e-puck's 8 light sensors, in the order of its proximity sensors.
#ifndef TANDEM_ARGOS3_CI_EPUCK_LIGHT_SENSOR_H
#define TANDEM_ARGOS3_CI_EPUCK_LIGHT_SENSOR_H
#include <argos3/plugins/robots/generic/control_interface/tandem_readings.h>

namespace argos {

class CCI_EPuckLightSensor : public tandem_detail::CReadingsSensor<tandem_detail::SRingReading> {
 public:
  const SReading& GetReading(UInt16 i) const { return m_tReadings[i]; }
};

}  // namespace argos

#endif
