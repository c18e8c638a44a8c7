#ifndef WALKER_H
#define WALKER_H
#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/plugins/robots/foot-bot/control_interface/ci_footbot_base_ground_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_positioning_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_sensor.h>

using namespace argos;

/// Drives straight on and remembers what it has seen. Sends, where it can, messages that begin with 7.
class CWalker : public CCI_Controller {
 public:
  virtual void Init(TConfigurationNode& t_tree);
  virtual void ControlStep();
  virtual void Reset() {
    m_unSteps = 0;
    ++m_unResets;
  }

  CVector3 m_cSeen;
  Real m_fFloor = -1;
  Real m_fSpeed = 5;
  UInt32 m_unSteps = 0;
  UInt32 m_unResets = 0;
  UInt32 m_unClock = 0;
  CCI_RangeAndBearingSensor::TReadings m_tHeard;

 private:
  void Watch();
  bool m_bWatches = false;
  CCI_DifferentialSteeringActuator* m_pcWheels = nullptr;
  CCI_PositioningSensor* m_pcPlace = nullptr;
  CCI_FootBotBaseGroundSensor* m_pcGround = nullptr;
  CCI_RangeAndBearingActuator* m_pcSend = nullptr;
  CCI_RangeAndBearingSensor* m_pcHear = nullptr;
};

#endif
