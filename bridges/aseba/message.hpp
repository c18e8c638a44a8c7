// Every message of ASEBA's protocol, versions 4 and 5, and its bytes. Pure functions; no input is undefined.
//
// Numbers are 16 bits, little-endian; a text is a byte for its length and as many bytes of UTF-8. Each message spells
// its fields once, in `fields`; encoder and decoder are visitors of it.
//
// Sources: aseba-community/aseba, aseba/common/consts.h (numbers), aseba/common/msg/msg.h and msg.cpp (payloads),
// aseba/vm/vm.c (meaning of the flags of the execution state, of starts and lengths).
#pragma once
#include <string_view>
#include <variant>

#include "bridges/aseba/wire.hpp"

namespace tandem::bridges::aseba {

/// Numbers of the message types. Those below 0x8000 are user events.
enum class Type : std::uint16_t {
  BootloaderReset = 0x8000,
  BootloaderReadPage = 0x8001,
  BootloaderWritePage = 0x8002,
  BootloaderPageDataWrite = 0x8003,
  BootloaderDescription = 0x8004,
  BootloaderPageDataRead = 0x8005,
  BootloaderAck = 0x8006,
  Description = 0x9000,
  NamedVariable = 0x9001,
  LocalEvent = 0x9002,
  NativeFunction = 0x9003,
  Disconnected = 0x9004,
  Variables = 0x9005,
  OutOfBounds = 0x9006,
  DivisionByZero = 0x9007,
  ExecutionKilled = 0x9008,
  NodeError = 0x9009,
  ExecutionState = 0x900A,
  BreakpointResult = 0x900B,
  NodePresent = 0x900C,
  GetDescription = 0xA000,
  SetBytecode = 0xA001,
  Reset = 0xA002,
  Run = 0xA003,
  Pause = 0xA004,
  Step = 0xA005,
  Stop = 0xA006,
  GetExecutionState = 0xA007,
  BreakpointSet = 0xA008,
  BreakpointClear = 0xA009,
  BreakpointClearAll = 0xA00A,
  GetVariables = 0xA00B,
  SetVariables = 0xA00C,
  WriteBytecode = 0xA00D,
  Reboot = 0xA00E,
  SuspendToRam = 0xA00F,
  GetNodeDescription = 0xA010,
  ListNodes = 0xA011,
};
inline constexpr std::uint16_t kFirstBootloader = 0x8000;
inline constexpr std::uint16_t kFirstCommand = 0xA000;
inline constexpr std::uint16_t kVersion = 5;     ///< that this side speaks
inline constexpr std::uint16_t kOldVersion = 4;  ///< the oldest that it understands
inline constexpr std::size_t kMostRead = 257;    ///< words in one Variables
inline constexpr std::size_t kMostWrite = 256;   ///< words in one SetVariables

/// Messages that are nothing but the node they are for.
template <Type T>
struct ToNode {
  static constexpr Type kType = T;
  std::uint16_t node = 0;
  static bool fields(auto& m, auto& io) { return io.word(m.node); }
  friend bool operator==(const ToNode&, const ToNode&) = default;
};
/// The node they are for, and a number: a page of flash memory, a place in the program, a protocol version.
template <Type T>
struct ToNodeWithNumber {
  static constexpr Type kType = T;
  std::uint16_t node = 0;
  std::uint16_t number = 0;
  static bool fields(auto& m, auto& io) { return io.word(m.node) && io.word(m.number); }
  friend bool operator==(const ToNodeWithNumber&, const ToNodeWithNumber&) = default;
};
/// One number: a protocol version, a place in the program.
template <Type T>
struct OneNumber {
  static constexpr Type kType = T;
  std::uint16_t number = 0;
  static bool fields(auto& m, auto& io) { return io.word(m.number); }
  friend bool operator==(const OneNumber&, const OneNumber&) = default;
};
/// A name and what it means.
template <Type T>
struct NameAndMeaning {
  static constexpr Type kType = T;
  std::string_view name;
  std::string_view meaning;
  static bool fields(auto& m, auto& io) { return io.text(m.name) && io.text(m.meaning); }
  friend bool operator==(const NameAndMeaning&, const NameAndMeaning&) = default;
};
/// The node they are for, where to begin, and words.
template <Type T>
struct ToNodeWithWords {
  static constexpr Type kType = T;
  std::uint16_t node = 0;
  std::uint16_t start = 0;
  Words words;
  static bool fields(auto& m, auto& io) { return io.word(m.node) && io.word(m.start) && io.words(m.words); }
  friend bool operator==(const ToNodeWithWords&, const ToNodeWithWords&) = default;
};

// --- commands to nodes ---
using BootloaderReset = ToNode<Type::BootloaderReset>;
using BootloaderReadPage = ToNodeWithNumber<Type::BootloaderReadPage>;
using BootloaderWritePage = ToNodeWithNumber<Type::BootloaderWritePage>;
using Reset = ToNode<Type::Reset>;
using Run = ToNode<Type::Run>;
using Pause = ToNode<Type::Pause>;
using Step = ToNode<Type::Step>;
using Stop = ToNode<Type::Stop>;
using GetExecutionState = ToNode<Type::GetExecutionState>;
using BreakpointSet = ToNodeWithNumber<Type::BreakpointSet>;
using BreakpointClear = ToNodeWithNumber<Type::BreakpointClear>;
using BreakpointClearAll = ToNode<Type::BreakpointClearAll>;
using WriteBytecode = ToNode<Type::WriteBytecode>;
using Reboot = ToNode<Type::Reboot>;
using SuspendToRam = ToNode<Type::SuspendToRam>;
using SetBytecode = ToNodeWithWords<Type::SetBytecode>;                 ///< implies a reset
using SetVariables = ToNodeWithWords<Type::SetVariables>;               ///< at most 256; never acknowledged
using GetNodeDescription = ToNodeWithNumber<Type::GetNodeDescription>;  ///< version 5
using GetDescription = OneNumber<Type::GetDescription>;                 ///< to all; nodes of version 5 answer only 4
using ListNodes = OneNumber<Type::ListNodes>;                           ///< to all; version 5

struct GetVariables {
  static constexpr Type kType = Type::GetVariables;
  std::uint16_t node = 0;
  std::uint16_t start = 0;
  std::uint16_t count = 0;  ///< at most 257; nodes do not check
  static bool fields(auto& m, auto& io) { return io.word(m.node) && io.word(m.start) && io.word(m.count); }
  friend bool operator==(const GetVariables&, const GetVariables&) = default;
};
struct BootloaderPageDataWrite {
  static constexpr Type kType = Type::BootloaderPageDataWrite;
  std::uint16_t node = 0;
  std::array<std::uint8_t, 4> data{};
  static bool fields(auto& m, auto& io) { return io.word(m.node) && io.bytes(m.data); }
  friend bool operator==(const BootloaderPageDataWrite&, const BootloaderPageDataWrite&) = default;
};

// --- what nodes say ---
struct BootloaderDescription {
  static constexpr Type kType = Type::BootloaderDescription;
  std::uint16_t page_size = 0, first_page = 0, pages = 0;
  static bool fields(auto& m, auto& io) { return io.word(m.page_size) && io.word(m.first_page) && io.word(m.pages); }
  friend bool operator==(const BootloaderDescription&, const BootloaderDescription&) = default;
};
struct BootloaderPageDataRead {
  static constexpr Type kType = Type::BootloaderPageDataRead;
  std::array<std::uint8_t, 4> data{};
  static bool fields(auto& m, auto& io) { return io.bytes(m.data); }
  friend bool operator==(const BootloaderPageDataRead&, const BootloaderPageDataRead&) = default;
};
struct BootloaderAck {
  static constexpr Type kType = Type::BootloaderAck;
  static constexpr std::uint16_t kWithAddress = 2;
  std::uint16_t error = 0;
  std::uint16_t address = 0;  ///< sent when `error` is 2, else 0
  static bool fields(auto& m, auto& io) { return io.word(m.error) && (m.error != kWithAddress || io.word(m.address)); }
  friend bool operator==(const BootloaderAck&, const BootloaderAck&) = default;
};
/// A node presents itself; as many NamedVariable, LocalEvent and NativeFunction as announced follow.
struct Description {
  static constexpr Type kType = Type::Description;
  std::string_view name;
  std::uint16_t version = 0;
  std::uint16_t bytecode_words = 0, stack_words = 0, variable_words = 0;
  std::uint16_t named_variables = 0, local_events = 0, native_functions = 0;
  static bool fields(auto& m, auto& io) {
    return io.text(m.name) && io.word(m.version) && io.word(m.bytecode_words) && io.word(m.stack_words) &&
           io.word(m.variable_words) && io.word(m.named_variables) && io.word(m.local_events) &&
           io.word(m.native_functions);
  }
  friend bool operator==(const Description&, const Description&) = default;
};
/// Its address is the sum of the sizes of those before it.
struct NamedVariable {
  static constexpr Type kType = Type::NamedVariable;
  std::uint16_t words = 0;
  std::string_view name;
  static bool fields(auto& m, auto& io) { return io.word(m.words) && io.text(m.name); }
  friend bool operator==(const NamedVariable&, const NamedVariable&) = default;
};
using LocalEvent = NameAndMeaning<Type::LocalEvent>;
/// The parameters lie back to back: a size (negative: as large as another parameter) and a name each.
struct NativeFunction {
  static constexpr Type kType = Type::NativeFunction;
  std::string_view name;
  std::string_view meaning;
  std::uint16_t parameters = 0;
  std::span<const std::uint8_t> parameter_bytes;
  static bool fields(auto& m, auto& io) {
    return io.text(m.name) && io.text(m.meaning) && io.word(m.parameters) &&
           io.parameters(m.parameters, m.parameter_bytes);
  }
  friend bool operator==(const NativeFunction& a, const NativeFunction& b) {
    return a.name == b.name && a.meaning == b.meaning && a.parameters == b.parameters &&
           std::ranges::equal(a.parameter_bytes, b.parameter_bytes);
  }
};
/// Made by switches: the node that is the source has left.
struct Disconnected {
  static constexpr Type kType = Type::Disconnected;
  static bool fields(auto&, auto&) { return true; }
  friend bool operator==(const Disconnected&, const Disconnected&) = default;
};
struct Variables {
  static constexpr Type kType = Type::Variables;
  std::uint16_t start = 0;
  Words words;
  static bool fields(auto& m, auto& io) { return io.word(m.start) && io.words(m.words); }
  friend bool operator==(const Variables&, const Variables&) = default;
};
struct OutOfBounds {
  static constexpr Type kType = Type::OutOfBounds;
  std::uint16_t pc = 0, size = 0, index = 0;
  static bool fields(auto& m, auto& io) { return io.word(m.pc) && io.word(m.size) && io.word(m.index); }
  friend bool operator==(const OutOfBounds&, const OutOfBounds&) = default;
};
using DivisionByZero = OneNumber<Type::DivisionByZero>;    ///< place in the program
using ExecutionKilled = OneNumber<Type::ExecutionKilled>;  ///< place in the program
struct NodeError {
  static constexpr Type kType = Type::NodeError;
  std::uint16_t pc = 0;
  std::string_view text;
  static bool fields(auto& m, auto& io) { return io.word(m.pc) && io.text(m.text); }
  friend bool operator==(const NodeError&, const NodeError&) = default;
};
struct ExecutionState {
  static constexpr Type kType = Type::ExecutionState;
  static constexpr std::uint16_t kEventActive = 1, kStepByStep = 2, kEventRunning = 4;
  std::uint16_t pc = 0, flags = 0;
  static bool fields(auto& m, auto& io) { return io.word(m.pc) && io.word(m.flags); }
  friend bool operator==(const ExecutionState&, const ExecutionState&) = default;
};
struct BreakpointResult {
  static constexpr Type kType = Type::BreakpointResult;
  std::uint16_t pc = 0, success = 0;
  static bool fields(auto& m, auto& io) { return io.word(m.pc) && io.word(m.success); }
  friend bool operator==(const BreakpointResult&, const BreakpointResult&) = default;
};
using NodePresent = OneNumber<Type::NodePresent>;  ///< protocol version

/// From anybody to everybody; its number is the message's type.
struct UserEvent {
  std::uint16_t number = 0;  ///< below 0x8000
  Words arguments;
  friend bool operator==(const UserEvent&, const UserEvent&) = default;
};

/// Any of them; texts and words lie in the decoded bytes.
using Message =
    std::variant<UserEvent, Variables, SetVariables, GetVariables, NodePresent, ListNodes, Description, NamedVariable,
                 LocalEvent, NativeFunction, GetDescription, GetNodeDescription, Disconnected, OutOfBounds,
                 DivisionByZero, ExecutionKilled, NodeError, ExecutionState, BreakpointResult, SetBytecode, Reset, Run,
                 Pause, Step, Stop, GetExecutionState, BreakpointSet, BreakpointClear, BreakpointClearAll,
                 WriteBytecode, Reboot, SuspendToRam, BootloaderReset, BootloaderReadPage, BootloaderWritePage,
                 BootloaderPageDataWrite, BootloaderDescription, BootloaderPageDataRead, BootloaderAck>;

enum class Decoded : std::uint8_t {
  Good,
  UnknownType,
  TooShort,  ///< a field is missing, or a text is longer than what is there
  TooLong    ///< bytes behind the last field, or half a word
};

/// Understands one message. `message` is undefined unless Good; it points into `payload`.
Decoded decode(std::uint16_t type, std::span<const std::uint8_t> payload, Message& message) noexcept;

std::uint16_t type_of(const Message& message) noexcept;
/// Replaces `payload`. False when a text is longer than 255 bytes, parameters contradict their number, the number of a
/// user event is not below 0x8000, or all is longer than a message may be.
bool encode(const Message& message, Payload& payload) noexcept;

}  // namespace tandem::bridges::aseba
