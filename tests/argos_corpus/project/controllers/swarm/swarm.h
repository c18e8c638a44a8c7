/*
 * A swarm that holds together by range and bearing alone: each robot is pulled and pushed by its neighbors as by springs with a
 * target distance.
 */
#ifndef CORPUS_SWARM_H
#define CORPUS_SWARM_H

#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/core/utility/math/vector2.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_sensor.h>

using namespace argos;

class CSwarm : public CCI_Controller {
public:
   /* Lennard-Jones potential of neighbors */
   struct SInteraction {
      Real TargetDistance;
      Real Gain;
      Real Exponent;
      void Init(TConfigurationNode& t_node);
      Real Force(Real f_distance) const;
   };

   struct SWheels {
      CRadians HardTurn;
      Real MaxSpeed;
      void Init(TConfigurationNode& t_node);
   };

   CSwarm();
   virtual void Init(TConfigurationNode& t_node);
   virtual void ControlStep();
   virtual void Reset();

private:
   CVector2 Neighbors() const;
   void Drive(const CVector2& c_heading);

   CCI_DifferentialSteeringActuator* m_pcWheels;
   CCI_RangeAndBearingActuator* m_pcRABAct;
   CCI_RangeAndBearingSensor* m_pcRABSens;
   SInteraction m_sInteraction;
   SWheels m_sWheels;
};

#endif
