// Diffusion as projects for ARGoS 3 have it: what `tandem bench argos` steps. Built as a user's library is.
#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/core/utility/math/vector2.h>
#include <argos3/plugins/robots/e-puck/control_interface/ci_epuck_proximity_sensor.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_proximity_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>

using namespace argos;

namespace {

/// Sums the readings as vectors; turns away from a sum that is long, unless it leaves the way ahead free.
template <class Sensor>
class CDiffusion : public CCI_Controller {
 public:
  explicit CDiffusion(const char* sensor) : m_strSensor(sensor) {}

  void Init(TConfigurationNode& node) override {
    m_pcWheels = GetActuator<CCI_DifferentialSteeringActuator>("differential_steering");
    m_pcProximity = GetSensor<Sensor>(m_strSensor);
    GetNodeAttributeOrDefault(node, "alpha", m_cAlpha, m_cAlpha);
    GetNodeAttributeOrDefault(node, "delta", m_fDelta, m_fDelta);
    GetNodeAttributeOrDefault(node, "velocity", m_fWheelVelocity, m_fWheelVelocity);
    m_cGoStraightAngleRange.Set(-ToRadians(m_cAlpha), ToRadians(m_cAlpha));
  }

  void ControlStep() override {
    const typename Sensor::TReadings& tProxReads = m_pcProximity->GetReadings();
    CVector2 cAccumulator;
    for (size_t i = 0; i < tProxReads.size(); ++i) cAccumulator += CVector2(tProxReads[i].Value, tProxReads[i].Angle);
    cAccumulator /= static_cast<Real>(tProxReads.size());
    const CRadians cAngle = cAccumulator.Angle();
    if (m_cGoStraightAngleRange.WithinMinBoundIncludedMaxBoundIncluded(cAngle) && cAccumulator.Length() < m_fDelta)
      m_pcWheels->SetLinearVelocity(m_fWheelVelocity, m_fWheelVelocity);
    else if (cAngle.GetValue() > 0.0)
      m_pcWheels->SetLinearVelocity(m_fWheelVelocity, 0.0);
    else
      m_pcWheels->SetLinearVelocity(0.0, m_fWheelVelocity);
  }

 private:
  std::string m_strSensor;
  CCI_DifferentialSteeringActuator* m_pcWheels = nullptr;
  Sensor* m_pcProximity = nullptr;
  CDegrees m_cAlpha = CDegrees(10.0);
  Real m_fDelta = 0.5;
  Real m_fWheelVelocity = 5.0;
  CRange<CRadians> m_cGoStraightAngleRange;
};

class CEPuckDiffusion : public CDiffusion<CCI_EPuckProximitySensor> {
 public:
  CEPuckDiffusion() : CDiffusion("epuck_proximity") {}
};

class CFootBotDiffusion : public CDiffusion<CCI_FootBotProximitySensor> {
 public:
  CFootBotDiffusion() : CDiffusion("footbot_proximity") {}
};

}  // namespace

REGISTER_CONTROLLER(CEPuckDiffusion, "epuck_diffusion")
REGISTER_CONTROLLER(CFootBotDiffusion, "footbot_diffusion")
