// The foot-bot's 24 infrared proximity sensors, the first at 7.5 degrees.
#ifndef TANDEM_ARGOS3_CI_FOOTBOT_PROXIMITY_SENSOR_H
#define TANDEM_ARGOS3_CI_FOOTBOT_PROXIMITY_SENSOR_H
#include <argos3/plugins/robots/generic/control_interface/tandem_readings.h>

namespace argos {

class CCI_FootBotProximitySensor : public tandem_detail::CReadingsSensor<tandem_detail::SRingReading> {};

}  // namespace argos

#endif
