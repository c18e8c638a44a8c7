// Small worlds in which parts are tried: robots with the parts in question, things around them, random commands.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/device/device.hpp"
#include "core/physics/engine.hpp"
#include "core/sim/world.hpp"

namespace tandem::app {

/// What a trial's world is made of.
struct Trial {
  const hal::RobotKind* kind = nullptr;
  std::vector<const core::DeviceType*> devices;  ///< that its robots take, each in one implementation
  std::string engine;                            ///< empty: the first that suits kind and devices
  std::string engine_options = {};               ///< attributes of its element
  std::string controller = {};                   ///< its registered name; empty: the probe
  std::string library = {};                      ///< … and its library
  std::string more = {};                         ///< elements of the root: hooks, records
};

/// The engine for the trial; null: there is none that has what kind and devices need.
const core::EngineType* engine_for(const hal::Catalog& catalog, const Trial& trial);

/// Makes worlds of one trial. `loader` must outlive them.
class TrialMaker {
 public:
  static constexpr std::int64_t kTicks = 40;
  static constexpr std::int64_t kCheckpoint = 20;

  TrialMaker(hal::PluginLoader& loader, const Trial& trial);

  /// Null: it cannot be made, and `why` says why.
  std::unique_ptr<core::World> make(std::int64_t threads, std::string& why) const;

 private:
  hal::PluginLoader& loader_;
  std::vector<const hal::PortType*> ports_;
  std::string text_;
  std::string flaw_;
};

/// Steps to tick `until`. @returns why the run failed; empty: it did not
std::string step_to(core::World& world, std::int64_t until);

}  // namespace tandem::app
