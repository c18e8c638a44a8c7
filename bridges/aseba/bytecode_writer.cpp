#include "bridges/aseba/bytecode_writer.hpp"

#include "hal/check.hpp"

namespace tandem::bridges::aseba {
namespace {

constexpr unsigned kStop = 0x0, kSmall = 0x1, kLarge = 0x2, kLoad = 0x3, kStore = 0x4, kBinary = 0x8, kJump = 0x9,
                   kBranch = 0xA, kCall = 0xC;
constexpr unsigned kLow = 0xFFF;  // what fits beside an operation

}  // namespace

void BytecodeWriter::begin(std::uint16_t event) {
  TANDEM_CHECK(open_.empty(), "a condition ends in its handler");
  if (!handlers_.empty()) emit(kStop, 0);
  handlers_.push_back({event, code_.size()});
}

BytecodeWriter& BytecodeWriter::push(std::int16_t value) {
  if (value >= -2048 && value < 2048) {
    emit(kSmall, static_cast<unsigned>(value) & kLow);
  } else {
    emit(kLarge, 0);
    code_.push_back(static_cast<std::uint16_t>(value));
  }
  return *this;
}

BytecodeWriter& BytecodeWriter::load(std::uint16_t address) {
  TANDEM_CHECK(address <= kLow, "a node's memory is smaller");
  emit(kLoad, address);
  return *this;
}

BytecodeWriter& BytecodeWriter::store(std::uint16_t address) {
  TANDEM_CHECK(address <= kLow, "a node's memory is smaller");
  emit(kStore, address);
  return *this;
}

BytecodeWriter& BytecodeWriter::apply(Op op) {
  emit(kBinary, static_cast<unsigned>(op));
  return *this;
}

BytecodeWriter& BytecodeWriter::call(std::uint16_t function, const std::vector<std::uint16_t>& addresses) {
  TANDEM_CHECK(function <= kLow, "a node has fewer functions");
  for (auto a = addresses.rbegin(); a != addresses.rend(); ++a) push(static_cast<std::int16_t>(*a));
  emit(kCall, function);
  return *this;
}

BytecodeWriter& BytecodeWriter::begin_if(Op op) {
  open_.push_back(code_.size());
  emit(kBranch, static_cast<unsigned>(op));
  code_.push_back(0);  // how far to go when it is false
  return *this;
}

BytecodeWriter& BytecodeWriter::otherwise() {
  TANDEM_CHECK(!open_.empty(), "there is a condition");
  const std::size_t branch = open_.back();
  open_.back() = code_.size();
  emit(kJump, 0);
  code_[branch + 1] = static_cast<std::uint16_t>(code_.size() - branch);
  return *this;
}

BytecodeWriter& BytecodeWriter::end_if() {
  TANDEM_CHECK(!open_.empty(), "there is a condition");
  const std::size_t from = open_.back();
  open_.pop_back();
  const std::size_t distance = code_.size() - from;
  if (code_[from] >> 12U == kJump) {
    code_[from] = static_cast<std::uint16_t>(kJump << 12U | distance);
  } else {
    code_[from + 1] = static_cast<std::uint16_t>(distance);
  }
  return *this;
}

std::vector<std::uint16_t> BytecodeWriter::finish() {
  TANDEM_CHECK(open_.empty(), "a condition ends in its handler");
  emit(kStop, 0);
  const std::size_t table = 1 + 2 * handlers_.size();
  std::vector<std::uint16_t> words = {static_cast<std::uint16_t>(table)};
  for (const Handler& h : handlers_) {
    words.push_back(h.event);
    words.push_back(static_cast<std::uint16_t>(table + h.begin));
  }
  words.insert(words.end(), code_.begin(), code_.end());
  return words;
}

}  // namespace tandem::bridges::aseba
