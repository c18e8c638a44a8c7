// Base of all actuators that controllers see.
#ifndef TANDEM_ARGOS3_CI_ACTUATOR_H
#define TANDEM_ARGOS3_CI_ACTUATOR_H
#include <map>
#include <string>

#include <argos3/core/simulator/not_carried_over.h>
#include <argos3/core/utility/configuration/base_configurable_resource.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CCI_Actuator : public CBaseConfigurableResource {
 public:
  typedef std::map<std::string, CCI_Actuator*, std::less<std::string> > TMap;

  CCI_Actuator();
  virtual ~CCI_Actuator();
  virtual void Init(TConfigurationNode&) {}
  virtual void Reset() {}
  virtual void Destroy() {}
};

}  // namespace argos

#define REGISTER_ACTUATOR(...) ARGOS3_NOT_CARRIED_OVER("own actuators: make a plug-in with a device of ours (docs/plugins.md)")

#endif
