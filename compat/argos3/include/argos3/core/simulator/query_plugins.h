// Lists what there is.
#ifndef TANDEM_ARGOS3_QUERY_PLUGINS_H
#define TANDEM_ARGOS3_QUERY_PLUGINS_H
#include <string>

namespace argos {

/// Prints what `tandem list` and `tandem describe` say. @throws CARGoSException when they fail
void QueryPlugins(const std::string& query);

}  // namespace argos

#endif
