#include "settings.h"

#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_light_sensor.h>

template <typename T>
void CSettings::Tell(const std::string& str_key, const T& t_value) const {
   LOG << "RESULT " << GetId() << "." << str_key << " " << t_value << std::endl;
}

void CSettings::STurning::Init(TConfigurationNode& t_node) {
   try {
      CDegrees cAngle;
      GetNodeAttribute(t_node, "hard_threshold", cAngle);
      HardThreshold = ToRadians(cAngle);
      CRange<CDegrees> cRange(CDegrees(-10.0), CDegrees(10.0));
      GetNodeAttributeOrDefault(t_node, "go_straight", cRange, cRange);
      GoStraight.Set(ToRadians(cRange.GetMin()), ToRadians(cRange.GetMax()));
      GetNodeAttribute(t_node, "max_speed", MaxSpeed);
   } catch (CARGoSException& ex) {
      THROW_ARGOSEXCEPTION_NESTED("Error initializing the turning parameters.", ex);
   }
}

void CSettings::SNoise::Init(TConfigurationNode& t_node) {
   GetNodeAttribute(t_node, "range", Range);
   GetNodeAttribute(t_node, "corner", Corner);
   GetNodeAttribute(t_node, "place", Place);
   GetNodeAttributeOrDefault(t_node, "color", Color, CColor::RED);
}

void CSettings::Init(TConfigurationNode& t_node) {
   m_sTurning.Init(GetNode(t_node, "turning"));
   m_sNoise.Init(GetNode(t_node, "noise"));
   Tell("hard", ToDegrees(m_sTurning.HardThreshold).GetValue());
   Tell("straight", ToDegrees(m_sTurning.GoStraight.GetMin()).GetValue());
   Tell("speed", m_sTurning.MaxSpeed);
   Tell("range", m_sNoise.Range);
   Tell("corner", m_sNoise.Corner.GetX() + m_sNoise.Corner.GetY());
   Tell("place", m_sNoise.Place.GetX() + m_sNoise.Place.GetY() + m_sNoise.Place.GetZ());
   Tell("color", m_sNoise.Color);

   bool bLazy = true;
   GetNodeAttribute(t_node, "lazy", bLazy);
   UInt8 unCount = 0;
   GetNodeAttribute(t_node, "count", unCount);
   SInt32 nOffset = 0;
   GetNodeAttribute(t_node, "offset", nOffset);
   std::string strName;
   GetNodeAttributeOrDefault<std::string>(t_node, "name", strName, "nameless");
   UInt32 unOther = 0;
   GetNodeAttributeOrDefault(t_node, "not_there", unOther, 12u);
   Tell("plain", ToString(bLazy) + " " + ToString(static_cast<UInt32>(unCount)) + " " + ToString(nOffset) + " " +
                     strName + " " + ToString(unOther));
   Tell("exists", ToString(NodeExists(t_node, "noise")) + ToString(NodeExists(t_node, "silence")) +
                      ToString(NodeAttributeExists(t_node, "lazy")));

   std::string strPoints;
   Real fSum = 0.0;
   TConfigurationNodeIterator itPoint("point");
   TConfigurationNode& tPath = GetNode(t_node, "path");
   for (itPoint = itPoint.begin(&tPath); itPoint != itPoint.end(); ++itPoint) {
      CVector2 cPoint;
      GetNodeAttribute(*itPoint, "at", cPoint);
      fSum += cPoint.Length();
      GetNodeAttributeOrDefault(*itPoint, "name", strName, std::string("?"));
      strPoints += strName;
   }
   Tell("points", strPoints + " " + ToString(fSum));
   std::string strKinds;
   TConfigurationNodeIterator itAny;
   for (itAny = itAny.begin(&t_node); itAny != itAny.end(); ++itAny) {
      strKinds += " " + itAny->Value();
   }
   Tell("children", strKinds.substr(1));
   Errors(t_node);
}

void CSettings::Errors(TConfigurationNode& t_node) {
   try {
      UInt32 unNothing;
      GetNodeAttribute(t_node, "not_there", unNothing);
      Tell("missing_attribute", "read");
   } catch (CARGoSException& ex) {
      Tell("missing_attribute", std::string(ex.what()).find("not_there") != std::string::npos);
   }
   try {
      GetNode(t_node, "nowhere");
      Tell("missing_node", "found");
   } catch (CARGoSException& ex) {
      Tell("missing_node", std::string(ex.what()).find("nowhere") != std::string::npos);
   }
   try {
      Real fValue;
      GetNodeAttribute(t_node, "lazy", fValue);
      Tell("no_number", "read");
   } catch (std::exception&) {
      Tell("no_number", "exception");
   }
   try {
      GetSensor<CCI_LightSensor>("light");
      Tell("missing_sensor", "there");
   } catch (CARGoSException& ex) {
      Tell("missing_sensor", std::string(ex.what()).find("light") != std::string::npos);
   }
   try {
      GetActuator<CCI_DifferentialSteeringActuator>("leds");
      Tell("wrong_type", "cast");
   } catch (CARGoSException&) {
      Tell("wrong_type", "CARGoSException");
   }
   Tell("has",
        ToString(HasActuator("leds")) + ToString(HasActuator("differential_steering")) + ToString(HasSensor("light")));
   try {
      try {
         THROW_ARGOSEXCEPTION("inner " << 5);
      } catch (CARGoSException& ex) {
         THROW_ARGOSEXCEPTION_NESTED("outer " << 6, ex);
      }
   } catch (std::exception& ex) {
      const std::string strWhat = ex.what();
      Tell("nested", strWhat.find("outer 6") < strWhat.find("inner 5"));
   }
}

REGISTER_CONTROLLER(CSettings, "settings_controller")
