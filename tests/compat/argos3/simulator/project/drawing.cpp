// Draws a hat on each robot, a line in the world and a text over it; drives by keys.
#include <QKeyEvent>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>
#include <argos3/plugins/simulator/visualizations/qt-opengl/qtopengl_user_functions.h>

#include "walker.h"

class CDrawing : public CQTOpenGLUserFunctions {
 public:
  CDrawing() { RegisterUserFunction<CDrawing, CFootBotEntity>(&CDrawing::DrawHat); }
  virtual void KeyPressed(QKeyEvent* pc_event) {
    if (pc_event->key() == Qt::Key_I && m_pcWalker != nullptr)
      m_pcWalker->m_fSpeed = 20;
    else
      GetQTOpenGLWidget().KeyPressed(pc_event);
  }
  virtual void KeyReleased(QKeyEvent* pc_event) {
    if (pc_event->key() == Qt::Key_I && m_pcWalker != nullptr)
      m_pcWalker->m_fSpeed = 0;
    else
      GetQTOpenGLWidget().KeyReleased(pc_event);
  }
  virtual void EntitySelected(CEntity& c_entity) {
    CFootBotEntity* pcRobot = dynamic_cast<CFootBotEntity*>(&c_entity);
    if (pcRobot != nullptr) m_pcWalker = dynamic_cast<CWalker*>(&pcRobot->GetControllableEntity().GetController());
  }
  virtual void EntityDeselected(CEntity&) { m_pcWalker = nullptr; }
  virtual void DrawInWorld() {
    DrawRay(CRay3(CVector3(-1, 0, 0.1), CVector3(1, 0, 0.1)), CColor::BLUE, 2.0);
    DrawPolygon(CVector3(0, 1, 0.01), CQuaternion(), {CVector2(0, 0), CVector2(0.5, 0), CVector2(0, 0.5)},
                CColor::GREEN);
    DrawBox(CVector3(0, -1, 0.1), CQuaternion(), CVector3(0.2, 0.2, 0.2), CColor::ORANGE);
  }
  virtual void DrawOverlay(QPainter& c_painter) {
    c_painter.setPen(QPen(Qt::red));
    c_painter.drawText(20, 40, QString("over all"));
  }

 private:
  void DrawHat(CFootBotEntity& c_robot) {
    DrawCylinder(CVector3(0, 0, 0.3), CQuaternion(), 0.1, 0.05, CColor::BLACK);
    DrawText(CVector3(0, 0, 0.3), "hat of " + c_robot.GetId());
    LOG << "hat at " << Round(1000 * c_robot.GetEmbodiedEntity().GetOriginAnchor().Position.GetX()) << std::endl;
  }
  CWalker* m_pcWalker = nullptr;
};

REGISTER_QTOPENGL_USER_FUNCTIONS(CDrawing, "drawing")
