/*
 * Paints the floor: gray at x < 0, black disks for items, white elsewhere; items are picked up by the robots over them.
 */
#ifndef CORPUS_FLOOR_LOOP_H
#define CORPUS_FLOOR_LOOP_H

#include <argos3/core/simulator/entity/floor_entity.h>
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/core/utility/math/range.h>
#include <argos3/core/utility/math/rng.h>
#include <vector>

using namespace argos;

class CFloorLoop : public CLoopFunctions {
public:
   CFloorLoop();
   virtual void Init(TConfigurationNode& t_tree);
   virtual void Reset();
   virtual CColor GetFloorColor(const CVector2& c_position_on_plane);
   virtual void PreStep();

private:
   CFloorEntity* m_pcFloor;
   std::vector<CVector2> m_vecItems;
   CRange<Real> m_cSide;
};

#endif
