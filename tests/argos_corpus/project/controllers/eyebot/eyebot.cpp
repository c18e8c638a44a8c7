#include "eyebot.h"

#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/logging/argos_log.h>

CEyeBot::CEyeBot()
    : m_pcFlight(NULL),
      m_pcPosition(NULL),
      m_pcLEDs(NULL),
      m_pcRABAct(NULL),
      m_pcRABSens(NULL),
      m_eState(STATE_START),
      m_fHeight(1.5f),
      m_unStep(0),
      m_unHeard(0) {}

void CEyeBot::Init(TConfigurationNode& t_node) {
   try {
      m_pcFlight = GetActuator<CCI_QuadRotorPositionActuator>("quadrotor_position");
      m_pcPosition = GetSensor<CCI_PositioningSensor>("positioning");
   } catch (CARGoSException& ex) {
      RLOGERR << "has not its devices" << std::endl;
      THROW_ARGOSEXCEPTION_NESTED("Error initializing the eye-bot \"" << GetId() << "\"", ex);
   }
   if (HasActuator("leds")) {
      m_pcLEDs = GetActuator<CCI_LEDsActuator>("leds");
   }
   if (HasActuator("range_and_bearing")) {
      m_pcRABAct = GetActuator<CCI_RangeAndBearingActuator>("range_and_bearing");
      m_pcRABSens = GetSensor<CCI_RangeAndBearingSensor>("range_and_bearing");
   }
   GetNodeAttributeOrDefault(t_node, "height", m_fHeight, m_fHeight);
   GetNodeAttributeOrDefault(t_node, "offset", m_cGoal, m_cGoal);
   Reset();
}

void CEyeBot::Reset() {
   m_eState = STATE_START;
   m_unStep = 0;
   m_unHeard = 0;
}

void CEyeBot::TakeOff() {
   if (m_eState != STATE_TAKE_OFF) {
      m_eState = STATE_TAKE_OFF;
      m_cStart = m_pcPosition->GetReading().Position;
   }
   const CVector3 cTarget(m_cStart.GetX(), m_cStart.GetY(), m_fHeight);
   m_pcFlight->SetAbsolutePosition(cTarget);
   m_pcFlight->SetAbsoluteYaw(CRadians::ZERO);
   if (Abs(m_pcPosition->GetReading().Position.GetZ() - m_fHeight) < 0.05) {
      m_eState = STATE_GO;
      RLOG << "RESULT " << GetId() << ".took_off yes" << std::endl;
   }
}

void CEyeBot::Go() {
   const CVector3 cTarget(m_cStart.GetX() + m_cGoal.GetX(), m_cStart.GetY() + m_cGoal.GetY(), m_fHeight);
   m_pcFlight->SetAbsolutePosition(cTarget);
   if (m_eState == STATE_GO && Distance(m_pcPosition->GetReading().Position, cTarget) < 0.05) {
      m_eState = STATE_HOVER;
      RLOG << "RESULT " << GetId() << ".arrived yes" << std::endl;
   }
}

void CEyeBot::ControlStep() {
   ++m_unStep;
   switch (m_eState) {
      case STATE_START:
      case STATE_TAKE_OFF: TakeOff(); break;
      case STATE_GO:
      case STATE_HOVER: Go(); break;
   }
   if (m_pcLEDs != NULL) {
      m_pcLEDs->SetAllColors(m_eState == STATE_HOVER ? CColor::GREEN : CColor::RED);
   }
   if (m_pcRABAct != NULL) {
      m_pcRABAct->SetData(0, m_eState);
      m_unHeard = Max<UInt32>(m_unHeard, m_pcRABSens->GetReadings().size());
   }
   if (m_unStep == 290) {
      const CVector3& cPosition = m_pcPosition->GetReading().Position;
      LOG << "RESULT " << GetId() << ".x_m " << cPosition.GetX() << std::endl;
      LOG << "RESULT " << GetId() << ".y_m " << cPosition.GetY() << std::endl;
      LOG << "RESULT " << GetId() << ".z_m " << cPosition.GetZ() << std::endl;
      LOG << "RESULT " << GetId() << ".state " << m_eState << std::endl;
      LOG << "RESULT " << GetId() << ".heard " << m_unHeard << std::endl;
   }
}

REGISTER_CONTROLLER(CEyeBot, "eyebot_controller")
