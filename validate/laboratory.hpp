// Mixed runs with emulated robots, each a process, in real time: started, driven by a script, and looked into by their
// logs and the run's record. All by the program's own commands.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hal/json/json.hpp"
#include "hal/result.hpp"
#include "hal/temporary_folder.hpp"
#include "hal/time.hpp"
#include "validate/row.hpp"

namespace tandem::validate {

struct EmulatedRobot {
  std::string id;
  double x_m = 0.0, y_m = 0.0, heading_deg = 0.0;
  std::vector<std::string> options;  ///< further ones of `tandem emulate footbot`
};

/// A run of foot-bots under one tracker with 30 exposures a second, 2 mm of noise, 60 ms late, whose clock is right.
struct MixedRun {
  std::vector<EmulatedRobot> robots;
  std::string script;       ///< Lua, of every robot
  std::string safety = {};  ///< `<safety …/>`; empty: none
  double seconds = 60.0;
};

/// Where a robot was, by its own log.
struct TruePlace {
  double t_ns = 0.0;  ///< CLOCK_MONOTONIC
  double x_m = 0.0, y_m = 0.0, heading_rad = 0.0;
};
using TrueTrack = std::vector<TruePlace>;
/// Between two lines of the log; before and after them the nearest.
TruePlace place_at(const TrueTrack& track, double t_ns);

/// A table of a record: numbers by robot and column, a row a tick.
struct RecordTable {
  std::vector<std::string> columns;
  std::map<std::string, std::vector<std::vector<double>>> rows;  ///< by id
  std::size_t column(const std::string& name) const;             ///< @throws std::out_of_range when there is none
};

/// What became of a run. Its files are removed with it.
class Laboratory {
 public:
  /// Runs it to its end. Error: what could not be started, with its own words.
  static hal::Result<std::unique_ptr<Laboratory>> run(const MixedRun& run);

  hal::Result<TrueTrack> log_of(const std::string& id) const;
  /// When the robot's wheels got another speed (CLOCK_MONOTONIC, ns), by its own log.
  std::vector<double> told_of(const std::string& id) const;
  hal::Result<RecordTable> table(const std::string& name) const;
  /// What `tandem fit` finds in the record.
  hal::Result<hal::Json> fit() const;
  /// The longest that a thread of hub, robots or tracker waited for a processor between two looks, 0.2 s apart.
  hal::TimeNs longest_wait_ns() const { return longest_wait_ns_; }

 private:
  Laboratory() = default;
  hal::TemporaryFolder folder_{"tandem_validate"};
  hal::TimeNs longest_wait_ns_ = 0;
};

/// Runs and lets `judge` fill a part with tables and figures, up to three times: what is not met while a thread had to
/// wait 60 ms and more for a processor is not the program's doing, so that trial is void. Rows of a last one that is
/// void are not made. All trials are in a table. @throws std::runtime_error when nothing can be run
void in_fair_trials(Part& part, const MixedRun& run, const std::function<void(Part&, const Laboratory&)>& judge);

}  // namespace tandem::validate
