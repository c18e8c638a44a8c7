// The e-puck's 8 infrared proximity sensors, counter-clockwise from +17 degrees: the real robot counts the other way.
#ifndef TANDEM_ARGOS3_CI_EPUCK_PROXIMITY_SENSOR_H
#define TANDEM_ARGOS3_CI_EPUCK_PROXIMITY_SENSOR_H
#include <argos3/plugins/robots/generic/control_interface/tandem_readings.h>

namespace argos {

class CCI_EPuckProximitySensor : public tandem_detail::CReadingsSensor<tandem_detail::SRingReading> {
 public:
  const SReading& GetReading(UInt16 i) const { return m_tReadings[i]; }
};

}  // namespace argos

#endif
