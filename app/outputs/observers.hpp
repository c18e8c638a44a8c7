// The observers of a run.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/record/observer.hpp"
#include "core/sim/world.hpp"
#include "hal/catalog.hpp"

namespace tandem::app {

/// What they see of `world` when `tick` is the one that was just done.
core::Observation observation_of(const core::World& world, hal::Tick tick);

/// Those that the file lists, called in its order. One that fails is named on the terminal and rests from then on.
class Observers {
 public:
  /// Problems: what they say, with the line of each; then none is to be called. `catalog` must outlive this.
  static Observers make(const core::Scenario& scenario, const hal::Catalog& catalog, const core::World& world,
                        core::Problems& problems);

  void tick_done(const core::World& world);
  void flush();
  /// @returns whether none has failed in the whole run
  bool finish(const core::World& world);

 private:
  struct Watching {
    std::string name;  ///< for people: "observer 'x' (library 'y')"
    std::unique_ptr<core::Observer> observer;
    bool failed = false;
  };
  template <class Call>
  void each(Call&& call);

  std::vector<Watching> all_;
};

}  // namespace tandem::app
