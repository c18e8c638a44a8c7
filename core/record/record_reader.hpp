// Reads records of runs (core/record/record.hpp), block by block.
#pragma once
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/record/block_file.hpp"
#include "core/record/input_block.hpp"
#include "core/record/record.hpp"
#include "hal/json/json.hpp"
#include "hal/port.hpp"

namespace tandem::core {

struct RecordField {
  std::string name, unit, doc;
  hal::Scalar scalar = hal::Scalar::F32;
  std::size_t count = 1;  ///< values a row at most
  double scale = 1.0;     ///< a value is the number times this
  std::optional<std::size_t>
      used_by;  ///< the field, among those before or after, that holds how many entries are in use
  std::size_t per_entry = 1;
  std::vector<std::string> texts;  ///< of an enumeration: its values from 0 on, in words
};

/// The form of rows.
struct RecordStream {
  std::string of;          ///< "robot" or "object"
  std::string set;         ///< "pose", "sensor", "actuator", "state", "look", "input", "sent" or "time"
  std::string name;        ///< e.g. "pose", "proximity"
  bool on_change = false;  ///< rows hold until there are others
  std::vector<RecordField> fields;
  /// "pose", "sensor proximity", "object pose": as people name it.
  std::string title() const;
};

/// Whose rows they are.
struct RecordMembers {
  std::vector<std::string> ids;
  std::vector<std::string> kinds;  ///< of each
  std::vector<bool> real;          ///< of each: a real robot
  std::vector<std::size_t> kind;   ///< of each: index into `bodies`, if that has so many
  std::vector<std::size_t> order;  ///< all of them, as the file lists them and hooks added them
  hal::Json bodies;                ///< of their kinds: what there is to draw; as it stands in the record
};

/// Rows of one stream at the end of one tick.
class RecordRows {
 public:
  const RecordStream& stream() const noexcept { return *stream_; }
  const RecordMembers& members() const noexcept { return *members_; }
  std::size_t size() const noexcept { return members_->ids.size(); }
  /// How many values a field of a row has.
  std::size_t used(std::size_t field, std::size_t row) const noexcept;
  /// NaN: no number.
  double value(std::size_t field, std::size_t row, std::size_t index = 0) const noexcept;
  /// The values of a field of a row as they stand in the record: `used` of them, little-endian.
  std::string_view bytes(std::size_t field, std::size_t row) const noexcept;

 private:
  friend class RecordDecoder;
  std::shared_ptr<const RecordStream> stream_;
  std::shared_ptr<const RecordMembers> members_;
  std::string_view data_;
  std::vector<std::size_t> at_;  // by field: where its values begin
  std::vector<std::vector<std::size_t>>
      starts_;                              // of fields with `used_by`, by row: the first value; one more at the end
  std::shared_ptr<const std::string> own_;  // of inputs: where `data_` lies
};

struct RecordEntry {
  RecordBlock type = RecordBlock::Start;
  hal::Tick tick = 0;
  hal::Json json = {};                  ///< of Scene, Event, End, Sketch
  std::string_view bytes = {};          ///< of Floor and Checks
  std::optional<RecordRows> rows = {};  ///< of Rows and Inputs
  std::uint64_t fingerprint = 0;        ///< of Fingerprint
};

/// Makes sense of blocks, whatever they hold.
class RecordDecoder {
 public:
  /// Takes a Stream or Members block. Error: it makes no sense, and is forgotten.
  hal::Status declare(const Block& block);
  /// What another block says; nothing: it is a declaration, or of a later release. Error: it makes no sense.
  hal::Result<std::optional<RecordEntry>> read(const Block& block) const;
  /// Rows of inputs. Error: they make no sense.
  hal::Result<RecordRows> input_rows(const InputDecoder::Table& table) const;
  /// Of the payload of Rows; null: it was not declared.
  std::shared_ptr<const RecordStream> stream_of(std::string_view rows) const;

 private:
  hal::Status declare_stream(const hal::Json& json);
  hal::Status declare_members(const hal::Json& json);
  hal::Result<RecordRows> rows(std::string_view payload) const;
  hal::Result<RecordRows> rows(std::uint32_t stream, std::uint32_t members, std::string_view data,
                               std::size_t at) const;

  std::map<std::uint64_t, std::shared_ptr<const RecordStream>> streams_;
  std::map<std::uint64_t, std::shared_ptr<const RecordMembers>> members_;
};

/// Something that happened.
struct RecordEvent {
  hal::Tick tick = 0;
  hal::Json json;
};

/// No input is undefined: blocks that are damaged or make no sense are left out and told. Branches of a run that were
/// left, because it went back to an earlier tick, are passed over but for events. Looks through the file once when it
/// is opened, at the headers of its blocks alone, and needs 24 bytes a tick.
class RecordReader {
 public:
  /// Errors: cannot be read, no record, another version, no Start block.
  static hal::Result<RecordReader> open(const std::string& path);

  const hal::Json& start() const noexcept { return start_; }
  /// The next that is no declaration; nothing at the end. What it gives refers to the reader's memory. Of a block of
  /// inputs it gives one entry for each table, also where that is as in the tick before.
  std::optional<RecordEntry> next();

  /// Ticks that have poses of robots, rising; -1: before the first.
  const std::vector<hal::Tick>& ticks() const noexcept { return ticks_; }
  /// Makes `next` go on with the first block of the i-th of them.
  void go_to(std::size_t i) noexcept;
  /// What was said before the i-th of them, and holds until something else is said: the last scene, floor, drawing, and
  /// rows of each stream that is written on change.
  std::vector<RecordEntry> standing(std::size_t i);
  /// All that happened, in the file's order.
  const std::vector<RecordEvent>& events();

  /// What was left out so far, one line each.
  std::vector<std::string> damage() const;
  /// Whether the last block is missing: the run was killed.
  bool cut() const noexcept { return cut_; }

 private:
  explicit RecordReader(BlockFileReader file) : file_(std::move(file)) {}
  struct Range {
    std::size_t begin = 0, end = 0;
  };

  void find_blocks();
  bool left(std::size_t at) const noexcept;
  void leave_branch(std::int64_t to, std::size_t at);
  std::optional<RecordEntry> entry_of(const Block& block);
  void take_inputs(const Block& block);
  void complain(const Block& block, const std::string& why);

  BlockFileReader file_;
  hal::Json start_;
  RecordDecoder decoder_;
  std::vector<hal::Tick> ticks_;
  std::vector<std::size_t> places_;                             // of ticks_: where their first block begins
  std::vector<Range> left_;                                     // branches, in the file's order
  std::map<std::uint64_t, std::vector<std::size_t>> standing_;  // where blocks begin, by what they say
  std::vector<std::size_t> event_places_;
  std::optional<std::vector<RecordEvent>> events_;
  std::map<std::size_t, std::string> senseless_;  // by where it is
  InputDecoder inputs_;
  std::deque<RecordEntry> pending_;  // of the last block of inputs
  bool cut_ = false;
};

}  // namespace tandem::core
