/*
 * Reports the poses of all robots at given ticks: <report tick="11"/>.
 */
#ifndef CORPUS_POSES_LOOP_H
#define CORPUS_POSES_LOOP_H

#include <argos3/core/simulator/loop_functions.h>
#include <argos3/core/utility/math/vector2.h>
#include <map>
#include <vector>

using namespace argos;

class CPosesLoop : public CLoopFunctions {
public:
   virtual void Init(TConfigurationNode& t_tree);
   virtual void PostStep();

private:
   void Report(const std::string& str_id, const CEmbodiedEntity& c_body);
   std::vector<UInt32> m_vecTicks;
   std::map<std::string, CVector2> m_mapFirst;
   std::map<std::string, CRadians> m_mapFirstYaw;
};

#endif
