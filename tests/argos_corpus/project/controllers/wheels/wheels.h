/*
 * Drives with constant wheel speeds for a time, then stands, and reports its odometry.
 * Runs on foot-bots and e-pucks, simulated or real.
 */
#ifndef CORPUS_WHEELS_H
#define CORPUS_WHEELS_H

#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_sensor.h>

using namespace argos;

class CWheels : public CCI_Controller {
public:
   CWheels();
   virtual ~CWheels() {}

   virtual void Init(TConfigurationNode& t_node);
   virtual void ControlStep();
   virtual void Reset();
   virtual void Destroy();

   /* Asked by the loop functions, both in cm */
   inline Real GetLeftDistance() const {
      return m_fLeftDistance;
   }
   inline Real GetRightDistance() const {
      return m_fRightDistance;
   }
   inline UInt32 GetSteps() const {
      return m_unSteps;
   }
   inline void SetSpeeds(Real f_left, Real f_right) {
      m_fLeft = f_left;
      m_fRight = f_right;
   }

private:
   CCI_DifferentialSteeringActuator* m_pcWheels;
   CCI_DifferentialSteeringSensor* m_pcEncoder;
   Real m_fLeft, m_fRight;
   Real m_fLeftDistance, m_fRightDistance;
   UInt32 m_unSteps;
   UInt32 m_unUntil;
};

#endif
