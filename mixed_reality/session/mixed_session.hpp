// A run in which real robots take part: world, twins and pacer, tick by tick.
//
//   latch -> physics -> sense, fuse -> control -> filter -> commit   (World::step, which calls the twins)
//   record (the caller's `after_tick`) -> wait until the next tick's absolute time
#pragma once
#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "bridges/tracker_type.hpp"
#include "core/run/roll_call.hpp"
#include "core/sim/external.hpp"
#include "core/sim/world.hpp"
#include "hal/duration_histogram.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "mixed_reality/barrier/barrier_filter.hpp"
#include "mixed_reality/session/report.hpp"
#include "mixed_reality/session/rest_watch.hpp"
#include "mixed_reality/settings/bridge_request.hpp"
#include "mixed_reality/time/monotonic.hpp"
#include "mixed_reality/time/pacer.hpp"
#include "mixed_reality/time/scheduling.hpp"
#include "mixed_reality/tracking/swapped_links.hpp"
#include "mixed_reality/twin/twin.hpp"

namespace tandem::mixed_reality {

/// Makes the real robot behind one `<bridge>`. Does not wait for it to answer. Error: no such link, or no bridge for
/// that kind of robot.
using BridgeMaker = std::function<bridges::MadeBridge(const bridges::BridgeRequest&)>;

class FusedPose;
class MixedSession;

struct MixedOptions {
  /// Makes the tracker of one element of `<trackers>`; empty: there is none.
  std::function<bridges::MadeTracker(const core::TrackerItem&)> make_tracker = {};
  hal::TimeNs (*unix_clock)() noexcept = nullptr;  ///< the date, for trackers that stamp with it; null: the system's
  /// Tells by whose doing deadlines were missed; called once, when the run begins; may be empty.
  std::function<std::unique_ptr<SchedulingLog>()> scheduling = {};
  /// How often guardians have stopped the robots because this program did not run; empty: not counted.
  std::function<std::uint64_t()> freezes = {};
  /// Whether the process lives that stops the robots when this one dies; may be empty.
  std::function<bool()> guarded = {};
  /// Set by a person who re-arms robots: all that wait for it; may be null.
  std::atomic<bool>* rearm_asked = nullptr;
  /// Called for a robot that is not there and is simulated instead: its bridge has ended, and is asked nothing more.
  std::function<void(const bridges::RobotBridge&)> on_left_out = {};
  /// Called before the first and every later command of the run leaves: whoever stops robots when this process dies is
  /// to know how.
  std::function<void()> before_commands = {};
  /// Called 100 times a second while the run is held or paused: what people ask for is done then.
  std::function<void()> while_paused = {};
  /// Called after every look at the robots, also while they connect, stand, and are stopped: for whoever shows people
  /// who may move.
  std::function<void(const MixedSession&)> on_roll = {};
  /// A robot takes part that did not when the run began; before its link is opened. Error: it may not be driven.
  std::function<hal::Status(const bridges::RobotBridge&)> on_joined = {};
  bool hold = false;           ///< the run waits for `go_on` before its first tick
  bool ask_batteries = false;  ///< also of robots whose controllers do not
  hal::Log log;
};

/// The robot that takes the place of a real one.
struct Replacement {
  std::string id;  ///< how the other robot is called
  std::string link;
  std::vector<std::string> names;       ///< by which trackers know it
  std::optional<core::Pose> pose = {};  ///< where it stands, for a pose by wheels; nothing: where the twin is
};

/// Owns the world and the real robots. All calls come from one thread. However a run ends (its length, a hook, a
/// failure, an exception, `stop`, or this object's end), every real robot is stopped.
class MixedSession final : private core::ExternalRobots {
 public:
  /// Makes a twin of every robot of the world whose item has a `<bridge>`, and its real robot. `time` must outlive the
  /// session. Error: a robot that cannot be made, or whose pose has no source.
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
  /// Opens all links, and keeps all robots standing and asked for readings until `enough` returns true, which is called
  /// every 20 ms; whether robots answer or not. Before `run`, or instead of it. Errors: a tracker that cannot listen;
  /// `stop`.
  hal::Status stand_by(const std::function<bool()>& enough, const std::atomic<bool>& stop);
  /// How late this program woke up while it stood by.
  const hal::DurationHistogram& woke_late() const noexcept { return woke_late_; }
  /// Whether all real robots answer.
  bool all_answer() const noexcept;
  /// First motion, instead of a run, or before one that is held: the robot turns on the spot by about `turn_rad`
  /// (positive: left), as far as the safety table lets it, while the others stand. Errors: no real robot has this name;
  /// it has no wheels; it may not drive, and why; the run has begun; `stop`.
  hal::Status turn(std::string_view robot, double turn_rad, const std::atomic<bool>& stop);

