#include "ants.h"

#include <argos3/core/utility/logging/argos_log.h>

CAnt::CAnt() : m_pcWheels(NULL), m_fVelocity(2.5) {}

void CAnt::Init(TConfigurationNode& t_node) {
  m_pcWheels = GetActuator<CCI_DifferentialSteeringActuator>("differential_steering");
  GetNodeAttribute(GetNode(t_node, "wheels"), "velocity", m_fVelocity);
  RLOG << "is of the " << GetColony() << " ants" << std::endl;
}

void CAnt::ControlStep() {
  m_pcWheels->SetLinearVelocity(m_fVelocity, m_fVelocity);
}

std::string CAnt::GetColony() const {
  return COLONY;
}

REGISTER_CONTROLLER(CAnt, "ant")
