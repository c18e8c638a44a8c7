// Real robots, peers in lock-step and replays of such runs, as the rest of a run knows them. The module `real`
// implements this.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/experiment/real_side_type.hpp"
#include "core/record/record.hpp"
#include "core/run/roll_call.hpp"
#include "core/run/run.hpp"
#include "hal/json/json.hpp"
#include "hal/result.hpp"

namespace tandem::app {

class ExperimentReading;

/// Real robots that take part. Belongs to the thread that steps, but for `post`.
class RealRobots {
 public:
  virtual ~RealRobots() = default;

  /// Between two ticks no further one begins until `go_on`: the robots stand. Error: the run is not paused.
  virtual bool paused() const = 0;
  virtual void pause() = 0;
  virtual hal::Status go_on() = 0;

  /// Who drives, stands, waits, cannot be reached: as of now.
  virtual std::vector<core::RollRow> roll_call() const = 0;
  /// A line of a table for each robot: its link, its ages, why it does not drive.
  struct Line {
    std::string text;
    bool drives = false;
  };
  virtual std::vector<Line> lines() const = 0;
  /// Robots that do not drive, and why.
  virtual std::vector<std::pair<core::RobotId, std::string>> troubles() const = 0;
  /// Members of the report of the run so far.
  virtual hal::Json report() const = 0;
  /// What a record is to say before the tick that was just done; nothing: no slot of the schedule was skipped.
  virtual std::optional<hal::Json> skipped() = 0;

  /// Message "real" of the view protocol.
  virtual hal::Json message() const = 0;
  /// Any command of the view protocol, on any thread; `from`: who says it, unless the command does.
  virtual void post(hal::Json command, std::function<void(const hal::Json&)> reply, std::string_view from) = 0;
};

/// All of one run that is not simulated. Calls come in the order in which they stand here. Codes are those of the
/// program (app/exit_code.hpp); errors were reported.
class RealSide {
 public:
  virtual ~RealSide() = default;

  /// Of a replay: reads the experiment out of its record. False: complained.
  virtual bool open(ExperimentReading& reading) = 0;
  /// Before any other thread: the guardian process, where real robots take part.
  virtual void guard() = 0;
  /// The experiment is read: what a replay changes in it; whether all is there that real robots need.
  virtual int prepare(core::Scenario& scenario) = 0;
  /// Whether scripts are those of the record.
  virtual bool changes_scripts() const = 0;
  /// The world is made: the recorded robots of a replay join it, and say how long it is.
  virtual int join() = 0;
  /// Adds the robots or peers, which all answer then.
  virtual int add_robots(core::Run& run) = 0;
  /// A record holds what comes from outside of the world, too.
  virtual hal::Status record_inputs(core::Recorder& record) = 0;
  /// Adds the desk, the comparison of a replay.
  virtual int add_parts(core::Run& run) = 0;
  /// After the run: why it has failed besides the world; empty: it has not.
  virtual std::string failure() const = 0;
};

}  // namespace tandem::app
