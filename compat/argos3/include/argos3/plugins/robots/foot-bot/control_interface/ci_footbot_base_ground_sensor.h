// The foot-bot's 8 ground sensors around its base.
#ifndef TANDEM_ARGOS3_CI_FOOTBOT_BASE_GROUND_SENSOR_H
#define TANDEM_ARGOS3_CI_FOOTBOT_BASE_GROUND_SENSOR_H
#include <argos3/plugins/robots/generic/control_interface/tandem_readings.h>

namespace argos {

class CCI_FootBotBaseGroundSensor : public tandem_detail::CReadingsSensor<tandem_detail::SGroundReading> {};

}  // namespace argos

#endif
