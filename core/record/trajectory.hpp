// Trajectories as CSV: where chosen robots were, every so many ticks, and what chosen ports held.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "core/space/space.hpp"
#include "hal/output_file.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::core {

/// Whole lines that were recorded and not yet written, for who must end the process from a signal handler: at `data`,
/// `size` bytes of them, to be appended to `descriptor`. 0 bytes while a record is made.
struct UnwrittenRecords {
  std::atomic<const char*> data{nullptr};
  std::atomic<std::size_t> size{0};
  int descriptor = -1;
};

/// Writes lines "tick,time_s,id,x_m,y_m,heading_rad": the poses that the bodies had at the start of that tick, in W,
/// with the heading in (-pi, pi]; metres and radians with 6 decimals, the time in full.
/// Ids with a comma or a quote in them are quoted [RFC 4180].
///
/// With ports, each of their fields adds a column "port.field" or, for fields of several values, "port.field[0]", …: as
/// many as were in use when the first line was written (for message lists: as many as there can be). Values that a
/// robot does not have are empty. The header is written with the first line.
class TrajectoryRecorder {
 public:
  /// Opens the file and finds the robots. `ports` are names of ports that at least one chosen robot's controller took.
  /// Errors: the file cannot be written; a pattern that fits none of the robots there, or a port that no chosen robot
  /// has (with what there is that is spelled alike).
  static hal::Result<std::unique_ptr<TrajectoryRecorder>> open(const TrajectoryConfig& config, const Space& space,
                                                               std::int64_t ticks_per_second,
                                                               const std::vector<std::string>& ports = {});
  /// Closes when anything was recorded; use `close` to learn whether that worked.
  ~TrajectoryRecorder();
  TrajectoryRecorder(const TrajectoryRecorder&) = delete;
  TrajectoryRecorder& operator=(const TrajectoryRecorder&) = delete;

  /// To be called after every tick; records each `every`th. Robots that were removed have no line any more; those that
  /// came since `open` and fit have lines after the others, with values for the columns that there are.
  /// Error: the disk is full or gone. What was written until then stays in the part, whole lines of it, and no later
  /// call writes anything.
  hal::Status record(const Space& space, hal::Tick tick);

  /// Hands everything recorded so far to the system, so that it outlives this process.
  hal::Status flush();
  /// Flushes and puts the file in its place. Error: as `record`, also one that `record` has already told; the old file
  /// then stays.
  hal::Status close();

  const UnwrittenRecords& unwritten() const noexcept;
  /// Until `close`.
  const hal::OutputFile& file() const noexcept;

 private:
  struct Impl;
  explicit TrajectoryRecorder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Whether `text` fits `pattern`, in which each '*' stands for any number of characters.
bool fits_pattern(std::string_view text, std::string_view pattern) noexcept;

}  // namespace tandem::core
