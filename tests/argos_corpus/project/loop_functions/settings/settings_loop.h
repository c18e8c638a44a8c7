/*
 * Reads the children of its own element, files of its own, and the whole configuration.
 */
#ifndef CORPUS_SETTINGS_LOOP_H
#define CORPUS_SETTINGS_LOOP_H

#include <argos3/core/simulator/loop_functions.h>
#include <fstream>

using namespace argos;

class CSettingsLoop : public CLoopFunctions {
public:
   virtual void Init(TConfigurationNode& t_tree);
   virtual void PostStep();
   virtual void PostExperiment();

private:
   std::string m_strOutput;
   std::ofstream m_cOutput;
};

#endif
