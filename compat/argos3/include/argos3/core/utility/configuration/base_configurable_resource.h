// What a file configures.
#ifndef TANDEM_ARGOS3_BASE_CONFIGURABLE_RESOURCE_H
#define TANDEM_ARGOS3_BASE_CONFIGURABLE_RESOURCE_H
#include <argos3/core/utility/configuration/argos_configuration.h>

namespace argos {

class CBaseConfigurableResource {
 public:
  virtual ~CBaseConfigurableResource() {}
  virtual void Init(TConfigurationNode& tree) = 0;
  virtual void Reset() = 0;
  virtual void Destroy() = 0;
};

}  // namespace argos

#endif
