/*
 * Counts the entities that a file places and tells where they are; makes trouble on demand.
 */
#ifndef CORPUS_CENSUS_LOOP_H
#define CORPUS_CENSUS_LOOP_H

#include <argos3/core/simulator/loop_functions.h>

using namespace argos;

class CCensusLoop : public CLoopFunctions {
public:
   virtual void Init(TConfigurationNode& t_tree);
   virtual void PostStep();
   virtual void PostExperiment();

private:
   void Tell(const std::string& str_type);
   std::string m_strTrouble;
};

#endif