  /// A run that is stepped elsewhere: before the world starts. Error: a link or a tracker cannot be opened.
  hal::Status begin();
  /// Before every tick; waits while the run is paused. False: `stop`, and no further tick.
  bool before_tick(const std::atomic<bool>& stop);
  /// After every tick, when all is done that belongs into its time: waits for the next one's; `over`: there is none.
  void after_tick(bool over, const std::atomic<bool>& stop);

  /// All of it: steps the world in real time until `ticks` are done (0: no end of its own), the world is done, or
  /// `stop` becomes true; then stops the robots. `after_tick` is called after every step, within the tick's time.
  /// Error: the world failed. Once.
  hal::Status run(hal::Tick ticks, const std::atomic<bool>& stop,
                  const std::function<void(core::World&)>& after_tick = {});

  /// Between two ticks no further one begins until `go_on`: real robots stand, those that fly hover, and the run's time
  /// stands still; conversations, trackers, guardian and emergency stop go on. By the loop's thread, as the next ones.
  void pause() noexcept { paused_ = true; }
  /// Errors: the run is not paused.
  hal::Status go_on();
  bool paused() const noexcept { return paused_; }
  /// Another real robot takes this one's place: the old one is stopped, for good; the new one's link is opened while
  /// the run goes on, and as soon as it answers its twin is that of the old one, and stands until `arm`. Where it does
  /// not answer within the bridge's `connect_timeout`, the old one stays, and stands until `arm`; the same may be tried
  /// again. Errors: no real robot has this name, or all have; it is being replaced; the link or the id is another
  /// robot's, or is being closed after the last attempt; no such link.
  hal::Status replace(std::string_view robot, const Replacement& by);

  /// Stops every real robot and waits a while for each to confirm. @returns whether all did; those that did not are
  /// logged.
  bool stop_robots();
  /// Ends the conversations, all at once: robots that fly land, where they are to. Whether one is known to rest may
  /// change by that.
  void shut_down();

  /// A person's emergency stop, from any thread: every real robot is stopped within 20 ms, also between two ticks
  /// (those that fly land), and stays so until `arm`. Robots that are simulated go on.
  void emergency_stop() noexcept { emergency_asked_.store(true, std::memory_order_relaxed); }
  /// Ends the emergency stop of the real robot of this name, or of all ("*"): it settles, and drives by and by. Not
  /// with all: one that took another one's place, or is not proved to be the robot that was armed. Errors: no real
  /// robot has this name; there was no emergency stop.
  hal::Status arm(std::string_view robot);
  /// A person re-arms a robot that waits for it, or all that do and are proved to be the robots that were armed ("*").
  /// Errors: no real robot has this name; it does not wait for it; its policy is never; with all, none is proved.
  hal::Status rearm(std::string_view robot);
  /// As of the last tick.
  std::vector<RealRobotStatus> status() const;
  /// Robots that drive, stand, wait, cannot be reached: as of now.
  std::vector<core::RollRow> roll_call() const;
  std::vector<TrackerStatus> trackers() const { return trackers_.status(now_.monotonic_ns); }

  /// All that the real robots did to the world in the last tick, for a record; also of those that are left out.
  const core::SpaceInputs& inputs() const noexcept { return inputs_; }
  /// When the inputs of the last tick were taken.
  Moment now() const noexcept { return now_; }
  /// Its clocks.
  const ClockRow& clock() const noexcept { return clock_; }

  core::World& world() noexcept { return *world_; }
  const core::World& world() const noexcept { return *world_; }
  MixedReport report() const;
  /// Ledgers of `ledger_robots`, for a record: brought up to date once a second of the run. They stay where they are.
  const std::vector<LedgerRow>& ledger_rows() const noexcept { return ledger_rows_; }
  const std::vector<core::RobotId>& ledger_robots() const noexcept { return ledger_robots_; }

