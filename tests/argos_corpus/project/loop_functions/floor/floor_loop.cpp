#include "floor_loop.h"

#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>

CFloorLoop::CFloorLoop() : m_pcFloor(NULL), m_cSide(-2.0, 2.0) {}

void CFloorLoop::Init(TConfigurationNode&) {
   m_pcFloor = &GetSpace().GetFloorEntity();
   Reset();
   LOG << "RESULT floor.type " << m_pcFloor->GetTypeDescription() << std::endl;
   LOG << "RESULT floor.black " << (m_pcFloor->GetColorAtPoint(0.5f, 0.0f) == CColor::BLACK) << std::endl;
}

void CFloorLoop::Reset() {
   m_vecItems.clear();
   m_vecItems.push_back(CVector2(0.5, 0.0));
   m_pcFloor->SetChanged();
}

CColor CFloorLoop::GetFloorColor(const CVector2& c_position_on_plane) {
   if (c_position_on_plane.GetX() < 0.0f) {
      return CColor::GRAY50;
   }
   if (!m_cSide.WithinMinBoundIncludedMaxBoundIncluded(c_position_on_plane.GetY())) {
      return CColor::RED;
   }
   for (size_t i = 0; i < m_vecItems.size(); ++i) {
      if ((c_position_on_plane - m_vecItems[i]).SquareLength() < 0.04) {
         return CColor::BLACK;
      }
   }
   return CColor::WHITE;
}

/* At clock 5 the item is gone: the robot over it reads white from that tick on */
void CFloorLoop::PreStep() {
   if (GetSpace().GetSimulationClock() == 5) {
      m_vecItems.clear();
      m_pcFloor->SetChanged();
   }
}

REGISTER_LOOP_FUNCTIONS(CFloorLoop, "floor_loop")
