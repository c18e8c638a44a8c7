// Record of a run: poses, ports, published state, scene and incidents of chosen ticks in one append-only block file.
//
// The payloads of the blocks (core/record/block_file.hpp), by type:
//
//   1 Start        JSON: program, experiment, seed, ticks a second, …: whatever its writer says
//   2 Stream       JSON {"stream": n, "of": "robot" | "object", "set": "pose" | "sensor" | "actuator" | "state" |
//   "look"
//                  | "input" | "sent" | "time", "name": …, "on_change": true, "fields": [{"name", "type": "f32" | "f64"
//                  | "u8" | "u16" | "u32" | "i32" | "i64" | "bool", "count", "scale", "unit", "doc", "used_by",
//                  "per_entry", "texts"}, …]}: the form of rows that follow. With "on_change" rows are written when
//                  they differ from the last
//   3 Members      JSON {"members": n, "ids": […], "kinds": […], "kind": [index into kinds, …], "real": [index into
//                  ids, …], "bodies": [what there is to draw of each of the kinds, …]}: whose rows they are
//   4 Rows         u32 stream, u32 members, u32 rows, u32 0; then field by field the values of all rows, row by row,
//                  without gaps. The value is the number times `scale`. The smallest i32 stands for "no number". Of a
//                  field with `used_by` a row has only as many values as that field of the row says, times `per_entry`;
//                  that field comes before
//   5 Scene        JSON: arena, boxes, cylinders, lamps, borders of regions, as they are from this tick on
//   6 Event        JSON {"kind": "incident" | "action" | …, …}
//   7 Fingerprint  u64: of the world's state after this tick
//   8 End          JSON: how the run ended. A record without it was cut
//   9 Floor        a PNG picture of 8 bits of grey a pixel over the arena, from this tick on; nothing: it is uniform
//  10 Sketch       JSON {"shapes": […]}: what hooks drew, from this tick on
//  11 Back         nothing: the run went back to where this many ticks (the block's) were done, and goes on from there:
//                  all rows from that tick on that came before this block are of a branch that was left
//  12 Inputs       rows of the set "input", of every tick (core/record/input_block.hpp); of tick -1: before the run
//  13 Checks       what tells of a fingerprint that differs whose it is: u32 fields, u32 robots, then a u8 for each
//                  (core/space/fingerprint.hpp)
//
// Blocks of types that a reader does not know are to be passed over. Members and streams are declared before they are
// used, also for branches after the one they stand in; numbers are not used twice. The tick of a block is the one whose
// end it shows; -1: before the first.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "core/space/fingerprint.hpp"
#include "core/space/space.hpp"
#include "core/space/space_inputs.hpp"
#include "hal/json/json.hpp"
#include "hal/output_file.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::core {

struct RecordTable;

enum class RecordBlock : std::uint16_t {
  Start = 1,
  Stream,
  Members,
  Rows,
  Scene,
  Event,
  Fingerprint,
  End,
  Floor,
  Sketch,
  Back,
  Inputs,
  Checks
};

/// Writes a record while a run goes on. The thread that steps copies; one of the recorder's own encodes and writes, and
/// is waited for before the next rows are copied: of the ticks that are done, a killed run loses the last at most.
class Recorder {
 public:
  /// Opens the file and writes `start`, and what there is before the first tick. Errors: the file cannot be written; a
  /// pattern that fits no robot; a port that no chosen robot's controller took.
  static hal::Result<std::unique_ptr<Recorder>> open(const RecordConfig& config, const Space& space,
                                                     const hal::Json& start);
  /// Without `close` the part of the file stays, readable.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Rows kept elsewhere are written as well. Before the first tick.
  hal::Status add(const RecordTable& table);
  /// Real robots take part: from now on everything that reaches the space from outside is written in every tick, and
  /// what there is of it before the first one now. `inputs` must outlive this. Error: as `tick_done`.
  hal::Status set_inputs(const Space& space, const SpaceInputs& inputs);
  /// To be called after every tick, with the number of the tick that was done. Error: the disk is full or gone; nothing
  /// is written any more.
  hal::Status tick_done(const Space& space, hal::Tick tick);
  /// The run went back to where `to` ticks were done, and goes on from there. (`tick_done` sees by itself that a tick
  /// is not later than the last one; but events of the new branch are to come after this.)
  hal::Status went_back(std::int64_t to);
  /// Whether a fingerprint is wanted after this tick: with real robots of every one.
  bool wants_fingerprint(hal::Tick tick) const noexcept;
  /// Whether it is to come with its checks.
  bool wants_checks() const noexcept;
  hal::Status fingerprint(hal::Tick tick, std::uint64_t fingerprint);
  hal::Status checks(hal::Tick tick, const StateChecks& checks);
  /// Something that happened in this tick; `event` has a "kind". What an operator does before a tick has that tick.
  /// {"kind": "back", "to": ticks} includes `went_back`.
  hal::Status event(hal::Tick tick, const hal::Json& event);
  /// Writes the end and puts the file in its place. Error: as `tick_done`.
  hal::Status close(hal::Tick tick, const hal::Json& end);
  /// Until `close`.
  const hal::OutputFile& file() const noexcept;
  /// Bytes that the record has so far.
  std::uint64_t bytes() const noexcept;

 private:
  struct Impl;
  explicit Recorder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace tandem::core
