// Throws where it is told to.
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>

using namespace argos;

class CFaultyLoop : public CLoopFunctions {
 public:
  virtual void Init(TConfigurationNode& t_tree) {
    GetNodeAttribute(t_tree, "where", m_strWhere);
    try {
      if (m_strWhere == "Init") THROW_ARGOSEXCEPTION("the garden is closed");
    } catch (CARGoSException& ex) {
      THROW_ARGOSEXCEPTION_NESTED("cannot begin", ex);
    }
  }
  virtual void Destroy() {
    LOG << "destroyed" << std::endl;
    if (m_strWhere == "Destroy") THROW_ARGOSEXCEPTION("the gate is stuck");
  }
  virtual void PostStep() {
    LOG << "stepped" << std::endl;
    if (m_strWhere == "PostStep") throw std::runtime_error("out of water");
  }

 private:
  std::string m_strWhere;
};

REGISTER_LOOP_FUNCTIONS(CFaultyLoop, "faulty")
