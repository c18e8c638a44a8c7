#include "bridges/thymio/program.hpp"

#include <initializer_list>
#include <string>
#include <string_view>

#include "bridges/aseba/bytecode_writer.hpp"

namespace tandem::bridges::thymio {
namespace {

using aseba::BytecodeWriter;
using aseba::kInitEvent;
using aseba::local_event;
using aseba::NodeDescription;
using aseba::number_of;
using aseba::Op;

constexpr std::string_view kTones = "sound.freq";

hal::Result<std::uint16_t> address_of(const NodeDescription& node, std::string_view name, std::uint16_t words) {
  const aseba::Variable* const variable = node.variable(name);
  const std::string which = "its variable '" + std::string(name) + "'";
  if (variable == nullptr) return hal::Error{which + " is missing: is it a Thymio II, with its firmware up to date?"};
  if (variable->words == words) return variable->address;
  return hal::Error{which + " has " + std::to_string(variable->words) + " words, not " + std::to_string(words)};
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
    if (const int function = number_of(node_.native_functions, kTones); function >= 0)
      code_.call(static_cast<std::uint16_t>(function), {at(mailbox::kTone_Hz), at(mailbox::kSilence)});
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
      if (const int function = number_of(node_.native_functions, group.function); function >= 0) {
        code_.call(static_cast<std::uint16_t>(function), row(word, group.words));
        program_.lights = true;
      }
      word = static_cast<std::uint16_t>(word + group.words);
    }
    code_.end_if();
  }

  void sounds() {
    const int function = number_of(node_.native_functions, kTones);
    program_.sounds = function >= 0;
    if (!program_.sounds) return;
    code_.load(at(mailbox::kTone)).load(at(mailbox::kPlayed)).begin_if(Op::NotEqual);
    code_.load(at(mailbox::kTone)).store(at(mailbox::kPlayed));
    code_.call(static_cast<std::uint16_t>(function), {at(mailbox::kTone_Hz), at(mailbox::kToneLength)});
    code_.end_if();
  }

  const NodeDescription& node_;
  Program& program_;
  BytecodeWriter code_;
};

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
  const int timer = number_of(node.local_events, "timer0");
  if (timer < 0) return hal::Error{"its event 'timer0' is missing: is it a Thymio II, with its firmware up to date?"};
  program.mailbox = static_cast<std::uint16_t>(node.named_words());
  if (node.named_words() + mailbox::kWords > node.variable_words) {
    return hal::Error{"it has room for " + std::to_string(node.variable_words - node.named_words()) +
                      " words of a program's variables; " + std::to_string(mailbox::kWords) + " are needed"};
  }
  // The signature is that of the program with another one in the same form.
  program.signature = aseba::kSignatureToCome;
  program.words = Writer(node, program).write(static_cast<std::uint16_t>(timer), period.value());
  program.signature = aseba::signature_of(program.words);
  program.words = Writer(node, program).write(static_cast<std::uint16_t>(timer), period.value());
  if (program.words.size() > node.bytecode_words) {
    return hal::Error{"it has room for " + std::to_string(node.bytecode_words) + " words of a program; " +
                      std::to_string(program.words.size()) + " are needed"};
  }
  return program;
}

}  // namespace tandem::bridges::thymio
