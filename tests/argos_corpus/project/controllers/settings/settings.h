/*
 * Reads nested parameters the way controllers with several parameter structs do, and reports them.
 */
#ifndef CORPUS_SETTINGS_H
#define CORPUS_SETTINGS_H

#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/math/angles.h>
#include <argos3/core/utility/math/range.h>
#include <argos3/core/utility/math/vector2.h>
#include <argos3/core/utility/math/vector3.h>

using namespace argos;

class CSettings : public CCI_Controller {
public:
   struct STurning {
      CRadians HardThreshold;
      CRange<CRadians> GoStraight;
      Real MaxSpeed;
      void Init(TConfigurationNode& t_node);
   };

   struct SNoise {
      CRange<Real> Range;
      CVector2 Corner;
      CVector3 Place;
      CColor Color;
      void Init(TConfigurationNode& t_node);
   };

   virtual void Init(TConfigurationNode& t_node);

private:
   void Errors(TConfigurationNode& t_node);
   template <typename T>
   void Tell(const std::string& str_key, const T& t_value) const;

   STurning m_sTurning;
   SNoise m_sNoise;
};

#endif
