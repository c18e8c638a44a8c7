/*
 * Reports in which order ARGoS calls loop functions and controllers, and which clock and pose they see.
 */
#ifndef CORPUS_ORDER_LOOP_H
#define CORPUS_ORDER_LOOP_H

#include <argos3/core/simulator/loop_functions.h>

using namespace argos;

class COrderLoop : public CLoopFunctions {
public:
   COrderLoop() : m_unEnd(5) {}
   virtual ~COrderLoop() {}
   virtual void Init(TConfigurationNode& t_tree);
   virtual void Reset();
   virtual void Destroy();
   virtual void PreStep();
   virtual void PostStep();
   virtual bool IsExperimentFinished();
   virtual void PostExperiment();

private:
   Real TrueX();
   UInt32 m_unEnd;
};

#endif
