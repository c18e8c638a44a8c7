#include "bridges/aseba/dead_man.hpp"

#include "bridges/aseba/bytecode_writer.hpp"

namespace tandem::bridges::aseba {
namespace {

std::vector<std::uint16_t> written(const NodeProgram& program, std::uint16_t timer,
                                   const std::vector<RestWord>& motors) {
  const auto at = [&](std::uint16_t word) { return static_cast<std::uint16_t>(program.mailbox + word); };
  const auto alive = at(dead_man_mail::kAlive), beat = at(mail_head::kBeat), lapses = at(mail_head::kLapses);
  BytecodeWriter code;
  code.begin(local_event(timer));
  code.load(beat).push(1).apply(Op::Add).store(beat);
  code.push(program.signature).store(at(mail_head::kSignature));
  code.load(alive).push(0).begin_if(Op::Greater);
  code.load(alive).push(1).apply(Op::Subtract).store(alive);
  code.push(1).load(alive).begin_if(Op::Greater);
  for (const RestWord& motor : motors) code.push(motor.rest).store(motor.address);
  code.load(lapses).push(1).apply(Op::Add).store(lapses);
  code.end_if().end_if();
  return code.finish();
}

hal::Error too_small(const std::string& what, std::size_t has, std::size_t needs) {
  return hal::Error{"it has room for " + std::to_string(has) + " words of a program" + what + "; " +
                    std::to_string(needs) + " are needed"};
}

}  // namespace

hal::Result<NodeProgram> make_dead_man(const NodeDescription& node, const std::string& timer_event,
                                       const std::vector<RestWord>& motors) {
  const int timer = number_of(node.local_events, timer_event);
  if (timer < 0) return hal::Error{"it has no event '" + timer_event + "' of its own"};
  NodeProgram program;
  const std::size_t named = node.named_words();
  if (named + dead_man_mail::kWords > node.variable_words)
    return too_small("'s variables", node.variable_words - named, dead_man_mail::kWords);
  program.mailbox = static_cast<std::uint16_t>(named);
  // The signature is that of the program with another one in the same form.
  program.signature = kSignatureToCome;
  program.words = written(program, static_cast<std::uint16_t>(timer), motors);
  program.signature = signature_of(program.words);
  program.words = written(program, static_cast<std::uint16_t>(timer), motors);
  if (program.words.size() > node.bytecode_words) return too_small("", node.bytecode_words, program.words.size());
  return program;
}

}  // namespace tandem::bridges::aseba
