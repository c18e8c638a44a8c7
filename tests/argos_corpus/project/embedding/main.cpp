/*
 * A program with its own main: loads an experiment, runs it, resets it with the same seed, runs it again, ten seeds if
 * asked.
 */
#include <argos3/core/simulator/argos_command_line_arg_parser.h>
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/core/simulator/simulator.h>
#include <argos3/core/simulator/space/space.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/plugins/dynamic_loading.h>
#include <argos3/plugins/robots/foot-bot/simulator/footbot_entity.h>
#include <controllers/wheels/wheels.h>
#include <cstdlib>
#include <iostream>
#include <sstream>

using namespace argos;

static CVector3 Position(CSpace& c_space) {
   CFootBotEntity& cFootBot = *any_cast<CFootBotEntity*>(c_space.GetEntitiesByType("foot-bot")["fb0"]);
   return cFootBot.GetEmbodiedEntity().GetOriginAnchor().Position;
}

static CWheels& Controller(CSpace& c_space) {
   CFootBotEntity& cFootBot = *any_cast<CFootBotEntity*>(c_space.GetEntitiesByType("foot-bot")["fb0"]);
   return dynamic_cast<CWheels&>(cFootBot.GetControllableEntity().GetController());
}

static std::string Millimeters(const CVector3& c_position) {
   std::ostringstream cOut;
   cOut << Round(c_position.GetX() * 1000.0) << " " << Round(c_position.GetY() * 1000.0);
   return cOut.str();
}

/* What the program does where nothing is asked of it */
static void TwoRuns(CSimulator& c_simulator) {
   CSpace& cSpace = c_simulator.GetSpace();
   std::cout << "RESULT loaded.clock " << cSpace.GetSimulationClock() << std::endl;
   std::cout << "RESULT loaded.place " << Millimeters(Position(cSpace)) << std::endl;
   c_simulator.Execute();
   std::cout << "RESULT first.clock " << cSpace.GetSimulationClock() << std::endl;
   std::cout << "RESULT first.place " << Millimeters(Position(cSpace)) << std::endl;
   std::cout << "RESULT first.steps " << Controller(cSpace).GetSteps() << std::endl;
   const CWheels* pcBefore = &Controller(cSpace);

   c_simulator.SetRandomSeed(c_simulator.GetRandomSeed() + 1);
   c_simulator.Reset();
   std::cout << "RESULT reset.clock " << cSpace.GetSimulationClock() << std::endl;
   std::cout << "RESULT reset.place " << Millimeters(Position(cSpace)) << std::endl;
   std::cout << "RESULT reset.steps " << Controller(cSpace).GetSteps() << std::endl;
   std::cout << "RESULT reset.same_controller " << (pcBefore == &Controller(cSpace)) << std::endl;
   std::cout << "RESULT reset.seed " << c_simulator.GetRandomSeed() << std::endl;
   Controller(cSpace).SetSpeeds(-10.0, -10.0);
   c_simulator.Execute();
   std::cout << "RESULT second.place " << Millimeters(Position(cSpace)) << std::endl;
}

/* Tick by tick, as optimizers do */
static void OneByOne(CSimulator& c_simulator) {
   c_simulator.Reset();
   CSpace& cSpace = c_simulator.GetSpace();
   Controller(cSpace).SetSpeeds(10.0, 10.0);
   UInt32 unTicks = 0;
   while (!c_simulator.IsExperimentFinished()) {
      c_simulator.UpdateSpace();
      ++unTicks;
   }
   std::cout << "RESULT third.ticks " << unTicks << std::endl;
   std::cout << "RESULT third.place " << Millimeters(Position(cSpace)) << std::endl;
}

int main(int n_argc, char** ppch_argv) {
   CSimulator& cSimulator = CSimulator::GetInstance();
   try {
      CARGoSCommandLineArgParser cParser;
      UInt32 unRounds = 1;
      cParser.AddArgument<UInt32>('r', "rounds", "how many rounds to run [OPTIONAL]", unRounds);
      cParser.Parse(n_argc, ppch_argv);
      if (cParser.GetAction() != CARGoSCommandLineArgParser::ACTION_RUN_EXPERIMENT) {
         cParser.PrintUsage(LOG);
         LOG.Flush();
         return 0;
      }
      CDynamicLoading::LoadAllLibraries();
      cSimulator.SetExperimentFileName(cParser.GetExperimentConfigFile());
      cSimulator.LoadExperiment();
      TwoRuns(cSimulator);
      for (UInt32 i = 0; i < unRounds; ++i) {
         OneByOne(cSimulator);
      }
      cSimulator.Destroy();
   } catch (std::exception& ex) {
      LOGERR << ex.what() << std::endl;
      LOG.Flush();
      LOGERR.Flush();
      return EXIT_FAILURE;
   }
   return EXIT_SUCCESS;
}
