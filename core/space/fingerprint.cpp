#include "core/space/fingerprint.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string_view>

namespace tandem::core {
namespace {

/// Every bit of the value reaches every bit of the result [finaliser of Murmur3].
std::uint64_t scattered(std::uint64_t x) noexcept {
  x = (x ^ (x >> 33)) * 0xFF51AFD7ED558CCDULL;
  x = (x ^ (x >> 33)) * 0xC4CEB9FE1A85EC53ULL;
  return x ^ (x >> 33);
}

std::uint64_t hash_of(std::string_view text, std::uint64_t hash) noexcept {
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;  // FNV-1a
  return (hash ^ 0x100U) * 1099511628211ULL;
}

std::uint64_t field_key(ValueOwner kind, const FieldRows& rows) noexcept {
  return hash_of(rows.field,
                 hash_of(rows.name, static_cast<std::uint64_t>(kind) * 16 + static_cast<std::uint64_t>(rows.set)));
}

std::uint64_t word_of(const std::byte* at, std::size_t bytes) noexcept {
  std::uint64_t word = 0;
  std::memcpy(&word, at, bytes);
  return word;
}

/// kParts: with sums by field and by robot.
template <bool kParts>
class Sum final : public StateVisitor {
 public:
  std::uint64_t value() const noexcept { return sum_; }
  const std::map<std::uint64_t, std::uint64_t>& fields() const noexcept { return fields_; }
  std::vector<std::uint64_t> robots;

  void begin(const ValueOwners& owners) override {
    numbers_ = owners.numbers;
    kind_ = owners.kind;
    rows_ = owners.numbers.size();
    for (std::size_t i = 0; i < rows_; ++i) {
      const std::uint32_t number = owners.numbers[i];
      owner_keys_[i] = number == ValueOwners::kNobody ? 0 : scattered(number + std::uint64_t{1}) | 1U;
    }
  }

  /// Values are taken eight bytes at a time.
  void visit(const FieldRows& rows) override {
    const std::uint64_t key = field_key(kind_, rows);
    const std::uint64_t before = sum_;
    const std::size_t size = hal::size_of(rows.scalar);
    const std::size_t most = rows.used == nullptr ? rows.count : *std::max_element(rows.used, rows.used + rows_);
    for (std::size_t at = 0, k = 0; at < most * size; at += sizeof(std::uint64_t), ++k) {
      const std::uint64_t word_key = scattered(key + k) | 1U;
      const std::size_t bytes = std::min(sizeof(std::uint64_t), most * size - at);
      if (rows.used != nullptr) {
        add_used(rows, at, bytes, size, word_key);
      } else if (bytes == 8) {
        add_all<8>(rows, at, word_key);
      } else if (bytes == 4) {
        add_all<4>(rows, at, word_key);
      } else if (bytes == 2) {
        add_all<2>(rows, at, word_key);
      } else if (bytes == 1) {
        add_all<1>(rows, at, word_key);
      } else {
        add_some(rows, at, bytes, word_key);
      }
    }
    if constexpr (kParts) fields_[key] += sum_ - before;
  }

 private:
  void add(std::uint64_t part, std::size_t row) noexcept {
    sum_ += part;
    if constexpr (kParts) {
      if (kind_ == ValueOwner::Robot && numbers_[row] < robots.size()) robots[numbers_[row]] += part;
    }
  }

  /// 0 for 0; for any two keys that are odd different values give different results.
  static std::uint64_t mixed(std::uint64_t value, std::uint64_t word_key, std::uint64_t owner_key) noexcept {
    std::uint64_t x = (value ^ (value >> 32)) * word_key;
    x = (x ^ (x >> 29)) * owner_key;
    return x ^ (x >> 32);
  }

