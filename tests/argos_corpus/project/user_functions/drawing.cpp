#include "drawing.h"

#include <QKeyEvent>
#include <argos3/core/simulator/entity/controllable_entity.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/plugins/simulator/visualizations/qt-opengl/qtopengl_main_window.h>
#include <argos3/plugins/simulator/visualizations/qt-opengl/qtopengl_widget.h>
#include <controllers/wheels/wheels.h>

CDrawing::CDrawing() : m_pcSelected(NULL), m_fSpeed(10.0) {
   RegisterUserFunction<CDrawing, CFootBotEntity>(&CDrawing::Draw);
   RegisterUserFunction<CDrawing, CBoxEntity>(&CDrawing::Draw);
}

void CDrawing::Init(TConfigurationNode& t_tree) {
   GetNodeAttributeOrDefault(t_tree, "speed", m_fSpeed, m_fSpeed);
   LOG << "RESULT drawing.Init " << m_fSpeed << std::endl;
}

void CDrawing::Reset() {
   m_mapTrails.clear();
}

void CDrawing::Draw(CFootBotEntity& c_entity) {
   DrawText(CVector3(0.0, 0.0, 0.3), c_entity.GetId());
   DrawCircle(CVector3(0.0, 0.0, 0.01), CQuaternion(), 0.2, CColor::GREEN, false);
   const CVector3& cPosition = c_entity.GetEmbodiedEntity().GetOriginAnchor().Position;
   m_mapTrails[c_entity.GetId()].push_back(cPosition);
}

void CDrawing::Draw(CBoxEntity& c_entity) {
   DrawText(CVector3(0.0, 0.0, c_entity.GetSize().GetZ() + 0.05), c_entity.GetId(), CColor::RED);
}

void CDrawing::Draw(CFloorEntity&) {
   DrawCylinder(CVector3(-1.0, 0.0, 0.0), CQuaternion(), 0.25, 0.01, CColor::GRAY50);
}

void CDrawing::DrawInWorld() {
   DrawRay(CRay3(CVector3(0.0, 0.0, 0.1), CVector3(1.0, 0.0, 0.1)), CColor::BLUE, 2.0);
   DrawText(CVector3(-1.0, 0.0, 0.2), "nest");
   for (std::map<std::string, std::vector<CVector3>>::const_iterator it = m_mapTrails.begin(); it != m_mapTrails.end();
        ++it) {
      for (size_t i = 1; i < it->second.size(); ++i) {
         DrawRay(CRay3(it->second[i - 1], it->second[i]));
      }
   }
   DrawPoint(CVector3(0.0, 0.0, 0.1), CColor::RED, 5.0);
   DrawBox(CVector3(1.0, 1.0, 0.1), CQuaternion(), CVector3(0.2, 0.2, 0.2), CColor::YELLOW);
}

void CDrawing::Drive(Real f_left, Real f_right) {
   if (m_pcSelected != NULL) {
      m_pcSelected->SetSpeeds(f_left, f_right);
   }
}

void CDrawing::KeyPressed(QKeyEvent* pc_event) {
   switch (pc_event->key()) {
      case Qt::Key_I: Drive(m_fSpeed, m_fSpeed); break;
      case Qt::Key_K: Drive(-m_fSpeed, -m_fSpeed); break;
      case Qt::Key_J: Drive(-m_fSpeed, m_fSpeed); break;
      case Qt::Key_L: Drive(m_fSpeed, -m_fSpeed); break;
      case Qt::Key_Up: m_fSpeed += 1.0; break;
      default: {
         CQTOpenGLWidget& cWidget = GetQTOpenGLWidget();
         cWidget.KeyPressed(pc_event);
         break;
      }
   }
}

void CDrawing::KeyReleased(QKeyEvent* pc_event) {
   switch (pc_event->key()) {
      case Qt::Key_I:
      case Qt::Key_J:
      case Qt::Key_K:
      case Qt::Key_L: Drive(0.0, 0.0); break;
      default: GetQTOpenGLWidget().KeyReleased(pc_event); break;
   }
}

void CDrawing::EntitySelected(CEntity& c_entity) {
   CFootBotEntity* pcFootBot = dynamic_cast<CFootBotEntity*>(&c_entity);
   if (pcFootBot == NULL) {
      return;
   }
   m_pcSelected = dynamic_cast<CWheels*>(&pcFootBot->GetControllableEntity().GetController());
   if (GetSelectedEntity() == &c_entity) {
      LOG << "RESULT selected " << c_entity.GetId() << std::endl;
   }
}

void CDrawing::EntityDeselected(CEntity&) {
   Drive(0.0, 0.0);
   m_pcSelected = NULL;
}

REGISTER_QTOPENGL_USER_FUNCTIONS(CDrawing, "drawing")
