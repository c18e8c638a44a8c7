// Reads records of runs (core/record/record.hpp), block by block.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/record/block_file.hpp"
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
  std::string of;    ///< "robot" or "object"
  std::string set;   ///< "pose", "sensor", "actuator" or "state"
  std::string name;  ///< e.g. "pose", "proximity"
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

 private:
  friend class RecordReader;
  std::shared_ptr<const RecordStream> stream_;
  std::shared_ptr<const RecordMembers> members_;
  std::string_view data_;
  std::vector<std::size_t> at_;  // by field: where its values begin
  std::vector<std::vector<std::size_t>>
      starts_;  // of fields with `used_by`, by row: the first value; one more at the end
};

struct RecordEntry {
  RecordBlock type = RecordBlock::Start;
  hal::Tick tick = 0;
  hal::Json json = {};                  ///< of Scene, Event, End
  std::optional<RecordRows> rows = {};  ///< of Rows
  std::uint64_t fingerprint = 0;        ///< of Fingerprint
};

/// No input is undefined: blocks that are damaged or make no sense are left out and told.
class RecordReader {
 public:
  /// Errors: cannot be read, no record, another version, no Start block.
  static hal::Result<RecordReader> open(const std::string& path);

  const hal::Json& start() const noexcept { return start_; }
  /// The next that is no declaration; nothing at the end. What it gives refers to the reader's memory.
  std::optional<RecordEntry> next();
  /// What `next` left out so far, one line each.
  std::vector<std::string> damage() const;
  /// Whether the last block is missing: the run was killed.
  bool cut() const noexcept { return cut_; }

 private:
  explicit RecordReader(BlockFileReader file) : file_(std::move(file)) {}
  hal::Status declare_stream(const hal::Json& json);
  hal::Status declare_members(const hal::Json& json);
  hal::Result<RecordRows> rows(std::string_view payload) const;

  BlockFileReader file_;
  hal::Json start_;
  std::map<std::uint64_t, std::shared_ptr<const RecordStream>> streams_;
  std::map<std::uint64_t, std::shared_ptr<const RecordMembers>> members_;
  std::vector<std::string> senseless_;
  bool ended_ = false, cut_ = false;
};

}  // namespace tandem::core
