// Names of things in a store: an index, and a generation that tells a new thing from the one that was there before.
#pragma once
#include <cstdint>

namespace tandem::core {

/// Typed id; two kinds of thing never mix. Invalid when default-constructed.
template <class Tag>
struct Id {
  std::uint32_t index = 0xFFFFFFFFU;
  std::uint32_t generation = 0;

  bool valid() const noexcept { return index != 0xFFFFFFFFU; }
  friend bool operator==(const Id&, const Id&) = default;
};

using RobotId = Id<struct RobotTag>;
using ObjectId = Id<struct ObjectTag>;
using JointId = Id<struct JointTag>;

}  // namespace tandem::core
