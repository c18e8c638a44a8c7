// An ASEBA node: a microcontroller that runs ASEBA's virtual machine around its device.
//
// Source: the ASEBA project, vm/vm.c and transport/buffer/vm-buffer.c. Its main loop is: device -> variables, programs,
// messages, variables -> device.
#pragma once
#include <cstdint>
#include <functional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/aseba_emulation/message.hpp"
#include "bridges/emulation/event_log.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::aseba_emulation {

struct Variable {
  std::string name;
  std::uint16_t words = 1;
};

struct LocalEvent {
  std::string name, doc;
};

/// A function that programs may call with variables.
struct NativeFunction {
  struct Argument {
    std::int16_t words;  ///< -1: as many as the other one has
    std::string name;
  };
  std::string name, doc;
  std::vector<Argument> arguments;
  /// What it does with its arguments' first words; none: it is described, and a program that calls it is stopped.
  std::function<void(std::span<const std::int16_t> values)> call = {};
};

/// Of the protocol. Version 5 brought LIST_NODES, NODE_PRESENT and GET_NODE_DESCRIPTION.
enum class Protocol : std::uint16_t { V4 = 4, V5 = 5 };

/// What a node may say of itself that is not so. All of it concerns the first variable of its device.
enum class Lie : std::uint8_t { None, Size, Count, Name };
/// "size", "count" or "name".
hal::Result<Lie> lie_named(std::string_view text);

/// What a node is built with.
struct NodeSpec {
  std::uint8_t id = 1;
  std::string name;
  Protocol protocol = Protocol::V5;
  /// Its own number, and of received events the source and the arguments, come first; from the fourth on its device's.
  std::vector<Variable> variables;
  std::vector<LocalEvent> events;
  std::vector<NativeFunction> functions;
  std::uint16_t bytecode_words = 0, stack_words = 0, variable_words = 0;
  bool runs_programs = false;  ///< else they are stored, and never run
  bool reset_clears = false;   ///< a reset, also that of a new program, clears all variables
};

class Node {
 public:
  explicit Node(NodeSpec spec);

  std::uint8_t id() const noexcept { return spec_.id; }
  const std::string& name() const noexcept { return spec_.name; }
  /// The words of a variable that there is.
  std::span<std::int16_t> words(std::string_view variable);
  std::span<const std::int16_t> words(std::string_view variable) const;

  /// Does what `message`, from anyone else on the bus, asks; adds its answers to `out`. What it did is told to `sink`.
  /// REBOOT is left to the caller: it ends with `restart`.
  void obey(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink);
  /// Its own event of that name has happened: its program is told.
  void happen(std::string_view event, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink);
  /// Whether the last message wrote to that variable.
  bool written(std::string_view variable) const;
  /// Whether there was a reset since the last call.
  bool take_reset() { return std::exchange(reset_, false); }

  /// Power came, or came back: every word is 0, as is the program unless it was written to flash.
  void restart();

  void set_lie(Lie lie) noexcept { lie_ = lie; }

 private:
  static constexpr std::uint16_t kMostGet = 257;  // words that fit one answer

  std::uint16_t address_of(std::string_view variable) const;
  void describe(hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) const;
  void tell_state(std::vector<Message>& out) const { out.push_back(say(type::kExecutionState).add(0).add(flags_)); }
  void obey_order(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink);
  void take_event(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink);
  void get(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) const;
  void set(const Message& message, hal::TimeNs at, const EventSink& sink);
  bool debug(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink);
  void load(const Message& message);
  void reset();
  std::uint16_t handler_of(std::uint16_t event) const;
  void run_handler(std::uint16_t event, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink);
  Message say(std::uint16_t type) const { return {spec_.id, type, {}}; }

  NodeSpec spec_;
  Lie lie_ = Lie::None;
  std::vector<std::int16_t> memory_;
  std::vector<std::uint16_t> bytecode_, flash_;
  std::set<std::uint16_t> breakpoints_;
  std::uint16_t flags_ = 0;  // 2: steps one by one
  bool init_waits_ = false;  // for RUN
  bool reset_ = false;
  std::uint16_t written_from_ = 0, written_until_ = 0;
};

}  // namespace tandem::bridges::aseba_emulation
