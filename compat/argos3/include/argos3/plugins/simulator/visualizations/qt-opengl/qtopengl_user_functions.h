// User functions of ARGoS' window: drawings go to Tandem's window and pictures.
#ifndef TANDEM_ARGOS3_QTOPENGL_USER_FUNCTIONS_H
#define TANDEM_ARGOS3_QTOPENGL_USER_FUNCTIONS_H
#include <argos3/core/simulator/entity/entity.h>
#include <argos3/core/simulator/entity/floor_entity.h>
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/core/utility/configuration/base_configurable_resource.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/ray3.h>
#include <argos3/core/utility/math/vector2.h>
#include <argos3/core/utility/math/vector3.h>
#include <argos3/core/utility/plugins/factory.h>
#include <argos3/plugins/simulator/visualizations/qt-opengl/qt_types.h>
#include <argos3/plugins/simulator/visualizations/qt-opengl/qtopengl_main_window.h>
#include <argos3/plugins/simulator/visualizations/qt-opengl/qtopengl_widget.h>
#include <functional>
#include <string>
#include <vector>

namespace argos {

/// Drawings of a function of one entity are in its frame, others in the world's. They last one tick.
class CQTOpenGLUserFunctions : public CBaseConfigurableResource {
 public:
  CQTOpenGLUserFunctions();
  virtual ~CQTOpenGLUserFunctions();

  virtual void Init(TConfigurationNode& /*tree*/) {}
  virtual void Reset() {}
  virtual void Destroy() {}

  // --- people: the controls `keys` and `selected` of these functions in the window ---
  virtual void KeyPressed(QKeyEvent* event);
  virtual void KeyReleased(QKeyEvent* event);
  virtual void EntitySelected(CEntity& /*entity*/) {}
  virtual void EntityDeselected(CEntity& /*entity*/) {}
  /// Null: none is.
  CEntity* GetSelectedEntity();
  virtual void SelectEntity(CEntity& entity);
  virtual void DeselectEntity();
  // The window has no such events.
  virtual void MouseKeyPressed(QMouseEvent* /*event*/) {}
  virtual void MouseKeyReleased(QMouseEvent* /*event*/) {}
  virtual void MouseMoved(QMouseEvent* /*event*/) {}
  virtual void EntityMoved(CEntity&, const CVector3& /*from*/, const CVector3& /*to*/) {}
  virtual void EntityRotated(CEntity&, const CQuaternion& /*from*/, const CQuaternion& /*to*/) {}

  // --- called after every tick ---
  virtual void Draw(CFloorEntity& /*entity*/) {}
  virtual void DrawInWorld() {}
  virtual void DrawOverlay(QPainter& /*painter*/) {}

  CQTOpenGLMainWindow& GetMainWindow();
  CQTOpenGLWidget& GetQTOpenGLWidget();

  // --- drawing, in m ---
  void SetColor(const CColor& color) { m_cColor = color; }
  void DrawPoint(const CVector3& position, const CColor& color = CColor::RED, Real diameter_pixels = 5.0);
  void DrawTriangle(const CVector3& position, const CQuaternion& orientation, Real base, Real height,
                    const CColor& color = CColor::RED, const bool fill = true);
  void DrawPolygon(const CVector3& position, const CQuaternion& orientation, const std::vector<CVector2>& points,
                   const CColor& color = CColor::RED, const bool fill = true);
  void DrawCircle(const CVector3& position, const CQuaternion& orientation, Real radius,
                  const CColor& color = CColor::RED, const bool fill = true, unsigned vertices = 20);
  /// `position` is its middle. A ring at its foot and one at its top, filled.
  void DrawCylinder(const CVector3& position, const CQuaternion& orientation, Real radius, Real height,
                    const CColor& color = CColor::RED, unsigned vertices = 20);
  /// `position` is its middle. Its edges, and its top filled.
  void DrawBox(const CVector3& position, const CQuaternion& orientation, const CVector3& size,
               const CColor& color = CColor::RED);
  void DrawRay(const CRay3& ray, const CColor& color = CColor::RED, Real width_pixels = 1.0);
  void DrawSegment(const CVector3& from, const CVector3& to, const CColor& color = CColor::RED,
                   Real width_pixels = 1.0);
  void DrawText(const CVector3& position, const std::string& text, const CColor& color = CColor::BLACK,
                const QFont& font = QFont());

