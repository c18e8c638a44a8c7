#include "bridges/aseba_emulation/machine.hpp"

namespace tandem::bridges::aseba_emulation {
namespace {

constexpr std::uint16_t kIsWhen = 0x100, kWasTrue = 0x200;

/// The lower 12 bits, with their sign.
std::int16_t small(std::uint16_t word) {
  const int low = word & 0xFFF;
  return static_cast<std::int16_t>(low >= 0x800 ? low - 0x1000 : low);
}

}  // namespace

Machine::End Machine::run(std::uint16_t address) {
  pc_ = address;
  done_ = false;
  stack_.clear();
  for (int i = 0; i < kMostSteps; ++i) {
    if (pc_ >= bytecode_.size()) return refuse("the program goes on behind its end");
    if (End end = step(); end.why != Why::Done || done_) return end;
  }
  return {Why::TooLong, pc_, "the handler does not end"};
}

bool Machine::push(std::int16_t value) {
  if (stack_.size() >= most_) return false;
  stack_.push_back(value);
  return true;
}

std::optional<std::int16_t> Machine::pop() {
  if (stack_.empty()) return std::nullopt;
  const std::int16_t value = stack_.back();
  stack_.pop_back();
  return value;
}

Machine::End Machine::step() {
  const std::uint16_t word = bytecode_[pc_];
  const std::uint16_t low = word & 0xFFFU;
  const auto full = [this] { return refuse("the stack is full"); };
  switch (word >> 12U) {
    case 0x0:
      done_ = true;
      return {};
    case 0x1:
      if (!push(small(word))) return full();
      ++pc_;
      return {};
    case 0x2:
      if (!push(static_cast<std::int16_t>(at(pc_ + 1U)))) return full();
      pc_ = static_cast<std::uint16_t>(pc_ + 2);
      return {};
    case 0x3:
      if (low >= memory_.size()) return refuse("a variable lies outside of the memory");
      if (!push(memory_[low])) return full();
      ++pc_;
      return {};
    case 0x4: {
      const auto value = pop();
      if (!value) return refuse("the stack is empty");
      if (low >= memory_.size()) return refuse("a variable lies outside of the memory");
      memory_[low] = *value;
      ++pc_;
      return {};
    }
    case 0x7: {
      const auto value = pop();
      if (!value || low != 0) return refuse("only negation of one value is known");
      push(static_cast<std::int16_t>(-*value));
      ++pc_;
      return {};
    }
    case 0x8: {
      std::int16_t result = 0;
      if (End end = apply(low & 0xFFU, result); end.why != Why::Done) return end;
      push(result);
      ++pc_;
      return {};
    }
    case 0x9:
      pc_ = static_cast<std::uint16_t>(pc_ + small(word));
      return {};
    case 0xA:
      return branch(word);
    case 0xB:
      return emit(word);
    case 0xC:
      return call(low);
    default:
      return refuse("instruction " + std::to_string(word >> 12U) + " is not emulated");
  }
}

/// Takes two values; the second is on top.
Machine::End Machine::apply(std::uint16_t op, std::int16_t& result) {
  const auto second = pop(), first = pop();
  if (!first || !second) return refuse("the stack is empty");
  const int a = *first, b = *second;
  if ((op == 5 || op == 6) && b == 0) return {Why::DivisionByZero, pc_, "division by zero"};
  const auto give = [&result](int value) {
    result = static_cast<std::int16_t>(static_cast<std::uint16_t>(value));
    return End{};
  };
  const unsigned shift = static_cast<unsigned>(b) & 15U;
  switch (op) {
    case 0:
      return give(static_cast<int>(static_cast<unsigned>(a) << shift));
    case 1:
      return give(a >> shift);
    case 2:
      return give(a + b);
    case 3:
      return give(a - b);
    case 4:
      return give(a * b);
    case 5:
      return give(a / b);
    case 6:
      return give(a % b);
    case 7:
      return give(a | b);
    case 8:
      return give(a ^ b);
    case 9:
      return give(a & b);
    case 10:
      return give(a == b ? 1 : 0);
    case 11:
      return give(a != b ? 1 : 0);
    case 12:
      return give(a > b ? 1 : 0);
    case 13:
      return give(a >= b ? 1 : 0);
    case 14:
      return give(a < b ? 1 : 0);
    case 15:
      return give(a <= b ? 1 : 0);
    case 16:
      return give(a != 0 || b != 0 ? 1 : 0);
    case 17:
      return give(a != 0 && b != 0 ? 1 : 0);
    default:
      return refuse("operator " + std::to_string(op) + " is not emulated");
  }
}

Machine::End Machine::branch(std::uint16_t word) {
  std::int16_t holds = 0;
  if (End end = apply(word & 0xFFU, holds); end.why != Why::Done) return end;
  const bool again = (word & kIsWhen) != 0 && (word & kWasTrue) != 0;
  const auto state = static_cast<std::uint16_t>(holds != 0 ? word | kWasTrue : word & ~kWasTrue);
  bytecode_[pc_] = state;
  const int distance = holds != 0 && !again ? 2 : static_cast<std::int16_t>(at(pc_ + 1U));
  pc_ = static_cast<std::uint16_t>(pc_ + distance);
  return {};
}

Machine::End Machine::emit(std::uint16_t word) {
  const std::size_t start = at(pc_ + 1U), count = at(pc_ + 2U);
  if (start + count > memory_.size()) return refuse("an event's arguments lie outside of the memory");
  const auto words = memory_.subspan(start, count);
  emitted_.push_back({static_cast<std::uint16_t>(word & 0xFFFU), {words.begin(), words.end()}});
  pc_ = static_cast<std::uint16_t>(pc_ + 3);
  return {};
}

/// The addresses of its arguments lie on the stack, the first on top.
Machine::End Machine::call(std::uint16_t function) {
  if (function >= functions_.size()) return refuse("there is no function " + std::to_string(function));
  const NativeFunction& native = functions_[function];
  if (!native.call) return refuse(native.name + " is not emulated");
  std::vector<std::int16_t> values;
  for (std::size_t i = 0; i < native.arguments.size(); ++i) {
    const auto address = pop();
    if (!address || *address < 0 || static_cast<std::size_t>(*address) >= memory_.size())
      return refuse(native.name + " has an argument that is no variable");
    values.push_back(memory_[static_cast<std::size_t>(*address)]);
  }
  native.call(values);
  ++pc_;
  return {};
}

}  // namespace tandem::bridges::aseba_emulation
