// Lists parts.
#ifndef TANDEM_ARGOS3_QUERY_PLUGINS_H
#define TANDEM_ARGOS3_QUERY_PLUGINS_H
#include <string>

namespace argos {

/// Prints as `tandem list` and `tandem describe` do. @throws CARGoSException when they fail
void QueryPlugins(const std::string& query);

}  // namespace argos

#endif
