// The simulator: the one run of this process.
#ifndef TANDEM_ARGOS3_SIMULATOR_H
#define TANDEM_ARGOS3_SIMULATOR_H
#include <argos3/core/config.h>
#include <argos3/core/simulator/medium/medium.h>
#include <argos3/core/simulator/not_carried_over.h>
#include <argos3/core/simulator/physics_engine/physics_engine.h>
#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/math/rng.h>
#include <map>
#include <string>

namespace argos {

class CLoopFunctions;
class CSpace;
class CVisualization;

/// In a program of one's own: SetExperimentFileName, LoadExperiment, then Execute, and Reset before the next Execute,
/// as often as wanted. In `tandem run` and its like the run is the program's: loop functions look, reset and end it.
class CSimulator {
 public:
  static CSimulator& GetInstance();
  CSimulator(const CSimulator&) = delete;
  CSimulator& operator=(const CSimulator&) = delete;

  CSpace& GetSpace() const;
  /// @throws CARGoSException when the file names no such engine
  CPhysicsEngine& GetPhysicsEngine(const std::string& id) const;
  CPhysicsEngine::TVector& GetPhysicsEngines();
  /// @throws CARGoSException when the file names no such medium, or it is of another class
  template <typename T>
  T& GetMedium(const std::string& id) {
    T* const medium = dynamic_cast<T*>(&FindMedium(id));
    if (medium == nullptr) THROW_ARGOSEXCEPTION("The medium \"" << id << "\" is of another class than the wanted one");
    return *medium;
  }
  CMedium::TVector& GetMedia();
  CVisualization& GetVisualization();
  /// The root of the experiment file.
  TConfigurationNode& GetConfigurationRoot();
  TConfigurationNode& GetConfigForController(const std::string& id);
  UInt32 GetRandomSeed() const;
  /// Of the next LoadExperiment or Reset.
  void SetRandomSeed(UInt32 seed);
  CRandom::CRNG* GetRNG();
  const std::string& GetExperimentFileName() const;
  void SetExperimentFileName(const std::string& file);
  CLoopFunctions& GetLoopFunctions();
  /// In ticks; 0: the file sets none.
  UInt32 GetMaxSimulationClock() const;
  UInt32 GetNumThreads() const;
  bool IsRealTimeClock() const { return false; }
  bool IsProfiling() const { return false; }
  /// Of the variable ARGOS_PREFIX; empty: it is not set.
  std::string GetInstallationDirectory() const;

  /// Reads the file, makes its robots and controllers, calls CLoopFunctions::Init. @throws CARGoSException with all
  /// problems; nothing is loaded then
  void LoadExperiment(bool no_visualization = false);
  /// Steps until the experiment is finished, then calls CLoopFunctions::PostExperiment.
  void Execute();
  /// One tick.
  void UpdateSpace();
  bool IsExperimentFinished() const;
  /// Begins the run again with the same seed, or another. From loop functions: when the present tick is over.
  void Reset();
  void Reset(UInt32 seed) {
    SetRandomSeed(seed);
    Reset();
  }
  /// Ends the run after the present tick.
  void Terminate();
  /// Ends the run and everything in it.
  void Destroy();

  ARGOS3_NO_FUNCTION(Init, "call LoadExperiment")
  ARGOS3_NO_FUNCTION(Load, "write the document to a file and name it with SetExperimentFileName")
  ARGOS3_NO_FUNCTION(SetLoopFunctions, "name them in the experiment file: <loop_functions library=\"…\" label=\"…\"/>")
  ARGOS3_NO_FUNCTION(SetRealTimeClock, "set <time mode=\"realtime\"/> in the experiment file")
  ARGOS3_NO_FUNCTION(GetProfiler, "tandem run prints and reports what a tick costs")

 private:
  friend class CSpaceAccess;
  CSimulator();
  ~CSimulator();
  CMedium& FindMedium(const std::string& id);
  struct SState;
  SState* m_psState;
};

}  // namespace argos

#endif
