// The widget of ARGoS' window.
#ifndef TANDEM_ARGOS3_QTOPENGL_WIDGET_H
#define TANDEM_ARGOS3_QTOPENGL_WIDGET_H
#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/simulator/not_carried_over.h>
#include <argos3/plugins/simulator/visualizations/qt-opengl/qt_types.h>

namespace argos {

/// Stands for Tandem's window: keys that user functions do not take are the window's already.
class CQTOpenGLWidget {
 public:
  void KeyPressed(QKeyEvent*) {}
  void KeyReleased(QKeyEvent*) {}
  CEntity* GetSelectedEntity();
  void SelectEntity(CEntity& entity);
  void DeselectEntity();

  ARGOS3_NO_FUNCTION(GetCamera, "the window has its own cameras; placements of the experiment file are kept")
  ARGOS3_NO_FUNCTION(GetFrameGrabData, "tandem run --film writes films")
  ARGOS3_NO_FUNCTION(PlayExperiment, "people start the run in the window")
  ARGOS3_NO_FUNCTION(PauseExperiment, "people pause the run in the window")
};

}  // namespace argos

#endif
