// Words of ASEBA's virtual machine, put together by hand.
//
// A program begins with a table: its length in words, then a pair of event and address for each handler. Instructions
// are one word, the operation in the upper four bits; some are followed by a second. Values lie on a stack.
//
// Sources: aseba-community/aseba, aseba/common/consts.h (numbers), aseba/vm/vm.c (what they do); the words of ASEBA's
// own compiler, which the test compares with.
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace tandem::bridges::aseba {

/// Binary operators that are used here.
enum class Op : std::uint16_t { Add = 2, Subtract = 3, NotEqual = 11, Greater = 12 };

/// Events of the node itself: what happens at its start, and number `i` of those that it describes.
inline constexpr std::uint16_t kInitEvent = 0xFFFF;
constexpr std::uint16_t local_event(std::size_t i) noexcept {
  return static_cast<std::uint16_t>(0xFFFE - i);
}

/// Writes the words of one program, instruction after instruction.
class BytecodeWriter {
 public:
  /// Begins the handler of an event; the one before ends.
  void begin(std::uint16_t event);

  BytecodeWriter& push(std::int16_t value);
  BytecodeWriter& load(std::uint16_t address);   ///< pushes a variable
  BytecodeWriter& store(std::uint16_t address);  ///< pops into a variable
  BytecodeWriter& apply(Op op);                  ///< pops two values, the second on top, and pushes what they give
  /// Calls a native function with variables of one word, which it gets by their addresses.
  BytecodeWriter& call(std::uint16_t function, const std::vector<std::uint16_t>& addresses);

  /// Pops two values; what follows, up to `end_if` or `otherwise`, happens only when `op` says so.
  BytecodeWriter& begin_if(Op op);
  BytecodeWriter& otherwise();
  BytecodeWriter& end_if();

  /// The whole program.
  std::vector<std::uint16_t> finish();

 private:
  struct Handler {
    std::uint16_t event;
    std::size_t begin;  // in `code_`
  };
  void emit(unsigned operation, unsigned low) { code_.push_back(static_cast<std::uint16_t>(operation << 12U | low)); }

  std::vector<Handler> handlers_;
  std::vector<std::uint16_t> code_;
  std::vector<std::size_t> open_;  // branches and jumps whose end is not known yet
};

}  // namespace tandem::bridges::aseba
