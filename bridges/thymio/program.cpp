#include "bridges/thymio/program.hpp"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

#include "bridges/thymio/assembler.hpp"

namespace tandem::bridges::thymio {
namespace {

using aseba::NodeDescription;

constexpr std::string_view kTones = "sound.freq";

hal::Result<std::uint16_t> address_of(const NodeDescription& node, std::string_view name, std::uint16_t words) {
  const aseba::Variable* const variable = node.variable(name);
  const std::string which = "its variable '" + std::string(name) + "'";
  if (variable == nullptr) return hal::Error{which + " is missing: is it a Thymio II, with its firmware up to date?"};
  if (variable->words == words) return variable->address;
  return hal::Error{which + " has " + std::to_string(variable->words) + " words, not " + std::to_string(words)};
}

std::optional<std::uint16_t> number_of(const std::vector<std::string>& names, std::string_view name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::uint16_t>(found - names.begin());
}

/// `count` addresses from `first` on.
std::vector<std::uint16_t> row(std::uint16_t first, std::uint16_t count) {
  std::vector<std::uint16_t> all(count);
  for (std::uint16_t i = 0; i < count; ++i) all[i] = static_cast<std::uint16_t>(first + i);
  return all;
}

class Writer {
 public:
  Writer(const NodeDescription& node, Program& program) : node_(node), program_(program) {}

  std::vector<std::uint16_t> write(std::uint16_t timer_event, std::uint16_t timer_period) {
    code_.begin(kInitEvent);
    code_.push(static_cast<std::int16_t>(kBeat_ns / hal::kNsPerMs)).store(timer_period);
    code_.push(-1).store(at(mailbox::kSilence));
    code_.begin(local_event(timer_event));
    code_.load(at(mailbox::kBeat)).push(1).apply(Op::Add).store(at(mailbox::kBeat));
    code_.push(program_.signature).store(at(mailbox::kSignature));
    drive();
    lights();
    sounds();
    return code_.finish();
  }

 private:
  std::uint16_t at(std::uint16_t word) const { return static_cast<std::uint16_t>(program_.mailbox + word); }

  void drive() {
    code_.load(at(mailbox::kAlive)).push(0).begin_if(Op::Greater);
    code_.load(at(mailbox::kLeft)).store(program_.motors.left_target);
    code_.load(at(mailbox::kRight)).store(program_.motors.right_target);
    code_.load(at(mailbox::kAlive)).push(1).apply(Op::Subtract).store(at(mailbox::kAlive));
    code_.push(1).load(at(mailbox::kAlive)).begin_if(Op::Greater);
    code_.load(at(mailbox::kLapses)).push(1).apply(Op::Add).store(at(mailbox::kLapses));
    if (const auto function = number_of(node_.native_functions, kTones))
      code_.call(*function, {at(mailbox::kTone_Hz), at(mailbox::kSilence)});
    code_.end_if();
    code_.otherwise();
    code_.push(0).store(program_.motors.left_target);
    code_.push(0).store(program_.motors.right_target);
    code_.end_if();
  }

  void lights() {
    code_.load(at(mailbox::kLeds)).load(at(mailbox::kShown)).begin_if(Op::NotEqual);
    code_.load(at(mailbox::kLeds)).store(at(mailbox::kShown));
    std::uint16_t word = at(mailbox::kFirstLed);
    struct Group {
      std::string_view function;
      std::uint16_t words;
    };
    for (const Group& group : std::initializer_list<Group>{
             {"leds.circle", 8}, {"leds.bottom.left", 3}, {"leds.bottom.right", 3}, {"leds.top", 3}}) {
      if (const auto function = number_of(node_.native_functions, group.function)) {
        code_.call(*function, row(word, group.words));
        program_.lights = true;
      }
      word = static_cast<std::uint16_t>(word + group.words);
    }
    code_.end_if();
  }

  void sounds() {
    const auto function = number_of(node_.native_functions, kTones);
    program_.sounds = function.has_value();
    if (!function) return;
    code_.load(at(mailbox::kTone)).load(at(mailbox::kPlayed)).begin_if(Op::NotEqual);
    code_.load(at(mailbox::kTone)).store(at(mailbox::kPlayed));
    code_.call(*function, {at(mailbox::kTone_Hz), at(mailbox::kToneLength)});
    code_.end_if();
  }

  const NodeDescription& node_;
  Program& program_;
  Assembler code_;
};

/// 15 bits of FNV-1a [Fowler, Noll, Vo], never 0.
std::int16_t signature_of(const std::vector<std::uint16_t>& words) {
  std::uint32_t hash = 2166136261U;
  for (const std::uint16_t word : words) hash = (hash ^ word) * 16777619U;
  return static_cast<std::int16_t>(((hash ^ hash >> 16U) & 0x3FFFU) | 0x4000U);
}

}  // namespace

hal::Result<Program> make_program(const NodeDescription& node) {
  Program program;
  struct Wanted {
    std::string_view name;
    std::uint16_t& address;
  };
  for (const Wanted& wanted : std::initializer_list<Wanted>{{"motor.left.target", program.motors.left_target},
                                                            {"motor.right.target", program.motors.right_target},
                                                            {"motor.left.speed", program.motors.left_speed},
                                                            {"motor.right.speed", program.motors.right_speed}}) {
    const auto address = address_of(node, wanted.name, 1);
    if (!address.ok()) return address.error();
    wanted.address = address.value();
  }
  const auto period = address_of(node, "timer.period", 2);
  if (!period.ok()) return period.error();
  const auto timer = number_of(node.local_events, "timer0");
  if (!timer) return hal::Error{"its event 'timer0' is missing: is it a Thymio II, with its firmware up to date?"};
  program.mailbox = static_cast<std::uint16_t>(node.named_words());
  if (node.named_words() + mailbox::kWords > node.variable_words) {
    return hal::Error{"it has room for " + std::to_string(node.variable_words - node.named_words()) +
                      " words of a program's variables; " + std::to_string(mailbox::kWords) + " are needed"};
  }
  // The signature is that of the program with another one in the same form.
  program.signature = 0x4000;
  program.words = Writer(node, program).write(*timer, period.value());
  program.signature = signature_of(program.words);
  program.words = Writer(node, program).write(*timer, period.value());
  if (program.words.size() > node.bytecode_words) {
    return hal::Error{"it has room for " + std::to_string(node.bytecode_words) + " words of a program; " +
                      std::to_string(program.words.size()) + " are needed"};
  }
  return program;
}

}  // namespace tandem::bridges::thymio
