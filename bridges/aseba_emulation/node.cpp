#include "bridges/aseba_emulation/node.hpp"

#include <algorithm>

#include "bridges/aseba_emulation/machine.hpp"
#include "hal/check.hpp"

namespace tandem::bridges::aseba_emulation {
namespace {

constexpr std::uint16_t kUserEvents = 0x8000;  // types below
constexpr std::uint16_t kOrders = 0xA000;      // types from here on begin with the module that is meant
constexpr std::uint16_t kStepByStep = 2;

constexpr std::uint16_t kInitEvent = 0xFFFF;
constexpr std::uint16_t kFirstLocalEvent = 0xFFFE;  // the others count down
constexpr std::size_t kSource = 1, kArguments = 2;  // places of variables

}  // namespace

hal::Result<Lie> lie_named(std::string_view text) {
  if (text == "size") return Lie::Size;
  if (text == "count") return Lie::Count;
  if (text == "name") return Lie::Name;
  return hal::Error{"a lie is about size, count or name"};
}

Node::Node(NodeSpec spec) : spec_(std::move(spec)), flash_(spec_.bytecode_words) {
  restart();
}

void Node::restart() {
  memory_.assign(spec_.variable_words, 0);
  memory_[0] = spec_.id;
  bytecode_ = flash_;
  breakpoints_.clear();
  flags_ = 0;
  init_waits_ = false;
  reset_ = true;
  written_from_ = written_until_ = 0;
}

/// The program waits for RUN, and begins with its INIT event.
void Node::reset() {
  flags_ = kStepByStep;
  init_waits_ = true;
  reset_ = true;
  if (!spec_.reset_clears) return;
  memory_.assign(spec_.variable_words, 0);
  memory_[0] = spec_.id;
}

std::uint16_t Node::address_of(std::string_view variable) const {
  std::uint16_t address = 0;
  for (const Variable& v : spec_.variables) {
    if (v.name == variable) return address;
    address = static_cast<std::uint16_t>(address + v.words);
  }
  TANDEM_CHECK(false, "asked for a variable of this module");
}

std::span<std::int16_t> Node::words(std::string_view variable) {
  const auto found = std::ranges::find(spec_.variables, variable, &Variable::name);
  return std::span(memory_).subspan(address_of(variable), found->words);
}

std::span<const std::int16_t> Node::words(std::string_view variable) const {
  const auto found = std::ranges::find(spec_.variables, variable, &Variable::name);
  return std::span(memory_).subspan(address_of(variable), found->words);
}

bool Node::written(std::string_view variable) const {
  const std::uint16_t from = address_of(variable);
  return from < written_until_ && written_from_ < from + words(variable).size();
}

void Node::obey(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) {
  written_from_ = written_until_ = 0;
  if (message.type < kUserEvents) return take_event(message, at, out, sink);
  if (message.type < kOrders) return;  // what other modules say, and the boot loader's own
  if (message.type == type::kGetDescription) {
    // Newer modules are to be asked one by one, by hosts that can.
    if (spec_.protocol == Protocol::V4 || message.word(0) <= 4) describe(at, out, sink);
  } else if (message.type == type::kListNodes) {
    if (spec_.protocol == Protocol::V5)
      out.push_back(say(type::kNodePresent).add(static_cast<std::uint16_t>(spec_.protocol)));
  } else if (message.word(0) == spec_.id) {
    obey_order(message, at, out, sink);
  }
}

void Node::obey_order(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) {
  const auto note = [&](std::string_view what) { sink(at, what, {{"module", spec_.name}}); };
  switch (message.type) {
    case type::kGetVariables:
      return get(message, at, out, sink);
    case type::kSetVariables:
      return set(message, at, sink);
    case type::kGetNodeDescription:
      if (spec_.protocol == Protocol::V5) describe(at, out, sink);
      return;
    case type::kSetBytecode:
      note("program");
      load(message);
      reset();
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
      if (!debug(message, at, out, sink)) {
        sink(at, "ignored", {{"module", spec_.name}, {"type", message.type}, {"why", "there is no such order"}});
      }
  }
}

bool Node::debug(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) {
  const std::uint16_t pc = message.word(1);
  switch (message.type) {
    case type::kReset:
      reset();
      break;
    case type::kPause:
    case type::kStop:
      flags_ = kStepByStep;
      break;
    case type::kRun:
      flags_ = 0;
      tell_state(out);
      if (std::exchange(init_waits_, false)) run_handler(kInitEvent, at, out, sink);
      return true;
    case type::kStep:
    case type::kGetExecutionState:
      break;
    case type::kBreakpointSet: {
      const bool fits = pc < spec_.bytecode_words;
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

void Node::load(const Message& message) {
  for (std::size_t i = 2; i < message.words(); ++i) {
    const std::size_t at = message.word(1) + i - 2;
    if (at < bytecode_.size()) bytecode_[at] = message.word(i);
  }
}

/// A program begins with its length in words and pairs of event and address.
std::uint16_t Node::handler_of(std::uint16_t event) const {
  const std::size_t end = std::min<std::size_t>(bytecode_[0], bytecode_.size());
  for (std::size_t i = 1; i + 1 < end; i += 2) {
    if (bytecode_[i] == event) return bytecode_[i + 1];
  }
  return 0;
}

void Node::happen(std::string_view event, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) {
  const auto found = std::ranges::find(spec_.events, event, &LocalEvent::name);
  TANDEM_CHECK(found != spec_.events.end(), "an event of this node");
  const auto number = static_cast<std::uint16_t>(kFirstLocalEvent - (found - spec_.events.begin()));
  if (handler_of(number) == 0 || flags_ != 0) return;
  words(spec_.variables[kSource].name)[0] = spec_.id;
  run_handler(number, at, out, sink);
}

void Node::run_handler(std::uint16_t event, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) {
  const std::uint16_t address = handler_of(event);
  if (!spec_.runs_programs || address == 0) return;
  Machine machine{bytecode_, memory_, spec_.functions, spec_.stack_words};
  const Machine::End end = machine.run(address);
  for (const Machine::Emitted& emitted : machine.emitted()) {
    Message message = say(emitted.event);
    for (const std::int16_t word : emitted.words) message.add(static_cast<std::uint16_t>(word));
    out.push_back(std::move(message));
  }
  if (end.why == Machine::Why::Done) return;
  flags_ = kStepByStep;
  sink(at, "program_error", {{"module", spec_.name}, {"pc", end.pc}, {"why", end.text}});
  const std::uint16_t type = end.why == Machine::Why::DivisionByZero ? type::kDivisionByZero
                             : end.why == Machine::Why::TooLong      ? type::kExecutionKilled
                                                                     : type::kNodeError;
  Message message = say(type).add(end.pc);
  if (type == type::kNodeError) message.add_text(end.text);
  out.push_back(std::move(message));
}

// Events that no program waits for do not get further than the filter at the module's door.
void Node::take_event(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) {
  if (handler_of(message.type) == 0) return;
  sink(at, "user_event", {{"module", spec_.name}, {"source", message.source}, {"number", message.type}});
  words(spec_.variables[kSource].name)[0] = static_cast<std::int16_t>(message.source);
  const auto args = words(spec_.variables[kArguments].name);
  for (std::size_t i = 0; i < std::min(args.size(), message.words()); ++i) {
    args[i] = static_cast<std::int16_t>(message.word(i));
  }
  if (flags_ == 0) run_handler(message.type, at, out, sink);
}

// The firmware trusts its host: beyond the variables it reads and writes whatever memory follows them. Here that is
// read as it is on a chip that was just switched on, and writes to it are told and lost.
void Node::get(const Message& message, hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) const {
  const std::uint16_t start = message.word(1);
  const std::uint16_t length = message.word(2);
  if (length > kMostGet) {
    sink(at, "ignored", {{"module", spec_.name}, {"type", message.type}, {"why", "more words than fit an answer"}});
    return;
  }
  const bool beyond = start + length > spec_.variable_words;
  sink(at, beyond ? "get_beyond" : "get", {{"module", spec_.name}, {"start", start}, {"words", length}});
  Message answer = say(type::kVariables).add(start);
  for (std::size_t i = start; i < static_cast<std::size_t>(start) + length; ++i) {
    answer.add(i < memory_.size() ? static_cast<std::uint16_t>(memory_[i]) : std::uint16_t{0});
  }
  out.push_back(std::move(answer));
}

void Node::set(const Message& message, hal::TimeNs at, const EventSink& sink) {
  if (message.words() < 2) return;
  const std::uint16_t start = message.word(1);
  std::vector<std::int64_t> values;
  for (std::size_t i = 2; i < message.words(); ++i) values.push_back(static_cast<std::int16_t>(message.word(i)));
  const bool beyond = start + values.size() > memory_.size();
  sink(at, beyond ? "set_beyond" : "set", {{"module", spec_.name}, {"start", start}, {"values", values}});
  for (std::size_t i = 0; i < values.size() && start + i < memory_.size(); ++i) {
    memory_[start + i] = static_cast<std::int16_t>(values[i]);
  }
  written_from_ = start;
  written_until_ = static_cast<std::uint16_t>(std::min<std::size_t>(start + values.size(), memory_.size()));
}

void Node::describe(hal::TimeNs at, std::vector<Message>& out, const EventSink& sink) const {
  sink(at, "describe", {{"module", spec_.name}});
  std::vector<Variable> told = spec_.variables;
  constexpr std::size_t kFirstOfDevice = 3;
  if (lie_ == Lie::Size) ++told[kFirstOfDevice].words;
  if (lie_ == Lie::Name) told[kFirstOfDevice].name += "?";
  const std::size_t count = told.size() + (lie_ == Lie::Count ? 1 : 0);
  out.push_back(say(type::kDescription)
                    .add_text(spec_.name)
                    .add(static_cast<std::uint16_t>(spec_.protocol))
                    .add(spec_.bytecode_words)
                    .add(spec_.stack_words)
                    .add(spec_.variable_words)
                    .add(static_cast<std::uint16_t>(count))
                    .add(static_cast<std::uint16_t>(spec_.events.size()))
                    .add(static_cast<std::uint16_t>(spec_.functions.size())));
  for (const Variable& v : told) out.push_back(say(type::kNamedVariable).add(v.words).add_text(v.name));
  for (const LocalEvent& e : spec_.events) out.push_back(say(type::kLocalEvent).add_text(e.name).add_text(e.doc));
  for (const NativeFunction& f : spec_.functions) {
    Message function =
        say(type::kNativeFunction).add_text(f.name).add_text(f.doc).add(static_cast<std::uint16_t>(f.arguments.size()));
    for (const NativeFunction::Argument& a : f.arguments)
      function.add(static_cast<std::uint16_t>(a.words)).add_text(a.name);
    out.push_back(std::move(function));
  }
}

}  // namespace tandem::bridges::aseba_emulation