  /// Has the function called for all entities of this class.
  template <typename USER_IMPL, typename ENTITY>
  void RegisterUserFunction(void (USER_IMPL::*function)(ENTITY&)) {
    m_vecFunctions.push_back([this, function](CEntity& entity) {
      ENTITY* const wanted = dynamic_cast<ENTITY*>(&entity);
      if (wanted != nullptr) (static_cast<USER_IMPL*>(this)->*function)(*wanted);
    });
  }
  virtual void Call(CEntity& entity);

  // --- for the session ---
  void DrawAll();

 private:
  CVector3 InWorld(const CVector3& point) const;
  CVector3 InWorld(const CVector3& position, const CQuaternion& orientation, const CVector3& point) const;

  std::vector<std::function<void(CEntity&)>> m_vecFunctions;
  CColor m_cColor;
  bool m_bInFrame = false;  ///< of an entity, at:
  CVector3 m_cPosition;
  CQuaternion m_cOrientation;
};

#define TANDEM_ARGOS3_NO_GL(name)                                                                                   \
  template <typename... ARGUMENTS>                                                                                  \
  void name(ARGUMENTS&&...) {                                                                                       \
    static_assert(sizeof...(ARGUMENTS) > 1000, "Tandem's window is a page in the browser and has no OpenGL (" #name \
                                               "): draw with DrawPolygon, "                                         \
                                               "DrawCircle, DrawBox, DrawCylinder, DrawRay, DrawText");             \
  }
TANDEM_ARGOS3_NO_GL(glBegin)
TANDEM_ARGOS3_NO_GL(glEnd)
TANDEM_ARGOS3_NO_GL(glVertex2f)
TANDEM_ARGOS3_NO_GL(glVertex2d)
TANDEM_ARGOS3_NO_GL(glVertex3f)
TANDEM_ARGOS3_NO_GL(glVertex3d)
TANDEM_ARGOS3_NO_GL(glNormal3f)
TANDEM_ARGOS3_NO_GL(glColor3f)
TANDEM_ARGOS3_NO_GL(glColor3ub)
TANDEM_ARGOS3_NO_GL(glColor4f)
TANDEM_ARGOS3_NO_GL(glColor4ub)
TANDEM_ARGOS3_NO_GL(glPushMatrix)
TANDEM_ARGOS3_NO_GL(glPopMatrix)
TANDEM_ARGOS3_NO_GL(glTranslatef)
TANDEM_ARGOS3_NO_GL(glTranslated)
TANDEM_ARGOS3_NO_GL(glRotatef)
TANDEM_ARGOS3_NO_GL(glRotated)
TANDEM_ARGOS3_NO_GL(glScalef)
TANDEM_ARGOS3_NO_GL(glEnable)
TANDEM_ARGOS3_NO_GL(glDisable)
TANDEM_ARGOS3_NO_GL(glMaterialfv)
TANDEM_ARGOS3_NO_GL(glLineWidth)
TANDEM_ARGOS3_NO_GL(glPointSize)
TANDEM_ARGOS3_NO_GL(glCallList)
TANDEM_ARGOS3_NO_GL(glGenLists)
TANDEM_ARGOS3_NO_GL(glNewList)
#undef TANDEM_ARGOS3_NO_GL

}  // namespace argos

#define REGISTER_QTOPENGL_USER_FUNCTIONS(CLASSNAME, LABEL) \
  TANDEM_ARGOS3_REGISTER("user functions", ::argos::CQTOpenGLUserFunctions, CLASSNAME, LABEL, __COUNTER__)

#endif
