#include "core/record/input_block.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace tandem::core {
namespace {

constexpr std::size_t kMostRowsBytes = std::size_t{1} << 26;  // of a table: more is no sound block
constexpr std::size_t kNear = 2;  // equal bytes between two differences that are cheaper to repeat than to skip

void put_number(std::string& out, std::size_t number) {
  for (; number >= 0x80; number >>= 7) out.push_back(static_cast<char>(0x80U | (number & 0x7FU)));
  out.push_back(static_cast<char>(number));
}

/// False: there is none, or it is too large.
bool take_number(std::string_view& from, std::size_t& number) noexcept {
  std::uint64_t value = 0;
  for (unsigned shift = 0; shift < 35 && !from.empty(); shift += 7) {
    const auto byte = static_cast<unsigned char>(from.front());
    from.remove_prefix(1);
    value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
    if ((byte & 0x80U) != 0) continue;
    number = static_cast<std::size_t>(value);
    return value <= std::numeric_limits<std::uint32_t>::max();
  }
  return false;
}

char difference(const std::string& rows, const std::string& last, std::size_t i) noexcept {
  return static_cast<char>(rows[i] ^ (i < last.size() ? last[i] : '\0'));
}

void put_differences(const std::string& rows, const std::string& last, std::string& out) {
  std::size_t at = 0;
  for (;;) {
    std::size_t begin = at;
    while (begin < rows.size() && difference(rows, last, begin) == '\0') ++begin;
    if (begin == rows.size()) return;
    std::size_t end = begin + 1;  // behind the last that differs
    for (std::size_t i = end; i < rows.size() && i <= end + kNear; ++i) {
      if (difference(rows, last, i) != '\0') end = i + 1;
    }
    put_number(out, begin - at);
    put_number(out, end - begin);
    for (std::size_t i = begin; i < end; ++i) out.push_back(difference(rows, last, i));
    at = end;
  }
}

bool apply(std::string_view code, std::string& rows) noexcept {
  std::size_t at = 0, same = 0, count = 0;
  while (!code.empty()) {
    if (!take_number(code, same) || !take_number(code, count)) return false;
    if (same > rows.size() - at || count > rows.size() - at - same || count > code.size()) return false;
    at += same;
    for (std::size_t i = 0; i < count; ++i, ++at) rows[at] = static_cast<char>(rows[at] ^ code[i]);
    code.remove_prefix(count);
  }
  return true;
}

}  // namespace

void InputEncoder::encode(const std::vector<InputTable>& tables, std::string& out) {
  const bool key = since_key_ == 0;
  since_key_ = since_key_ + 1 == kKeyEvery ? 0 : since_key_ + 1;
  if (key) last_.clear();
  out.push_back(key ? '\1' : '\0');
  for (const InputTable& table : tables) {
    std::string& last = last_[table.stream];
    if (!key && table.rows == last) continue;
    code_.clear();
    put_differences(table.rows, last, code_);
    put_number(out, table.stream);
    put_number(out, table.members);
    put_number(out, table.rows.size());
    put_number(out, code_.size());
    out += code_;
    last = table.rows;
  }
}

hal::Status InputDecoder::decode(hal::Tick tick, std::string_view payload) {
  const auto bad = [this](const char* what) {
    known_ = false;
    return hal::Error{what};
  };
  if (payload.empty()) return bad("inputs without a beginning");
  const bool key = payload.front() != '\0';
  payload.remove_prefix(1);
  if (!key && !known_) return {};
  if (!key && tick != tick_ + 1)
    return bad("inputs that build on those of the tick before, which are missing or damaged");
  if (key) tables_.clear();
  known_ = true;
  tick_ = tick;
  while (!payload.empty()) {
    std::size_t stream = 0, members = 0, bytes = 0, coded = 0;
    if (!take_number(payload, stream) || !take_number(payload, members) || !take_number(payload, bytes) ||
        !take_number(payload, coded) || coded > payload.size() || bytes > kMostRowsBytes)
      return bad("inputs that make no sense");
    Table& table = tables_[static_cast<std::uint32_t>(stream)];
    std::string rows = table.rows != nullptr ? *table.rows : std::string();
    rows.resize(bytes, '\0');
    if (!apply(payload.substr(0, coded), rows)) return bad("inputs that make no sense");
    payload.remove_prefix(coded);
    table = {static_cast<std::uint32_t>(stream), static_cast<std::uint32_t>(members),
             std::make_shared<const std::string>(std::move(rows))};
  }
  return {};
}

}  // namespace tandem::core
