// Trajectories as CSV: where chosen robots were, every so many ticks.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/record/pattern.hpp"
#include "core/scenario/scenario.hpp"
#include "core/space/space.hpp"
#include "hal/output_file.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::core {

/// Whole lines that were recorded and not yet written, to end the process from a signal handler: at `data`,
/// `size` bytes of them, to be appended to `descriptor`. 0 bytes while a record is made.
struct UnwrittenRecords {
  std::atomic<const char*> data{nullptr};
  std::atomic<std::size_t> size{0};
  int descriptor = -1;
};

/// Writes lines "tick,time_s,id,x_m,y_m,z_m,heading_rad": the table of poses of a record (core/record/record.hpp),
/// written as text at once. The poses are those that the bodies had at the end of that tick, in W, with the heading in
/// (-pi, pi]; metres and radians with 6 decimals, the time in full. Ids with a comma or a quote in them are quoted [RFC
/// 4180].
class TrajectoryRecorder {
 public:
  /// Opens the file and finds the robots. Errors: the file cannot be written; a pattern that fits none of the robots
  /// there (with what there is that is spelled alike).
  static hal::Result<std::unique_ptr<TrajectoryRecorder>> open(const TrajectoryConfig& config, const Space& space,
                                                               std::int64_t ticks_per_second);
  /// Closes when anything was recorded; use `close` to learn whether that worked.
  ~TrajectoryRecorder();
  TrajectoryRecorder(const TrajectoryRecorder&) = delete;
  TrajectoryRecorder& operator=(const TrajectoryRecorder&) = delete;

  /// To be called after every tick; records each `every`th. Robots that were removed have no line any more; those that
  /// came since `open` and fit have lines after the others.
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

}  // namespace tandem::core
