// A fingerprint of a world's state: 64 bits that differ when any value does.
#pragma once
#include <cstdint>

#include "core/space/state_values.hpp"

namespace tandem::core {

/// A sum over all values of `visit_state`. What a value adds depends on the names of its set and field, its index in
/// the field, the number of its owner, and its bits; it is 0 for a value that is as if nothing had happened. The order
/// in which values are stored has no influence. Two states that differ in one value alone have different fingerprints;
/// those that differ in several do but for one chance in 2^64.
std::uint64_t fingerprint(const StateView& state) noexcept;

}  // namespace tandem::core
