// CSimulator: of a run that hooks take part in, or of one that a program of one's own steps.
#include <algorithm>
#include <argos3/core/simulator/loop_functions.h>
#include <argos3/core/simulator/query_plugins.h>
#include <argos3/core/simulator/simulator.h>
#include <argos3/core/simulator/space/space.h>
#include <argos3/core/simulator/visualization/visualization.h>
#include <argos3/plugins/simulator/media/led_medium.h>
#include <argos3/plugins/simulator/media/rab_medium.h>
#include <cstdlib>
#include <dlfcn.h>
#include <memory>
#include <mutex>

#include "compat/argos3/facade/library.hpp"
#include "compat/argos3/simulator/own_run.hpp"
#include "compat/argos3/simulator/session.hpp"

namespace argos {

namespace compat = tandem::compat::argos3;

using compat::Session;

struct CSimulator::SState {
  CSpace Space;
  CVisualization View;
  std::unique_ptr<TConfigurationNode> Configuration;  ///< made when it is asked for
  std::mutex Reading;                                 ///< controllers may ask, on any thread
  std::vector<std::unique_ptr<CPhysicsEngine>> OwnedEngines;
  CPhysicsEngine::TVector Engines;
  std::vector<std::unique_ptr<CMedium>> OwnedMedia;
  CMedium::TVector Media;
  CRandom::CRNG* Random = nullptr;
  std::unique_ptr<compat::OwnRun> Own;
  mutable std::string File;

  TConfigurationNode& Root() {
    const std::lock_guard lock(Reading);
    if (Configuration == nullptr) Configuration = compat::world().experiment();
    return *Configuration;
  }
  TConfigurationNode* Part(const char* name) { return Root().FirstChildElement(name, false); }

  void ReadEngines() {
    if (!Engines.empty()) return;
    TConfigurationNode* const all = Part("physics_engines");
    TConfigurationNodeIterator it;
    if (all == nullptr) return;
    for (it = it.begin(all); it != it.end(); ++it) {
      UInt32 iterations = 10;
      GetNodeAttributeOrDefault(*it, "iterations", iterations, iterations);
      OwnedEngines.emplace_back(new CPhysicsEngine(it->GetAttribute("id"), std::max<UInt32>(1, iterations)));
      Engines.push_back(OwnedEngines.back().get());
    }
  }

