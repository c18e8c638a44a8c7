// One ASEBA node as the host knows it: its description, and an image of its variables.
#pragma once
#include <string>
#include <vector>

#include "bridges/aseba/message.hpp"
#include "bridges/round_trips.hpp"

namespace tandem::bridges::aseba {

/// A named range of a node's memory.
struct Variable {
  std::string name;
  std::uint16_t address = 0;  ///< sum of the sizes of the variables before it
  std::uint16_t words = 0;
  friend bool operator==(const Variable&, const Variable&) = default;
};

/// A node as it says it is.
struct NodeDescription {
  std::string name;
  std::uint16_t version = 0;
  std::uint16_t bytecode_words = 0;
  std::uint16_t variable_words = 0;  ///< of its whole memory for variables, named or not
  std::vector<Variable> variables;
  std::vector<std::string> local_events;
  std::vector<std::string> native_functions;

  const Variable* variable(std::string_view variable_name) const noexcept;
  /// Words that have a name.
  std::size_t named_words() const noexcept;
  friend bool operator==(const NodeDescription&, const NodeDescription&) = default;
};

/// A description while it arrives. What cannot be is refused: it would lead to wrong addresses.
class DescriptionDraft {
 public:
  enum class Progress : std::uint8_t { None, Collecting, Complete, Refused };

  static constexpr std::size_t kMostVariables = 1024;  ///< named ones; modules have some tens
  static constexpr std::size_t kMostNames = 1024;      ///< of local events, and of native functions
  static constexpr std::size_t kMostMemory = 16384;    ///< words; the modules' processors have less

  /// Restarts.
  void begin(const Description& description);
  void add(const NamedVariable& variable);
  void add(const LocalEvent& event);
  void add(const NativeFunction& function);
  void clear();

  Progress progress() const noexcept { return progress_; }
  /// Why it was refused; for people.
  const std::string& trouble() const noexcept { return trouble_; }
  /// Complete ones only.
  const NodeDescription& description() const noexcept { return description_; }

 private:
  void refuse(std::string why);
  void look_whether_complete() noexcept;

  Progress progress_ = Progress::None;
  NodeDescription description_;
  std::size_t variables_ = 0, events_ = 0, functions_ = 0;  // announced
  std::size_t words_ = 0;
  std::string trouble_;
};

enum class NodeState : std::uint8_t {
  Absent,   ///< never heard of
  Present,  ///< heard of; its description is awaited
  Refused,  ///< heard of; its description cannot be true, and is asked for again
  Ready,    ///< described; its variables can be read and written
  Lost      ///< was there, and is silent
};
const char* node_state_name(NodeState state) noexcept;

/// Every kind of trouble has its counter.
struct NodeStatistics {
  std::uint64_t messages = 0;        ///< heard of it
  std::uint64_t not_understood = 0;  ///< of them
  std::uint64_t descriptions = 0;    ///< complete and possible
  std::uint64_t incomplete = 0;      ///< descriptions of which a part did not come
  std::uint64_t impossible = 0;      ///< descriptions that cannot be true
  std::uint64_t changed = 0;         ///< descriptions other than the last one
  std::uint64_t reads = 0;           ///< asked
  std::uint64_t answers = 0;         ///< to reads
  std::uint64_t asked_again = 0;
  std::uint64_t unanswered = 0;    ///< reads given up
  std::uint64_t wrong_length = 0;  ///< answers with a part missing or too much
  std::uint64_t unasked = 0;       ///< answers that were not asked for here
  std::uint64_t writes = 0;        ///< sent
  std::uint64_t refused = 0;       ///< reads and writes asked for while not Ready, or outside of its memory
  std::uint64_t events = 0;
  std::uint64_t program_errors = 0;  ///< its program was stopped: index, division, killed, its own
  std::uint64_t times_lost = 0;
  std::uint64_t times_ready = 0;
  std::uint64_t doubled = 0;  ///< presented itself more than once in a round: two nodes with one id?
  RoundTrips round_trips;     ///< of `answers`
};

/// Words of a node's memory, and what is to become of each.
struct Image {
  static constexpr std::uint8_t kWanted = 1;  ///< to be read
  static constexpr std::uint8_t kDirty = 2;   ///< to be written
  std::vector<std::int16_t> values;           ///< as last read
  std::vector<hal::TimeNs> taken_ns;          ///< arrival of each; 0: never
  std::vector<std::int16_t> to_write;
  std::vector<std::uint8_t> marks;

  void resize(std::size_t words);
  std::size_t size() const noexcept { return values.size(); }
  void mark(std::size_t start, std::size_t count, std::uint8_t mark) noexcept;
  void unmark(std::size_t start, std::size_t count, std::uint8_t mark) noexcept;

  struct Range {
    std::size_t start = 0;
    std::size_t count = 0;  ///< 0: none
  };
  /// The first marked range at or behind `from`, at most `most` long; gaps of up to `gap` words are taken along.
  Range next(std::uint8_t mark, std::size_t from, std::size_t most, std::size_t gap) const noexcept;
};

/// One row of the table.
struct Node {
  std::uint8_t id = 0;
  NodeState state = NodeState::Absent;
  std::uint16_t version = 0;    ///< of the protocol, as last heard; 0: not yet
  NodeDescription description;  ///< the last one believed
  /// Grows whenever it becomes Ready again: addresses may be others, and what was written is perhaps forgotten.
  std::uint64_t generation = 0;
  hal::TimeNs heard_ns = 0;
  std::string trouble;  ///< why it is Refused, or what stopped its program; for people
  Image image;
  NodeStatistics statistics;

  bool ready() const noexcept { return state == NodeState::Ready; }
  /// As last read. `address` within the image.
  std::int16_t value(std::size_t address) const noexcept { return image.values[address]; }
  /// When the oldest of these words was read; 0: one of them never was, or lies outside.
  hal::TimeNs taken_ns(std::size_t address, std::size_t count = 1) const noexcept;
};

}  // namespace tandem::bridges::aseba
