// Map from variables of nodes to fields of ports: plain data, read from a file.
//
// The names of nodes and variables differ from robot to robot, and with the programs of their modules. None of them is
// known here: a robot with other names needs another map and no other code. Addresses are in no map, they come from the
// nodes' descriptions.
#pragma once
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "hal/port.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::footbot {

/// Number format of a variable's words.
enum class WordForm : std::uint8_t {
  Int16,
  Uint16,
  Int32LowFirst,   ///< two words, the low one first
  Int32HighFirst,  ///< two words, the high one first
  Bytes            ///< two numbers in a word, the low byte first
};

/// A place on a measured curve.
struct Knot {
  double raw = 0.0;
  double value = 0.0;  ///< SI
};

/// Some numbers of a variable are some elements of a port's field: number `i` of the row is element
/// `element + i * element_step`.
struct FieldMap {
  const hal::PortType* port = nullptr;  ///< never null in a map; both live as long as the program
  const hal::Field* field = nullptr;
  WordForm form = WordForm::Int16;
  std::size_t word = 0;  ///< of the variable, where number 0 begins
  int word_step = 1;     ///< from one number to the next, in numbers
  std::size_t element = 0;
  int element_step = 1;
  std::size_t count = 1;

  // value = offset + scale * raw, or what the curve says
  double scale = 1.0;  ///< SI per count, never 0
  double offset = 0.0;
  std::vector<Knot> curve;     ///< when not empty, two or more, raw ascending: instead of scale and offset; flat beyond
  std::vector<Knot> specials;  ///< raw numbers with a meaning of their own, e.g. "nothing seen"
  double min = -std::numeric_limits<double>::infinity();  ///< of read values, SI: others are clamped
  double max = std::numeric_limits<double>::infinity();

  // reading
  bool accumulate = false;           ///< a counter that wraps: the field is the sum of its differences
  const hal::Field* rate = nullptr;  ///< a field of the same port for the change per second; wraps are seen through
  double fastest = std::numeric_limits<double>::infinity();  ///< per second, SI: a counter that changes faster jumped

  // writing
  std::int32_t least = std::numeric_limits<std::int32_t>::min();  ///< raw
  std::int32_t most = std::numeric_limits<std::int32_t>::max();
  std::int32_t rest = 0;             ///< raw: written when the robot is to stand still, and before anything else
  const hal::Field* when = nullptr;  ///< a flag of the same port: while it is not set, `rest` is written
};

/// A named range of a node's memory. Of several names the first that the node has counts.
struct VariableMap {
  std::vector<std::string> names;
  std::size_t words = 1;      ///< a node whose variable has another size is not believed
  hal::TimeNs period_ns = 0;  ///< between reads; 0: every tick
  bool optional = false;      ///< the node is complete without it
  bool verify = false;        ///< what is written is read back, and written again when it is not there
  std::vector<FieldMap> reads;
  std::vector<FieldMap> writes;  ///< together they cover every word, or there are none
  int line = 0;                  ///< in the map's file, for messages
};

/// A user event whose arguments are one range-and-bearing message.
struct PacketMap {
  std::uint16_t number = 0;
  std::size_t words = 0;
  FieldMap range, bearing, elevation, payload;  ///< `count` 0: the event has no such argument
  int line = 0;
};

/// Condition under which the robot may not drive without a node.
enum class Need : std::uint8_t {
  Always,
  Used,  ///< when a port was taken that it serves
  Never
};

/// A program that puts the node's written variables to rest when the hub has fallen silent
/// (bridges/aseba/dead_man.hpp).
struct DeadManMap {
  std::string event;          ///< the node's own event that comes again and again; "": no such program
  hal::TimeNs period_ns = 0;  ///< between two of them
  hal::TimeNs after_ns = 0;   ///< of silence
};

struct NodeMap {
  std::vector<std::string> names;
  std::uint8_t id = 0;  ///< asked for from the start, which finds old, silent nodes sooner; 0: not known
  Need need = Need::Used;
  std::vector<VariableMap> variables;
  std::vector<PacketMap> packets;
  DeadManMap dead_man;
  int line = 0;
};

struct FootbotMap {
  std::string profile;
  hal::TimeNs refresh_ns = 500 * hal::kNsPerMs;  ///< writes are repeated this often, without acknowledgements
  std::vector<NodeMap> nodes;
};

}  // namespace tandem::bridges::footbot
