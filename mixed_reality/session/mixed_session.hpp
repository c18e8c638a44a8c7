// A run in which real robots take part: world, twins and pacer, tick by tick.
//
//   latch -> physics -> sense, fuse -> control -> filter -> commit   (World::step, which calls the twins)
//   record (the caller's `after_tick`) -> wait until the next tick's absolute time
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/sim/external.hpp"
#include "core/sim/world.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "mixed_reality/session/report.hpp"
#include "mixed_reality/settings/bridge_request.hpp"
#include "mixed_reality/time/monotonic.hpp"
#include "mixed_reality/time/pacer.hpp"
#include "mixed_reality/twin/twin.hpp"

namespace tandem::mixed_reality {

/// Makes the real robot behind one `<bridge>`. Does not wait for it to answer. Error: no such link, or no bridge for
/// that kind of robot.
using BridgeMaker = std::function<bridges::MadeBridge(const bridges::BridgeRequest&)>;

struct MixedOptions {
  /// How often guardians have stopped the robots because this program did not run; empty: nobody counts that.
  std::function<std::uint64_t()> freezes = {};
  /// Whether the process lives that stops the robots when this one dies; empty: nobody asks.
  std::function<bool()> guarded = {};
  /// Set by a person who re-arms robots: all that wait for it; null: nobody can.
  std::atomic<bool>* rearm_asked = nullptr;
  /// Called for a robot that is not there and is simulated instead: its bridge has ended, and is asked nothing more.
  std::function<void(const bridges::RobotBridge&)> on_left_out = {};
  /// Called before the first and every later command of the run leaves: whoever stops robots when this process dies is
  /// to know how.
  std::function<void()> before_commands = {};
  hal::Log log;
};

/// Owns the world and the real robots. All calls come from one thread. However a run ends (its length, a hook, a
/// failure, an exception, `stop`, or this object's end), every real robot is stopped.
class MixedSession final : private core::ExternalRobots {
 public:
  /// Makes a twin of every robot of the world whose item has a `<bridge>`, and its real robot. `time` must outlive the
  /// session. Error: a robot that cannot be made, or whose pose nobody can tell.
  static hal::Result<std::unique_ptr<MixedSession>> make(std::unique_ptr<core::World> world,
                                                         const BridgeMaker& make_bridge, TimeSource& time,
                                                         const MixedOptions& options);
  ~MixedSession() override;
  MixedSession(const MixedSession&) = delete;
  MixedSession& operator=(const MixedSession&) = delete;

  /// Waits until every real robot answers and stands still, each as long as its bridge says. One that does not in time
  /// is simulated instead, or waited for, where its bridge says so. Error: one does not in time, named with what is
  /// wrong; or `stop`.
  hal::Status connect(const std::atomic<bool>& stop);

  /// Steps the world in real time until `ticks` are done (0: no end of its own), the world is done, or `stop` becomes
  /// true; then stops the robots. `after_tick` is called after every step, within the tick's time. Error: the world
  /// failed. Once.
  hal::Status run(hal::Tick ticks, const std::atomic<bool>& stop,
                  const std::function<void(core::World&)>& after_tick = {});

  /// Stops every real robot and waits a while for each to confirm. @returns whether all did; those that did not are
  /// logged.
  bool stop_robots();
  /// Ends the conversations, all at once: robots that fly land, where they are to. Whether one is known to rest may
  /// change by that.
  void shut_down();

  core::World& world() noexcept { return *world_; }
  const core::World& world() const noexcept { return *world_; }
  MixedReport report() const;

 private:
  MixedSession(std::unique_ptr<core::World> world, TimeSource& time, const MixedOptions& options);
  hal::Status add_twin(const core::RobotItem& item, const BridgeMaker& make_bridge);
  void start_bridges();

  void latch(core::World& world) override;
  void after_sense(core::World& world) override;
  void after_filter(core::World& world) override;

  Moment moment() const noexcept;
  bool all_answer() const noexcept;
  std::string missing_robots(std::optional<hal::TimeNs> waited_ns) const;
  void leave_out_missing(hal::TimeNs waited_ns);

  struct LastState {  // of the last tick, kept because the end stops all
    bool driving = false;
    LinkHealth health = LinkHealth::Connecting;
    std::string state;
  };

  std::unique_ptr<core::World> world_;
  TimeSource& time_;
  MixedOptions options_;
  Pacer pacer_;
  std::vector<std::unique_ptr<Twin>> twins_;
  std::vector<core::BridgeConfig> bridges_;  // parallel to `twins_`, as the next two
  std::vector<LastState> last_;
  std::vector<std::uint8_t> confirmed_;
  std::vector<std::unique_ptr<Twin>> left_out_;
  bool started_ = false;
  RunPhase phase_ = RunPhase::Waiting;
  Moment now_;                 // of the running tick
  std::uint64_t freezes_ = 0;  // that the twins were told of
  bool stopped_ = true;        // nothing was commanded since the robots were stopped
};

}  // namespace tandem::mixed_reality
