// The eye-bot's 24 light sensors.
#ifndef TANDEM_ARGOS3_CI_EYEBOT_LIGHT_SENSOR_H
#define TANDEM_ARGOS3_CI_EYEBOT_LIGHT_SENSOR_H
#include <argos3/plugins/robots/generic/control_interface/tandem_readings.h>

namespace argos {

class CCI_EyeBotLightSensor : public tandem_detail::CReadingsSensor<tandem_detail::SRingReading> {};

}  // namespace argos

#endif