  void ReadMedia() {
    if (!Media.empty()) return;
    TConfigurationNode* const all = Part("media");
    TConfigurationNodeIterator it;
    if (all == nullptr) return;
    for (it = it.begin(all); it != it.end(); ++it) {
      const std::string id = it->GetAttribute("id");
      CMedium* const medium = it->Value() == "led"                 ? static_cast<CMedium*>(new CLEDMedium(id))
                              : it->Value() == "range_and_bearing" ? static_cast<CMedium*>(new CRABMedium(id))
                                                                   : new CMedium(id);
      OwnedMedia.emplace_back(medium);
      Media.push_back(medium);
    }
  }
};

CSimulator::CSimulator() : m_psState(nullptr) {}
CSimulator::~CSimulator() {}

CSimulator& CSimulator::GetInstance() {
  static CSimulator* const simulator = [] {
    auto* const made = new CSimulator;  // outlives static objects of libraries
    made->m_psState = new SState;
    return made;
  }();
  return *simulator;
}

CSpace& CSimulator::GetSpace() const {
  return m_psState->Space;
}

CPhysicsEngine::TVector& CSimulator::GetPhysicsEngines() {
  m_psState->ReadEngines();
  return m_psState->Engines;
}
CPhysicsEngine& CSimulator::GetPhysicsEngine(const std::string& id) const {
  m_psState->ReadEngines();
  for (CPhysicsEngine* const engine : m_psState->Engines) {
    if (engine->GetId() == id) return *engine;
  }
  THROW_ARGOSEXCEPTION("the experiment file names no physics engine \"" << id << "\"")
}
CMedium::TVector& CSimulator::GetMedia() {
  m_psState->ReadMedia();
  return m_psState->Media;
}
CMedium& CSimulator::FindMedium(const std::string& id) {
  for (CMedium* const medium : GetMedia()) {
    if (medium->GetId() == id) return *medium;
  }
  THROW_ARGOSEXCEPTION("the experiment file names no medium \"" << id << "\"")
}
CVisualization& CSimulator::GetVisualization() {
  return m_psState->View;
}

TConfigurationNode& CSimulator::GetConfigurationRoot() {
  return m_psState->Root();
}
TConfigurationNode& CSimulator::GetConfigForController(const std::string& id) {
  TConfigurationNode* const all = m_psState->Part("controllers");
  TConfigurationNodeIterator it;
  if (all != nullptr) {
    for (it = it.begin(all); it != it.end(); ++it) {
      if (it->GetAttribute("id") == id) return *it;
    }
  }
  THROW_ARGOSEXCEPTION("the experiment file has no controller of id \"" << id << "\"")
}

UInt32 CSimulator::GetRandomSeed() const {
  const Session& session = Session::get();
  if (!session.entered()) return session.wanted_seed.value_or(0);
  return static_cast<UInt32>(session.world().seed());
}
void CSimulator::SetRandomSeed(UInt32 seed) {
  Session::get().wanted_seed = seed;
}
CRandom::CRNG* CSimulator::GetRNG() {
  if (m_psState->Random == nullptr) m_psState->Random = CRandom::CreateRNG("argos");  // before any run
  return m_psState->Random;
}

const std::string& CSimulator::GetExperimentFileName() const {
  return m_psState->File.empty() ? Session::get().file : m_psState->File;
}
void CSimulator::SetExperimentFileName(const std::string& file) {
  m_psState->File = file;
}
CLoopFunctions& CSimulator::GetLoopFunctions() {
  return Session::get().loop_functions();
}

UInt32 CSimulator::GetMaxSimulationClock() const {
  return compat::world().longest();
}
UInt32 CSimulator::GetNumThreads() const {
  return compat::world().threads();
}
std::string CSimulator::GetInstallationDirectory() const {
  const char* const set = std::getenv("ARGOS_PREFIX");
  return set != nullptr ? set : "";
}

// --- programs of one's own ---

namespace {

/// The run that this program steps.
compat::OwnRun& own(const std::unique_ptr<compat::OwnRun>& run) {
  if (run == nullptr)
    THROW_ARGOSEXCEPTION(
        "this program steps no experiment: call LoadExperiment first; in `tandem run` the run steps by "
        "itself")
  return *run;
}

void check(const std::string& failure) {
  if (!failure.empty()) THROW_ARGOSEXCEPTION(failure)
}

}  // namespace

void CSimulator::LoadExperiment(bool) {
  if (m_psState->Own != nullptr) THROW_ARGOSEXCEPTION("an experiment is loaded already: call Destroy first")
  const auto open = reinterpret_cast<compat::OpenOwnRun>(dlsym(RTLD_DEFAULT, "tandem_argos3_open_run"));
  if (open == nullptr || Session::get().entered())
    THROW_ARGOSEXCEPTION(
        "LoadExperiment is for programs with a main of their own, linked with argos3core_simulator; "
        "here the run has its experiment already")
  Session& session = Session::get();
  session.own_program = true;
  session.file = m_psState->File;
  const std::optional<std::uint32_t>& wanted = session.wanted_seed;
  const std::uint64_t seed = wanted.value_or(0);
  std::string why;
  m_psState->Own.reset(open(m_psState->File.c_str(), wanted && seed != 0 ? &seed : nullptr, why));
  if (m_psState->Own == nullptr) {
    session.own_program = false;
    THROW_ARGOSEXCEPTION(why)
  }
}

void CSimulator::UpdateSpace() {
  check(own(m_psState->Own).step());
}

bool CSimulator::IsExperimentFinished() const {
  const UInt32 longest = GetMaxSimulationClock();
  return Session::get().terminated || (longest > 0 && GetSpace().GetSimulationClock() >= longest) ||
         Session::get().is_finished();
}

void CSimulator::Execute() {
  compat::OwnRun& run = own(m_psState->Own);
  while (!IsExperimentFinished()) check(run.step());
  Session::get().post_experiment();
}

void CSimulator::Reset() {
  Session& session = Session::get();
  // Without a seed of the file or of SetRandomSeed every run has another.
  const std::uint64_t now = session.world().seed();
  const std::uint64_t seed = session.wanted_seed ? *session.wanted_seed : session.world().repeats() ? now : now + 1;
  if (m_psState->Own == nullptr)
    session.world().reset(seed);
  else
    check(m_psState->Own->reset(seed));
}

void CSimulator::Terminate() {
  Session::get().terminated = true;
}

void CSimulator::Destroy() {
  if (m_psState->Own == nullptr) return;
  m_psState->Own.reset();
  Session::get().own_program = false;
  LOG.Flush();
  LOGERR.Flush();
}

void CSpaceAccess::NewRun(CSimulator& simulator, bool again) {
  if (!again) simulator.m_psState->Random = CRandom::CreateRNG("argos");
  simulator.m_psState->Configuration.reset();
  simulator.m_psState->Engines.clear();
  simulator.m_psState->OwnedEngines.clear();
  simulator.m_psState->Media.clear();
  simulator.m_psState->OwnedMedia.clear();
}

}  // namespace argos
