// Walks over every value that later steps depend on: for the fingerprint, for dumps, and to find differences.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/space/stores.hpp"
#include "hal/port.hpp"
#include "hal/time.hpp"

namespace tandem::core {

/// The state of a world: its stores, and what its chance is drawn from.
struct StateView {
  const SpaceStores& stores;
  std::uint64_t seed;
  hal::Tick tick;
};

/// Whose value it is. Robots, objects, joints, lights and sounds have numbers: robots the index of their id.
enum class ValueOwner : std::uint8_t { World, Robot, Object, Joint, Light, Sound };

/// Owner of a value: `name` is that of a port (of a sensor or an actuator), of a controller that publishes it, or
/// of anything else that has fields.
enum class ValueSet : std::uint8_t { Own, Sensor, Actuator, Published };

/// Up to kBlockRows owners of one kind, by number; of a row with kNobody nothing counts.
struct ValueOwners {
  static constexpr std::uint32_t kNobody = 0xFFFF'FFFFU;

  ValueOwner kind = ValueOwner::World;
  std::span<const std::uint32_t> numbers;
};

/// One field of rows, one for each of the owners.
struct FieldRows {
  ValueSet set = ValueSet::Own;
  std::string_view name;
  std::string_view field;
  hal::Scalar scalar = hal::Scalar::F64;
  std::size_t count = 1;                ///< values a row
  const std::byte* first = nullptr;     ///< the first row's values
  std::size_t stride = 0;               ///< bytes from row to row
  const std::byte* initial = nullptr;   ///< the values of a row to which nothing has happened; null: zeros
  const std::uint32_t* used = nullptr;  ///< by row: how many of `count` mean something; null: all
};

/// Neither the order of rows nor that of calls means anything. Values as they would be if nothing had happened count as
/// absent: who keeps a state that somebody else has no use for is not told from who keeps none.
class StateVisitor {
 public:
  virtual void begin(const ValueOwners& owners) = 0;  ///< of the rows that follow
  virtual void visit(const FieldRows& rows) = 0;

 protected:
  ~StateVisitor() = default;
};

void visit_state(const StateView& state, StateVisitor& visitor);

/// One value that is not as if nothing had happened, in words.
struct StateValue {
  std::string who;    ///< "robot ep3", "object 4"
  std::string what;   ///< "body", "sensor proximity"
  std::string field;  ///< "x", "distance[3]"
  std::string value;  ///< the shortest text that reads back as the same bits
};

/// All of them: those of the world, then by robot, object, joint, light and sound.
std::vector<StateValue> state_values(const StateView& state);

/// Values in which two states differ, in the order of `a`; a value that is absent is empty.
struct StateDifference {
  std::string who, what, field;
  std::string a, b;
};
std::vector<StateDifference> differences(const std::vector<StateValue>& a, const std::vector<StateValue>& b);

}  // namespace tandem::core
