/*
 * Measures a swarm at the end: clusters, mean distance from the centroid.
 */
#ifndef CORPUS_SWARM_LOOP_H
#define CORPUS_SWARM_LOOP_H

#include <argos3/core/simulator/loop_functions.h>
#include <vector>

using namespace argos;

class CSwarmLoop : public CLoopFunctions {
public:
   CSwarmLoop() : m_fLink(0.85) {}
   virtual void Init(TConfigurationNode& t_tree);
   virtual void PostExperiment();

private:
   std::vector<CVector2> Positions();
   UInt32 Clusters(const std::vector<CVector2>& vec_positions) const;
   Real m_fLink;
};

#endif
