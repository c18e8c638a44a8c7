#include "bridges/footbot_emulator/module.hpp"

#include <algorithm>

#include "hal/check.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

constexpr std::uint16_t kUserEvents = 0x8000;  // types below
constexpr std::uint16_t kOrders = 0xA000;      // types from here on begin with the module that is meant
constexpr std::uint16_t kStepByStep = 2;

struct Argument {
  std::int16_t words;  // -1: as many as the other one has
  std::string_view name;
};

/// The functions that programs may call; here they are only described.
struct NativeFunction {
  std::string_view name, doc;
  std::array<Argument, 2> arguments;
};

constexpr std::array<NativeFunction, 2> kFunctions = {{
    {"math.copy", "copies src to dest element by element", {{{-1, "dest"}, {-1, "src"}}}},
    {"math.fill", "fills dest with constant", {{{-1, "dest"}, {1, "value"}}}},
}};

}  // namespace

Module::Module(std::uint8_t id, std::string name, std::vector<Variable> device, Protocol protocol)
    : id_(id),
      name_(std::move(name)),
      variables_{{"id", 1}, {"source", 1}, {"args", 32}},
      protocol_(protocol),
      flash_(kBytecodeWords) {
  variables_.insert(variables_.end(), device.begin(), device.end());
  restart();
}

void Module::restart() {
  memory_.assign(kVariableWords, 0);
  memory_[0] = id_;
  bytecode_ = flash_;
  breakpoints_.clear();
  flags_ = 0;
  written_from_ = written_until_ = 0;
}

std::uint16_t Module::address_of(std::string_view variable) const {
  std::uint16_t address = 0;
  for (const Variable& v : variables_) {
    if (v.name == variable) return address;
    address = static_cast<std::uint16_t>(address + v.words);
  }
  TANDEM_CHECK(false, "asked for a variable of this module");
}

std::span<std::int16_t> Module::words(std::string_view variable) {
  const auto found = std::ranges::find(variables_, variable, &Variable::name);
  return std::span(memory_).subspan(address_of(variable), found->words);
}

std::span<const std::int16_t> Module::words(std::string_view variable) const {
  const auto found = std::ranges::find(variables_, variable, &Variable::name);
  return std::span(memory_).subspan(address_of(variable), found->words);
}

bool Module::written(std::string_view variable) const {
  const std::uint16_t from = address_of(variable);
  return from < written_until_ && written_from_ < from + words(variable).size();
}

void Module::obey(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) {
  written_from_ = written_until_ = 0;
  if (message.type < kUserEvents) return take_event(message, at, sink);
  if (message.type < kOrders) return;  // what other modules say, and the boot loader's own
  if (message.type == type::kGetDescription) {
    // Newer modules are to be asked one by one, by hosts that can.
    if (protocol_ == Protocol::V4 || message.word(0) <= 4) describe(at, out, sink);
  } else if (message.type == type::kListNodes) {
    if (protocol_ == Protocol::V5) out.push_back(say(type::kNodePresent).add(static_cast<std::uint16_t>(protocol_)));
  } else if (message.word(0) == id_) {
    obey_order(message, at, out, sink);
  }
}

void Module::obey_order(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) {
  const auto note = [&](std::string_view what) { sink(at, what, {{"module", name_}}); };
  switch (message.type) {
    case type::kGetVariables:
      return get(message, at, out, sink);
    case type::kSetVariables:
      return set(message, at, sink);
    case type::kGetNodeDescription:
      if (protocol_ == Protocol::V5) describe(at, out, sink);
      return;
    case type::kSetBytecode:
      note("program");
      load(message);
      flags_ = kStepByStep;
      return tell_state(out);
    case type::kWriteBytecode:
      note("program_kept");
      flash_ = bytecode_;
      return;
    case type::kReboot:
      return note("reboot");
    case type::kSuspend:
      return note("suspend");
    default:
      if (!debug(message, out)) {
        sink(at, "ignored", {{"module", name_}, {"type", message.type}, {"why", "there is no such order"}});
      }
  }
}

/// Without a program nothing ever runs, but the machine's state is kept and told.
bool Module::debug(const Message& message, std::vector<Message>& out) {
  const std::uint16_t pc = message.word(1);
  switch (message.type) {
    case type::kReset:
    case type::kPause:
    case type::kStop:
      flags_ = kStepByStep;
      break;
    case type::kRun:
      flags_ = 0;
      break;
    case type::kStep:
    case type::kGetExecutionState:
      break;
    case type::kBreakpointSet: {
      const bool fits = pc < kBytecodeWords;
      if (fits) breakpoints_.insert(pc);
      out.push_back(say(type::kBreakpointSetResult).add(pc).add(fits ? 1 : 0));
      return true;
    }
    case type::kBreakpointClear:
      breakpoints_.erase(pc);
      return true;
    case type::kBreakpointClearAll:
      breakpoints_.clear();
      return true;
    default:
      return false;
  }
  tell_state(out);
  return true;
}

