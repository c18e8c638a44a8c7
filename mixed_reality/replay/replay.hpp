// A run with real robots, computed again without them: their effects come out of the run's record.
//
// Until a chosen tick every tick has the same bits as in the run. From then on the robots are simulated ones, which go
// on from where the real ones were; how far they go astray from these is measured as long as the record says.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/sim/external.hpp"
#include "core/sim/world.hpp"
#include "core/space/space_inputs.hpp"
#include "hal/json/json.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "mixed_reality/replay/deviation.hpp"
#include "mixed_reality/replay/recorded_inputs.hpp"

namespace tandem::mixed_reality {

struct ReplayOptions {
  std::optional<hal::Tick> from = {};  ///< from this tick on the robots are simulated; nothing: when inputs end
  hal::Log log = {};
};

class Replay final : private core::ExternalRobots {
 public:
  /// Before World::start. This must outlive the world's last step. Errors: as RecordedInputs; a robot of the record is
  /// not in the world; what it measured has another form here.
  static hal::Result<std::unique_ptr<Replay>> make(core::World& world, const std::string& record,
                                                   const ReplayOptions& options);
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  /// Ticks that are as in the run: those whose inputs are there, but not beyond ReplayOptions::from.
  hal::Tick ticks() const noexcept { return from_; }
  /// Ticks whose inputs are there, and why there are no more.
  hal::Tick recorded_ticks() const noexcept { return recorded_.ticks(); }
  const std::string& recorded_end() const noexcept { return recorded_.end(); }
  /// For a record of the replay.
  const core::SpaceInputs& inputs() const noexcept { return inputs_; }

  /// Of the tick that was just done: in which fields of which robots it is not as recorded, for people; empty where the
  /// record does not say.
  std::string difference();
  /// Of robots that were real and are simulated.
  const std::vector<Deviation>& deviations() const noexcept { return deviations_; }
  /// Why inputs could not be used: the robots are simulated from there on. Empty: all could.
  const std::string& failure() const noexcept { return failure_; }

 private:
  struct Robot {
    std::string id;
    std::unique_ptr<TwinEntity> entity;
    InputWriter writer;
    std::size_t deviation = 0;
  };
  Replay(core::World& world, RecordedInputs recorded, const ReplayOptions& options);
  hal::Status add_robots();
  hal::Status apply(const RecordedTick& tick);
  void continue_simulated(Robot& robot);
  void note_deviations(hal::Tick tick);

  void latch(core::World& world) override;
  void after_sense(core::World& world) override;
  void after_filter(core::World& /*world*/) override {}

  core::World& world_;
  RecordedInputs recorded_;
  hal::Tick from_ = 0;
  hal::Log log_;
  std::vector<Robot> robots_;
  core::SpaceInputs inputs_;
  std::vector<Deviation> deviations_;
  bool simulated_ = false;
  std::string failure_;
};

}  // namespace tandem::mixed_reality
