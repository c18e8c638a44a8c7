// One module of the robot: a microcontroller that runs ASEBA's virtual machine around its device.
//
// Source: the ASEBA project, vm/vm.c and transport/buffer/vm-buffer.c. Its main loop is: device -> variables, programs,
// messages, variables -> device. Programs are stored here, and never run: no module comes with one.
#pragma once
#include <set>
#include <span>

#include "bridges/emulation/event_log.hpp"
#include "bridges/footbot_emulator/message.hpp"

namespace tandem::bridges::footbot_emulator {

struct Variable {
  std::string name;
  std::uint16_t words = 1;
};

/// Of the protocol. Version 5 brought LIST_NODES, NODE_PRESENT and GET_NODE_DESCRIPTION; the robots are older.
enum class Protocol : std::uint16_t { V4 = 4, V5 = 5 };

/// What a module may say of itself that is not so. All of it concerns the first variable of its device.
enum class Lie : std::uint8_t { None, Size, Count, Name };

class Module {
 public:
  /// The variables that every module has, `id`, `source` and `args`, come first. `device` are its own.
  Module(std::uint8_t id, std::string name, std::vector<Variable> device, Protocol protocol);

  std::uint8_t id() const noexcept { return id_; }
  const std::string& name() const noexcept { return name_; }
  /// The words of a variable that there is.
  std::span<std::int16_t> words(std::string_view variable);
  std::span<const std::int16_t> words(std::string_view variable) const;

  /// Does what `message`, from anyone else on the bus, asks; adds its answers to `out`. What it did is told to `sink`.
  /// REBOOT is left to the caller: it ends with `restart`.
  void obey(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink);
  /// Whether the last message wrote to that variable.
  bool written(std::string_view variable) const;

  /// Power came, or came back: every word is 0, as is the program unless it was written to flash.
  void restart();

  void set_lie(Lie lie) noexcept { lie_ = lie; }

 private:
  static constexpr std::uint16_t kVariableWords = 256;
  static constexpr std::uint16_t kBytecodeWords = 1024;
  static constexpr std::uint16_t kStackWords = 32;
  static constexpr std::uint16_t kMostGet = 257;  // words that fit one answer

  std::uint16_t address_of(std::string_view variable) const;
  void describe(hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) const;
  void tell_state(std::vector<Message>& out) const;
  void obey_order(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink);
  void take_event(const Message& message, hal::TimeNs at, const EventSink& sink);
  void get(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) const;
  void set(const Message& message, hal::TimeNs at, const EventSink& sink);
  bool debug(const Message& message, std::vector<Message>& out);
  void load(const Message& message);
  bool handles(std::uint16_t event) const;
  Message say(std::uint16_t type) const { return {id_, type, {}}; }

  std::uint8_t id_;
  std::string name_;
  std::vector<Variable> variables_;
  Protocol protocol_;
  Lie lie_ = Lie::None;
  std::vector<std::int16_t> memory_;
  std::vector<std::uint16_t> bytecode_, flash_;
  std::set<std::uint16_t> breakpoints_;
  std::uint16_t flags_ = 0;  // 2: steps one by one
  std::uint16_t written_from_ = 0, written_until_ = 0;
};

}  // namespace tandem::bridges::footbot_emulator
