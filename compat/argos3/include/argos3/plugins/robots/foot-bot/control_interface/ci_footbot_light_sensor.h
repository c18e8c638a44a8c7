// The foot-bot's 24 light sensors, the first at 7.5 degrees.
#ifndef TANDEM_ARGOS3_CI_FOOTBOT_LIGHT_SENSOR_H
#define TANDEM_ARGOS3_CI_FOOTBOT_LIGHT_SENSOR_H
#include <argos3/plugins/robots/generic/control_interface/tandem_readings.h>

namespace argos {

class CCI_FootBotLightSensor : public tandem_detail::CReadingsSensor<tandem_detail::SRingReading> {};

}  // namespace argos

#endif