  template <std::size_t kBytes>
  void add_all(const FieldRows& rows, std::size_t at, std::uint64_t word_key) noexcept {
    const std::uint64_t initial = rows.initial == nullptr ? 0 : word_of(rows.initial + at, kBytes);
    const std::byte* row = rows.first + at;
    if constexpr (kParts) {
      for (std::size_t i = 0; i < rows_; ++i, row += rows.stride)
        add(mixed(word_of(row, kBytes) ^ initial, word_key, owner_keys_[i]), i);
    } else {
      std::uint64_t sum = 0;
      for (std::size_t i = 0; i < rows_; ++i, row += rows.stride)
        sum += mixed(word_of(row, kBytes) ^ initial, word_key, owner_keys_[i]);
      sum_ += sum;
    }
  }

  void add_some(const FieldRows& rows, std::size_t at, std::size_t bytes, std::uint64_t word_key) noexcept {
    const std::uint64_t initial = rows.initial == nullptr ? 0 : word_of(rows.initial + at, bytes);
    for (std::size_t i = 0; i < rows_; ++i)
      add(mixed(word_of(rows.first + i * rows.stride + at, bytes) ^ initial, word_key, owner_keys_[i]), i);
  }

  void add_used(const FieldRows& rows, std::size_t at, std::size_t bytes, std::size_t size,
                std::uint64_t word_key) noexcept {
    for (std::size_t i = 0; i < rows_; ++i) {
      const std::size_t in_use = rows.used[i] * size;
      if (in_use <= at) continue;
      const std::size_t n = std::min(bytes, in_use - at);
      const std::uint64_t initial = rows.initial == nullptr ? 0 : word_of(rows.initial + at, n);
      add(mixed(word_of(rows.first + i * rows.stride + at, n) ^ initial, word_key, owner_keys_[i]), i);
    }
  }

  std::uint64_t sum_ = 0;
  ValueOwner kind_ = ValueOwner::World;
  std::size_t rows_ = 0;
  std::array<std::uint64_t, kBlockRows> owner_keys_{};
  std::span<const std::uint32_t> numbers_;
  std::map<std::uint64_t, std::uint64_t> fields_;  // of kParts: by key
};

/// Names of fields by their keys.
class FieldNames final : public StateVisitor {
 public:
  void begin(const ValueOwners& owners) override { kind_ = owners.kind; }
  void visit(const FieldRows& rows) override {
    std::string& name = names[field_key(kind_, rows)];
    if (!name.empty()) return;
    static constexpr std::array<std::string_view, 6> kKinds = {"", "", "object ", "joint ", "light ", "sound "};
    name = kKinds[static_cast<std::size_t>(kind_)];
    if (rows.set == ValueSet::Sensor) name += "sensor ";
    if (rows.set == ValueSet::Actuator) name += "actuator ";
    if (rows.set == ValueSet::Published) name += "state ";
    name += std::string(rows.name) + ": " + std::string(rows.field);
  }
  std::map<std::uint64_t, std::string> names;

 private:
  ValueOwner kind_ = ValueOwner::World;
};

std::uint8_t part_of(std::uint64_t sum) noexcept {
  return static_cast<std::uint8_t>(scattered(sum));
}

}  // namespace

std::uint64_t fingerprint(const StateView& state) noexcept {
  Sum<false> sum;
  visit_state(state, sum);
  return sum.value();
}

StateChecks checks_of(const StateView& state) {
  Sum<true> sum;
  sum.robots.resize(state.stores.robots.size(), 0);
  visit_state(state, sum);
  StateChecks checks;
  checks.fingerprint = sum.value();
  for (const auto& [key, part] : sum.fields()) checks.fields.push_back(part_of(part));
  for (const std::uint64_t part : sum.robots) checks.robots.push_back(part_of(part));
  return checks;
}

std::vector<std::string> field_names(const StateView& state) {
  FieldNames all;
  visit_state(state, all);
  std::vector<std::string> names;
  for (auto& [key, name] : all.names) names.push_back(std::move(name));
  return names;
}

}  // namespace tandem::core
