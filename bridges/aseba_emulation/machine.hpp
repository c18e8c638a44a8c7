// ASEBA's virtual machine, as far as programs of hubs need it: values, variables of one word, arithmetic, conditions,
// native functions, events. Arrays by a computed index and subroutines are refused.
//
// Source: the ASEBA project, common/consts.h and vm/vm.c.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bridges/aseba_emulation/node.hpp"

namespace tandem::bridges::aseba_emulation {

/// Runs one handler.
class Machine {
 public:
  enum class Why : std::uint8_t { Done, DivisionByZero, TooLong, Refused };
  struct End {
    Why why = Why::Done;
    std::uint16_t pc = 0;
    std::string text = {};  ///< for people
  };
  struct Emitted {
    std::uint16_t event;
    std::vector<std::int16_t> words;
  };

  /// All must outlive it. Conditions of `when` remember in the bytecode itself whether they held.
  Machine(std::span<std::uint16_t> bytecode, std::span<std::int16_t> memory, std::span<const NativeFunction> functions,
          std::size_t stack_words)
      : bytecode_(bytecode), memory_(memory), functions_(functions), most_(stack_words) {}

  /// From `address` to the handler's end.
  End run(std::uint16_t address);
  const std::vector<Emitted>& emitted() const noexcept { return emitted_; }

 private:
  static constexpr int kMostSteps = 10'000;

  End step();
  End apply(std::uint16_t op, std::int16_t& result);
  End branch(std::uint16_t word);
  End emit(std::uint16_t word);
  End call(std::uint16_t function);
  End refuse(std::string why) const { return {Why::Refused, pc_, std::move(why)}; }
  bool push(std::int16_t value);
  std::optional<std::int16_t> pop();
  std::uint16_t at(std::size_t address) const { return address < bytecode_.size() ? bytecode_[address] : 0; }

  std::span<std::uint16_t> bytecode_;
  std::span<std::int16_t> memory_;
  std::span<const NativeFunction> functions_;
  std::size_t most_;
  std::vector<std::int16_t> stack_;
  std::vector<Emitted> emitted_;
  std::uint16_t pc_ = 0;
  bool done_ = false;
};

}  // namespace tandem::bridges::aseba_emulation
