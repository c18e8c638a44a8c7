#include "order.h"

#include <argos3/core/utility/logging/argos_log.h>

std::string COrder::Calls;

void COrder::Init(argos::TConfigurationNode&) {
   m_pcWheels = GetActuator<argos::CCI_DifferentialSteeringActuator>("differential_steering");
   m_pcPosition = GetSensor<argos::CCI_PositioningSensor>("positioning");
   Calls += " controller.Init";
}

void COrder::ControlStep() {
   m_cSensed = m_pcPosition->GetReading().Position;
   m_pcWheels->SetLinearVelocity(10.0f, 10.0f);
   Calls += " ControlStep";
}

void COrder::Reset() {
   Calls += " controller.Reset";
}

using namespace argos;
REGISTER_CONTROLLER(COrder, "order_controller")
