// Base of all sensors that controllers see.
#ifndef TANDEM_ARGOS3_CI_SENSOR_H
#define TANDEM_ARGOS3_CI_SENSOR_H
#include <map>
#include <string>

#include <argos3/core/simulator/not_carried_over.h>
#include <argos3/core/utility/configuration/base_configurable_resource.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

class CCI_Sensor : public CBaseConfigurableResource {
 public:
  typedef std::map<std::string, CCI_Sensor*, std::less<std::string> > TMap;

  CCI_Sensor();
  virtual ~CCI_Sensor();
  virtual void Init(TConfigurationNode&) {}
  virtual void Reset() {}
  virtual void Destroy() {}
  /// Most sensors read whether they are enabled or not; those that do not say so.
  virtual void Enable();
  virtual void Disable();
  bool IsEnabled() const { return m_bEnabled; }
  bool IsDisabled() const { return !m_bEnabled; }

 protected:
  bool m_bEnabled;
};

}  // namespace argos

#define REGISTER_SENSOR(...) ARGOS3_NOT_CARRIED_OVER("own sensors: make a plug-in with a device of ours (docs/plugins.md)")

#endif
