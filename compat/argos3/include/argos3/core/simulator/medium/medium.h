// Media that the experiment file names.
#ifndef ARGOS3_CORE_SIMULATOR_MEDIUM_MEDIUM_H
#define ARGOS3_CORE_SIMULATOR_MEDIUM_MEDIUM_H

#include <argos3/core/simulator/not_carried_over.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <map>
#include <string>
#include <vector>

namespace argos {

/// Tandem's media carry the signals; this names one.
class CMedium {
 public:
  typedef std::vector<CMedium*> TVector;
  typedef std::map<std::string, CMedium*> TMap;

  explicit CMedium(const std::string& str_id) : m_strId(str_id) {}
  virtual ~CMedium();
  const std::string& GetId() const { return m_strId; }

 private:
  std::string m_strId;
};

}  // namespace argos

#define REGISTER_MEDIUM(...) ARGOS3_NOT_CARRIED_OVER("own media: make a Tandem plug-in, docs/plugins.md")

#endif
