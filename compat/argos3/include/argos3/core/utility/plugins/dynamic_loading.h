// Loads libraries of classes.
#ifndef TANDEM_ARGOS3_DYNAMIC_LOADING_H
#define TANDEM_ARGOS3_DYNAMIC_LOADING_H
#include <cstdlib>
#include <map>
#include <string>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <dlfcn.h>

namespace argos {

/// Libraries that an experiment file names are loaded with it: none of these needs to be called.
class CDynamicLoading {
 public:
  typedef void* TDLHandle;

  /// Looks for the file, and in the folders of ARGOS_PLUGIN_PATH, with and without ".so". @throws CARGoSException
  static TDLHandle LoadLibrary(const std::string& library);
  static void UnloadLibrary(const std::string& library);
  /// All libraries of the folders of ARGOS_PLUGIN_PATH; those that do not load are left out, with a message.
  static void LoadAllLibraries();
  static void UnloadAllLibraries();
};

}  // namespace argos

#endif
