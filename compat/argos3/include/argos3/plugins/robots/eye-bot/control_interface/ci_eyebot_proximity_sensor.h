// The eye-bot's 24 proximity sensors.
#ifndef TANDEM_ARGOS3_CI_EYEBOT_PROXIMITY_SENSOR_H
#define TANDEM_ARGOS3_CI_EYEBOT_PROXIMITY_SENSOR_H
#include <argos3/plugins/robots/generic/control_interface/tandem_readings.h>

namespace argos {

class CCI_EyeBotProximitySensor : public tandem_detail::CReadingsSensor<tandem_detail::SRingReading> {};

}  // namespace argos

#endif
