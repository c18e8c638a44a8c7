// Turns away from what is near, as projects for ARGoS do: on an e-puck, and on a foot-bot.
#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/math/rng.h>
#include <argos3/core/utility/math/vector2.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_proximity_sensor.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_wheels_actuator.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_proximity_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>

using namespace argos;

namespace {

template <class Sensor>
class CWalker : public CCI_Controller {
 public:
  explicit CWalker(const std::string& sensor) : m_strSensor(sensor) {}
  void Init(TConfigurationNode& t_node) override {
    m_pcWheels = GetActuator<CCI_DifferentialSteeringActuator>("differential_steering");
    m_pcProximity = GetSensor<Sensor>(m_strSensor);
    GetNodeAttributeOrDefault(t_node, "velocity", m_fVelocity, m_fVelocity);
    GetNodeAttributeOrDefault(t_node, "alpha", m_cAlpha, m_cAlpha);
    m_cGoStraight.Set(-ToRadians(m_cAlpha), ToRadians(m_cAlpha));
  }
  void ControlStep() override {
    CVector2 cAccumulator;
    for (size_t i = 0; i < m_pcProximity->GetReadings().size(); ++i)
      cAccumulator += CVector2(m_pcProximity->GetReadings()[i].Value, m_pcProximity->GetReadings()[i].Angle);
    cAccumulator /= static_cast<Real>(m_pcProximity->GetReadings().size());
    const CRadians cAngle = cAccumulator.Angle();
    if (m_cGoStraight.WithinMinBoundIncludedMaxBoundIncluded(cAngle) && cAccumulator.Length() < 0.1)
      m_pcWheels->SetLinearVelocity(m_fVelocity, m_fVelocity);
    else if (cAngle.GetValue() > 0.0)
      m_pcWheels->SetLinearVelocity(m_fVelocity, 0.0);
    else
      m_pcWheels->SetLinearVelocity(0.0, m_fVelocity);
  }

 private:
  std::string m_strSensor;
  CCI_DifferentialSteeringActuator* m_pcWheels = nullptr;
  Sensor* m_pcProximity = nullptr;
  CDegrees m_cAlpha{10.0};
  CRange<CRadians> m_cGoStraight;
  Real m_fVelocity = 5.0;
};

class CEPuckWalker : public CWalker<CCI_EPuckProximitySensor> {
 public:
  CEPuckWalker() : CWalker("epuck_proximity") {}
};
class CFootBotWalker : public CWalker<CCI_FootBotProximitySensor> {
 public:
  CFootBotWalker() : CWalker("footbot_proximity") {}
};

}  // namespace

REGISTER_CONTROLLER(CEPuckWalker, "epuck_walker")
REGISTER_CONTROLLER(CFootBotWalker, "footbot_walker");
