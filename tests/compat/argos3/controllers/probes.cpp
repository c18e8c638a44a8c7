// Controllers that tell what they are given, and how they are called.
#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/rng.h>
#include <argos3/plugins/robots/generic/control_interface/ci_battery_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_leds_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_light_sensor.h>
#include <cmath>
#include <stdexcept>

namespace argos {

/// Tells each call, and counts its steps.
class CLife : public CCI_Controller {
 public:
  void Init(TConfigurationNode&) override { RLOG << "Init" << std::endl; }
  void ControlStep() override { RLOG << "step " << ++m_unSteps << std::endl; }
  void Reset() override {
    RLOG << "Reset after " << m_unSteps << std::endl;
    m_unSteps = 0;
  }
  void Destroy() override { RLOGERR << "Destroy after " << m_unSteps; }

 private:
  UInt32 m_unSteps = 0;
};

/// Throws when its parameter says so.
class CThrower : public CCI_Controller {
 public:
  void Init(TConfigurationNode& t_node) override {
    GetNodeAttribute(t_node, "when", m_strWhen);
    GetNodeAttribute(t_node, "what", m_strWhat);
    Maybe("init");
  }
  void ControlStep() override { Maybe("step"); }
  void Reset() override { Maybe("reset"); }
  void Destroy() override { Maybe("destroy"); }

 private:
  void Maybe(const std::string& strWhere) const {
    if (strWhere != m_strWhen) return;
    if (m_strWhat == "std") throw std::logic_error("a standard one in " + strWhere);
    if (m_strWhat == "int") throw 42;
    try {
      THROW_ARGOSEXCEPTION("the inner reason");
    } catch (CARGoSException& ex) {
      THROW_ARGOSEXCEPTION_NESTED("the outer reason in " << strWhere, ex);
    }
  }
  std::string m_strWhen, m_strWhat;
};

/// Reads nested parameters of many types.
class CParameters : public CCI_Controller {
 public:
  void Init(TConfigurationNode& t_node) override {
    TConfigurationNode& tInner = GetNode(t_node, "wheel_turning");
    Real fReal = 0.0;
    CDegrees cAngle;
    CRange<Real> cRange;
    CVector3 cVector;
    CQuaternion cTurn;
    CColor cColor;
    UInt8 unByte = 0;
    bool bFlag = false;
    GetNodeAttribute(tInner, "real", fReal);
    GetNodeAttribute(tInner, "angle", cAngle);
    GetNodeAttribute(tInner, "range", cRange);
    GetNodeAttribute(tInner, "vector", cVector);
    GetNodeAttribute(tInner, "turn", cTurn);
    GetNodeAttribute(tInner, "color", cColor);
    GetNodeAttribute(tInner, "byte", unByte);
    GetNodeAttribute(tInner, "flag", bFlag);
    LOG << fReal << " " << cAngle << " " << cRange << " " << cVector << " " << cTurn << " " << cColor << " "
        << static_cast<int>(unByte) << " " << std::boolalpha << bFlag << std::noboolalpha << std::endl;
    std::string strNames;
    TConfigurationNodeIterator itItem("item");
    for (itItem = itItem.begin(&t_node); itItem != itItem.end(); ++itItem) {
      std::string strName;
      GetNodeAttribute(*itItem, "name", strName);
      strNames += strName + ";";
    }
    LOG << strNames << " " << NodeExists(t_node, "item") << NodeExists(t_node, "none") << std::endl;
    if (NodeExists(t_node, "wrong")) {
      UInt32 unNumber = 0;
      GetNodeAttribute(GetNode(t_node, "wrong"), "number", unNumber);
    }
  }
};

/// Draws numbers in every step.
class CChance : public CCI_Controller {
 public:
  void Init(TConfigurationNode&) override {
    m_pcFirst = CRandom::CreateRNG("argos");
    m_pcSecond = CRandom::CreateRNG("argos");
  }
  void ControlStep() override {
    LOG << std::setprecision(17) << m_pcFirst->Uniform(CRange<Real>(0.0, 1.0)) << " " << m_pcSecond->Gaussian(1.0)
        << std::endl;
  }

 private:
  CRandom::CRNG* m_pcFirst = nullptr;
  CRandom::CRNG* m_pcSecond = nullptr;
};

/// Asks for what its parameters name.
class CAsking : public CCI_Controller {
 public:
  void Init(TConfigurationNode& t_node) override {
    std::string strName;
    GetNodeAttribute(t_node, "name", strName);
    LOG << "has " << HasSensor(strName) << std::endl;
    GetSensor<CCI_LightSensor>(strName);
  }
};

}  // namespace argos

REGISTER_CONTROLLER(argos::CLife, "life")
REGISTER_CONTROLLER(argos::CThrower, "thrower")
REGISTER_CONTROLLER(argos::CParameters, "parameters")
REGISTER_CONTROLLER(argos::CChance, "chance")
REGISTER_CONTROLLER(argos::CAsking, "asking")
