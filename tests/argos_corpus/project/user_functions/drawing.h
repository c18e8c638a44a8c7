/*
 * Draws ids, trails and a nest; the arrow keys drive the robot that is selected.
 */
#ifndef CORPUS_DRAWING_H
#define CORPUS_DRAWING_H

#include <argos3/core/utility/math/ray3.h>
#include <argos3/core/utility/math/vector3.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>
#include <argos3/plugins/simulator/entities/box_entity.h>
#include <argos3/plugins/simulator/visualizations/qt-opengl/qtopengl_user_functions.h>
#include <map>
#include <vector>

using namespace argos;

class CWheels;

class CDrawing : public CQTOpenGLUserFunctions {
public:
   CDrawing();
   virtual ~CDrawing() {}
   virtual void Init(TConfigurationNode& t_tree);
   virtual void Reset();

   /* Called for every entity of these types */
   void Draw(CFootBotEntity& c_entity);
   void Draw(CBoxEntity& c_entity);
   virtual void Draw(CFloorEntity& c_entity);
   virtual void DrawInWorld();

   virtual void KeyPressed(QKeyEvent* pc_event);
   virtual void KeyReleased(QKeyEvent* pc_event);
   virtual void EntitySelected(CEntity& c_entity);
   virtual void EntityDeselected(CEntity& c_entity);

private:
   void Drive(Real f_left, Real f_right);
   CWheels* m_pcSelected;
   Real m_fSpeed;
   std::map<std::string, std::vector<CVector3> > m_mapTrails;
};

#endif