 private:
  MixedSession(std::unique_ptr<core::World> world, TimeSource& time, const MixedOptions& options);
  hal::Status add_trackers();
  hal::Status add_twin(const core::RobotItem& item);
  hal::Result<std::unique_ptr<PoseSource>> make_pose_source(const core::RobotItem& item, bridges::RobotBridge& real,
                                                            core::RobotId robot, const core::Pose& start);
  hal::Status start_bridges();

  void latch(core::World& world) override;
  void after_sense(core::World& world) override;
  void after_filter(core::World& world) override;

  Moment moment() const noexcept;
  struct MadeTwin {
    std::unique_ptr<Twin> twin;
    FusedPose* fused;  // null: another source of its pose
  };
  static Trackers::Tag tag_of(const core::RobotItem& item);
  void take_inputs();
  void compare_links();
  void send_commands();
  void note_states();
  void note_rest();
  bool stand_paused(const std::atomic<bool>& stop);
  void follow_candidates();
  void leave_out_closed();
  hal::Result<MadeTwin> make_twin(const core::RobotItem& item, core::RobotId robot,
                                  const std::vector<std::string>& names, const bridges::BridgeRequest& request,
                                  const core::Pose& start);
  void take_place(std::size_t index, MadeTwin other, const Replacement& by);
  template <class Visit>
  void for_each_bridge(Visit&& visit) const;
  void obey_emergency_stop() noexcept;
  hal::Result<std::vector<std::size_t>> real_robots(std::string_view robot) const;
  std::string missing_robots(std::optional<hal::TimeNs> waited_ns) const;
  void leave_out_missing(hal::TimeNs waited_ns);

  struct LastState {  // of the last tick, kept because the end stops all
    bool driving = false;
    LinkHealth health = LinkHealth::Connecting;
    std::string state;
    std::string device;                  // id of the real robot behind the twin
    std::vector<std::string> incidents;  // of robots that were replaced
  };
  struct Candidate {  // for a place
    std::string robot;
    Replacement by;
    MadeTwin made;
    hal::TimeNs began_ns = 0, commit_ns = 0;
  };
  void give_up(Candidate candidate);
  struct Retired {
    std::unique_ptr<Twin> twin;
    std::string device, link;
    double stop_s;
    bool confirmed = false;
  };
  struct GivenUp {  // a candidate that never came, and was never driven
    std::unique_ptr<Twin> twin;
    std::string device, link;
    std::future<void> closing;  // of its link, which may wait for the robot; not valid: that is done
  };

  std::unique_ptr<core::World> world_;
  TimeSource& time_;
  MixedOptions options_;
  std::unique_ptr<SchedulingLog> scheduling_;
  BridgeMaker make_bridge_;
  Pacer pacer_;
  Trackers trackers_;
  BarrierFilter barrier_;  // outlives the twins
  std::vector<std::unique_ptr<Twin>> twins_;
  std::vector<FusedPose*> fused_;            // parallel to `twins_`; null: another source
  SwappedLinks links_;                       // as many as twins
  std::vector<core::BridgeConfig> bridges_;  // parallel to `twins_`, as the next three
  std::vector<LastState> last_;
  std::vector<std::uint8_t> confirmed_;
  std::vector<RestWatch> rests_;
  std::vector<RobotTimes> times_;
  std::vector<LedgerRow> ledger_rows_;  // of all that had a twin at the begin, as the next
  std::vector<core::RobotId> ledger_robots_;
  std::vector<std::unique_ptr<Twin>> left_out_;
  core::SpaceInputs inputs_;
  ClockRow clock_;  // of the running tick
  std::vector<Candidate> candidates_;
  std::vector<Retired> retired_;
  std::vector<GivenUp> given_up_;
  std::vector<ReplacementReport> replaced_;
  bool started_ = false;
  bool paused_ = false;
  bool pacing_ = false;
  SystemClock system_clock_;  // when it started
  hal::DurationHistogram woke_late_;
  RunPhase phase_ = RunPhase::Waiting;
  Moment now_;                 // of the running tick
  std::uint64_t freezes_ = 0;  // that the twins were told of
  std::atomic<bool> emergency_asked_{false};
  bool stopped_ = true;  // nothing was commanded since the robots were stopped
};

}  // namespace tandem::mixed_reality
