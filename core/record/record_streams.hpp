// Rows of a record: finds what there is in a space, copies it after a tick, encodes it as blocks.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/record/input_block.hpp"
#include "core/record/scene_json.hpp"
#include "core/scenario/scenario.hpp"
#include "core/space/space.hpp"
#include "core/space/space_inputs.hpp"
#include "hal/json/json.hpp"
#include "hal/port.hpp"
#include "hal/time.hpp"

namespace tandem::core {

/// In which order robots have their rows.
enum class RowOrder : std::uint8_t {
  Memory,  ///< as they lie there, which is fastest
  Ids      ///< as the file and then hooks brought them
};

/// Rows about robots that are kept elsewhere, and brought up to date between ticks.
struct RecordTable {
  const hal::RowType* type = nullptr;
  std::string_view set;
  std::vector<RobotId> robots;
  const void* first = nullptr;  ///< rows one after the other, of these robots; outlives the record
};

/// Streams of rows, and the members of each. `encode` may run on another thread than the others, not at the same time.
class RecordStreams {
 public:
  explicit RecordStreams(RecordConfig config, RowOrder order = RowOrder::Memory)
      : config_(std::move(config)), order_(order) {}

  /// Whether robots or movable objects came, went, or became real ones since `declare`.
  bool stale(const Space& space) const noexcept;
  /// Its rows are written with others that are due, where they differ from the last ones. `declare` is to follow.
  void add(RecordTable table) {
    tables_.push_back(std::move(table));
    generations_ = ~std::uint32_t{0};  // stale
  }
  /// Finds all again and appends the blocks that declare what no block has declared before.
  void declare(const Space& space, hal::Tick now, std::string& out);
  /// What reaches the space from outside is written in every tick from now on; it must outlive this. `declare` is to
  /// follow.
  void set_inputs(const SpaceInputs& inputs) noexcept { inputs_ = config_.inputs ? &inputs : nullptr; }
  /// Whether rows are wanted of ticks, too, in which none are due: inputs of real robots.
  bool every_tick() const noexcept { return inputs_ != nullptr; }
  /// Copies the rows; where none are `due`, only those of every tick.
  void copy(const Space& space, bool due);
  /// Appends blocks of what was copied last.
  void encode(hal::Tick tick, std::string& out);

 private:
  /// Where one field of a row lies, and how many of its values count.
  struct Layout {
    std::size_t offset = 0, size = 0, count = 1;  // of one value; of values
    const hal::Field* used_by = nullptr;
    std::size_t per_entry = 1;
  };
  /// Rows that lie in memory one after the other.
  struct Run {
    const std::byte* first = nullptr;
    std::size_t rows = 0, stride = 0;
  };
  enum class Sort : std::uint8_t { RobotPoses, ObjectPoses, Attitudes, ObjectAttitudes, Rows, State };
  enum class When : std::uint8_t {
    Due,     ///< every so many ticks
    Changed  ///< in those of them in which they differ from the last ones
  };
  /// Rows of one form, of the members that have such.
  struct Stream {
    Sort sort = Sort::RobotPoses;
    When when = When::Due;
    std::uint32_t number = 0, members = 0;
    std::size_t rows = 0;
    std::vector<std::uint32_t> indices;  // of poses: rows of bodies, or numbers of objects
    bool in_order = false;               // the indices are 0, 1, 2, …
    std::size_t group = 0;               // of State
    std::vector<Layout> layouts;
    std::size_t row_bytes = 0;  // of a copied row
    std::vector<Run> runs;      // of Rows and State: where they lie

    bool copied = false, flat = true;   // flat: all z are 0
    std::vector<double> x, y, z, c, s;  // copied, of poses
    std::vector<std::byte> raw;         // copied, of others
    std::vector<std::byte> last;        // of Changed: what the last block says
  };
  struct Title {
    std::string_view set, name;
  };
  struct Chosen;
  static hal::Json declaration_of(const char* of, Title title, const hal::RowType& type);
  static void add_layouts(const hal::RowType& type, std::vector<Layout>& layouts);

  void declare_stream(Stream stream, hal::Json declaration, const hal::Json& members, hal::Tick now, std::string& out,
                      std::vector<Stream>& to);
  void declare_stream(Stream stream, hal::Json declaration, const hal::Json& members, hal::Tick now, std::string& out) {
    declare_stream(std::move(stream), std::move(declaration), members, now, out, streams_);
  }
  void declare_poses(const Space& space, const Chosen& chosen, hal::Tick now, std::string& out);
  void declare_attitudes(Stream attitudes, const char* of, const hal::Json& members, hal::Tick now, std::string& out);
  void declare_ports(const Space& space, const Chosen& chosen, hal::Tick now, std::string& out);
  void declare_state(const Space& space, const Chosen& chosen, hal::Tick now, std::string& out);
  void declare_look(const Space& space, const Chosen& chosen, hal::Tick now, std::string& out);
  void declare_inputs(const Space& space, hal::Tick now, std::string& out);
  void declare_tables(const Space& space, hal::Tick now, std::string& out);
  void declare_objects(const Space& space, hal::Tick now, std::string& out);
  void declare_rows(const Space& space, const Chosen& chosen, const hal::RowType& type, Title title,
                    const std::function<const std::byte*(std::size_t)>& first_of, hal::Tick now, std::string& out);
  void copy_rows(const Space& space, Stream& stream) const;
  void copy_robot_poses(const Space& space, Stream& stream) const;
  void encode_poses(const Stream& stream, std::string& out);
  static void encode_rows(const Stream& stream, std::string& out);
  void encode_inputs(hal::Tick tick, std::string& out);

  RecordConfig config_;
  RowOrder order_;
  std::vector<RecordTable> tables_;
  std::vector<Stream> streams_;
  const SpaceInputs* inputs_ = nullptr;  // null: none are written
  std::uint64_t inputs_version_ = 0;
  std::vector<Stream> input_streams_;
  std::vector<InputTable> input_tables_;  // scratch
  InputEncoder input_encoder_;
  std::map<std::string, std::uint32_t> stream_numbers_;   // by their declaration without the number
  std::map<std::string, std::uint32_t> members_numbers_;  // by theirs
  std::uint32_t generations_ = 0;
  std::size_t living_ = 0, objects_ = 0, real_ = 0;
  KindBodies bodies_;                  // of this declaration
  std::vector<std::int32_t> numbers_;  // scratch
};

}  // namespace tandem::core
