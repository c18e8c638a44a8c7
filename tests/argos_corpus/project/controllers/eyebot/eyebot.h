/*
 * Eye-bot: takes off, flies to a place, hovers there.
 */
#ifndef CORPUS_EYEBOT_H
#define CORPUS_EYEBOT_H

#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/plugins/robots/generic/control_interface/ci_leds_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_positioning_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_quadrotor_position_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_sensor.h>

using namespace argos;

class CEyeBot : public CCI_Controller {
public:
   enum EState { STATE_START = 0, STATE_TAKE_OFF, STATE_GO, STATE_HOVER };

   CEyeBot();
   virtual void Init(TConfigurationNode& t_node);
   virtual void ControlStep();
   virtual void Reset();

private:
   void TakeOff();
   void Go();

   CCI_QuadRotorPositionActuator* m_pcFlight;
   CCI_PositioningSensor* m_pcPosition;
   CCI_LEDsActuator* m_pcLEDs;
   CCI_RangeAndBearingActuator* m_pcRABAct;
   CCI_RangeAndBearingSensor* m_pcRABSens;
   EState m_eState;
   CVector3 m_cStart, m_cGoal;
   Real m_fHeight;
   UInt32 m_unStep, m_unHeard;
};

#endif
