// Conditions that pause a run: a value of a robot passes a limit, or something goes wrong.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/live/field_ref.hpp"
#include "core/sim/world.hpp"
#include "hal/json/json.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// What is waited for. Each is reported once when it begins to hold, and again only after it did not.
class Conditions {
 public:
  static constexpr std::size_t kMost = 20;

  /// Adds one: {"robot": id or "*", "role", "port", "field", "index", "op": "<" | ">" | "==" | "!=", "value": a number
  /// or one of an enumeration's names}, or {"incident": true}. Errors: missing members; no robot has such a value.
  hal::Status add(const hal::Json& json, const World& world);
  void clear() noexcept { all_.clear(); }
  bool empty() const noexcept { return all_.empty(); }

  /// After a tick: what has begun to hold, in words; empty: nothing has.
  std::string check(const World& world);
  /// After the run was put elsewhere: incidents from before do not count.
  void forget(const World& world) noexcept;

 private:
  enum class Op : std::uint8_t { Below, Above, Equal, Unequal };
  struct Condition {
    bool incident = false;
    std::string robot;  // "*": any
    FieldRef field;
    Op op = Op::Equal;
    double value = 0.0;
    std::string words;
    bool held = false;
  };
  /// The first robot for which it holds, with its value; empty: none.
  static std::string who(const Condition& condition, const World& world);
  static bool holds(const Condition& condition, std::optional<double> value) noexcept;
  static std::uint64_t incidents_of(const World& world) noexcept;

  std::vector<Condition> all_;
  std::uint64_t incidents_ = 0;
};

}  // namespace tandem::core
