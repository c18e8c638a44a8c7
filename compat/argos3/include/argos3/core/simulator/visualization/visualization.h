// The view of a run.
#ifndef TANDEM_ARGOS3_VISUALIZATION_H
#define TANDEM_ARGOS3_VISUALIZATION_H
#include <argos3/core/simulator/not_carried_over.h>

namespace argos {

/// Tandem's window, where one looks; it has no functions of its own.
class CVisualization {
 public:
  virtual ~CVisualization();
};

}  // namespace argos

#define REGISTER_VISUALIZATION(...) ARGOS3_NOT_CARRIED_OVER("own visualizations: make a layer, docs/plugins.md")

#endif
