// A program with a main of its own: some trials of one experiment.
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/core/simulator/simulator.h>
#include <argos3/core/simulator/space/space.h>
#include <argos3/core/utility/plugins/dynamic_loading.h>
#include <iostream>

#include "trials_loop.h"

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  try {
    CSimulator& cSimulator = CSimulator::GetInstance();
    CDynamicLoading::LoadAllLibraries();
    cSimulator.SetExperimentFileName(argv[1]);
    cSimulator.LoadExperiment();
    CTrialsLoop& cLoop = dynamic_cast<CTrialsLoop&>(cSimulator.GetLoopFunctions());
    const CRange<Real> cUnit(0, 1);
    std::cout << "first " << Round(1e6 * cSimulator.GetRNG()->Uniform(cUnit)) << std::endl;
    std::cout << "longest " << cSimulator.GetMaxSimulationClock() << " seed " << cSimulator.GetRandomSeed()
              << std::endl;
    for (UInt32 i = 0; i < 3; ++i) {
      if (i == 2) cSimulator.SetRandomSeed(99);
      cSimulator.Reset();
      cLoop.SetSpeed(i == 1 ? 20 : 10);
      cSimulator.Execute();
      std::cout << "trial " << i << " clock " << cSimulator.GetSpace().GetSimulationClock() << " at "
                << Round(1000 * cLoop.Reached()) << " ends " << cLoop.Ends() << " resets " << cLoop.Resets()
                << " drawn " << Round(1e6 * cLoop.Drawn()) << std::endl;
    }
    cSimulator.Destroy();
    cSimulator.SetRandomSeed(124);
    cSimulator.LoadExperiment();
    std::cout << "again " << Round(1e6 * cSimulator.GetRNG()->Uniform(cUnit)) << std::endl;
    cSimulator.Destroy();
  } catch (std::exception& ex) {
    std::cerr << "failed: " << ex.what() << std::endl;
    return 1;
  }
  return 0;
}