void Module::tell_state(std::vector<Message>& out) const {
  out.push_back(say(type::kExecutionState).add(0).add(flags_));
}

void Module::load(const Message& message) {
  for (std::size_t i = 2; i < message.words(); ++i) {
    const std::size_t at = message.word(1) + i - 2;
    if (at < bytecode_.size()) bytecode_[at] = message.word(i);
  }
}

/// A program begins with its length in words and pairs of event and address.
bool Module::handles(std::uint16_t event) const {
  const std::size_t end = std::min<std::size_t>(bytecode_[0], bytecode_.size());
  for (std::size_t i = 1; i < end; i += 2) {
    if (bytecode_[i] == event) return true;
  }
  return false;
}

// Events that no program waits for do not get further than the filter at the module's door.
void Module::take_event(const Message& message, hal::TimeNs at, const EventSink& sink) {
  if (!handles(message.type)) return;
  sink(at, "user_event", {{"module", name_}, {"source", message.source}, {"number", message.type}});
  memory_[address_of("source")] = static_cast<std::int16_t>(message.source);
  const auto args = words("args");
  for (std::size_t i = 0; i < std::min(args.size(), message.words()); ++i) {
    args[i] = static_cast<std::int16_t>(message.word(i));
  }
}

// The firmware trusts its host: beyond the variables it reads and writes whatever memory follows them. Here that is
// read as it is on a chip that was just switched on, and writes to it are told and lost.
void Module::get(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) const {
  const std::uint16_t start = message.word(1);
  const std::uint16_t length = message.word(2);
  if (length > kMostGet) {
    sink(at, "ignored", {{"module", name_}, {"type", message.type}, {"why", "more words than fit an answer"}});
    return;
  }
  const bool beyond = start + length > kVariableWords;
  sink(at, beyond ? "get_beyond" : "get", {{"module", name_}, {"start", start}, {"words", length}});
  Message answer = say(type::kVariables).add(start);
  for (std::size_t i = start; i < static_cast<std::size_t>(start) + length; ++i) {
    answer.add(i < memory_.size() ? static_cast<std::uint16_t>(memory_[i]) : std::uint16_t{0});
  }
  out.push_back(std::move(answer));
}

void Module::set(const Message& message, hal::TimeNs at, const EventSink& sink) {
  if (message.words() < 2) return;
  const std::uint16_t start = message.word(1);
  std::vector<std::int64_t> values;
  for (std::size_t i = 2; i < message.words(); ++i) values.push_back(static_cast<std::int16_t>(message.word(i)));
  const bool beyond = start + values.size() > memory_.size();
  sink(at, beyond ? "set_beyond" : "set", {{"module", name_}, {"start", start}, {"values", values}});
  for (std::size_t i = 0; i < values.size() && start + i < memory_.size(); ++i) {
    memory_[start + i] = static_cast<std::int16_t>(values[i]);
  }
  written_from_ = start;
  written_until_ = static_cast<std::uint16_t>(std::min<std::size_t>(start + values.size(), memory_.size()));
}

void Module::describe(hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) const {
  sink(at, "describe", {{"module", name_}});
  std::vector<Variable> told = variables_;
  constexpr std::size_t kFirstOfDevice = 3;
  if (lie_ == Lie::Size) ++told[kFirstOfDevice].words;
  if (lie_ == Lie::Name) told[kFirstOfDevice].name += "?";
  const std::size_t count = told.size() + (lie_ == Lie::Count ? 1 : 0);
  out.push_back(say(type::kDescription)
                    .add_text(name_)
                    .add(static_cast<std::uint16_t>(protocol_))
                    .add(kBytecodeWords)
                    .add(kStackWords)
                    .add(kVariableWords)
                    .add(static_cast<std::uint16_t>(count))
                    .add(1)
                    .add(kFunctions.size()));
  for (const Variable& v : told) out.push_back(say(type::kNamedVariable).add(v.words).add_text(v.name));
  out.push_back(say(type::kLocalEvent).add_text("timer").add_text("periodic timer"));
  for (const NativeFunction& f : kFunctions) {
    Message function =
        say(type::kNativeFunction).add_text(f.name).add_text(f.doc).add(static_cast<std::uint16_t>(f.arguments.size()));
    for (const Argument& a : f.arguments) function.add(static_cast<std::uint16_t>(a.words)).add_text(a.name);
    out.push_back(std::move(function));
  }
}

}  // namespace tandem::bridges::footbot_emulator
