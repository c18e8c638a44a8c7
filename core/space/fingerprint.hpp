// A fingerprint of a world's state: 64 bits that differ when any value does.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/space/state_values.hpp"

namespace tandem::core {

/// A sum over all values of `visit_state`. What a value adds depends on the names of its set and field, its index in
/// the field, the number of its owner, and its bits; it is 0 for a value that is as if nothing had happened. The order
/// in which values are stored has no influence. Two states that differ in one value alone have different fingerprints;
/// those that differ in several do but for one chance in 2^64.
std::uint64_t fingerprint(const StateView& state) noexcept;

/// The fingerprint and its parts, 8 bits each: where two states differ in one value, the fingerprints do, and but for
/// one chance in 256 also the parts of its field and of its robot.
struct StateChecks {
  std::uint64_t fingerprint = 0;
  std::vector<std::uint8_t> fields;  ///< those that robots and other things have, in the order of their hashes
  std::vector<std::uint8_t> robots;  ///< by number
};
StateChecks checks_of(const StateView& state);
/// Names of its fields, in their order: "sensor proximity: distance", "body: x"; those of other things than robots
/// begin with what they are.
std::vector<std::string> field_names(const StateView& state);

}  // namespace tandem::core
