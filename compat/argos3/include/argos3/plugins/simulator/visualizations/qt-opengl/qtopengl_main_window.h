// ARGoS' window.
#ifndef TANDEM_ARGOS3_QTOPENGL_MAIN_WINDOW_H
#define TANDEM_ARGOS3_QTOPENGL_MAIN_WINDOW_H
#include <argos3/plugins/simulator/visualizations/qt-opengl/qtopengl_widget.h>

namespace argos {

class CQTOpenGLMainWindow {
 public:
  CQTOpenGLWidget& GetOpenGLWidget();

  ARGOS3_NO_FUNCTION(addDockWidget,
                     "the window is a page in the browser: publish values, declare controls, docs/hooks.md")
  ARGOS3_NO_FUNCTION(addToolBar, "the window is a page in the browser: declare controls, docs/hooks.md")
  ARGOS3_NO_FUNCTION(menuBar, "the window is a page in the browser: declare controls, docs/hooks.md")
};

}  // namespace argos

#endif
