// The foot-bot's 4 ground sensors between its tracks.
#ifndef TANDEM_ARGOS3_CI_FOOTBOT_MOTOR_GROUND_SENSOR_H
#define TANDEM_ARGOS3_CI_FOOTBOT_MOTOR_GROUND_SENSOR_H
#include <argos3/plugins/robots/generic/control_interface/tandem_readings.h>

namespace argos {

class CCI_FootBotMotorGroundSensor : public tandem_detail::CReadingsSensor<tandem_detail::SGroundReading> {};

}  // namespace argos

#endif
