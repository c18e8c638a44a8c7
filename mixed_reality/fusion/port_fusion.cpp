#include "mixed_reality/fusion/port_fusion.hpp"

#include <algorithm>
#include <cstring>

#include "hal/check.hpp"

namespace tandem::mixed_reality {

namespace {

bool comes_by_itself(const hal::PortType& type) noexcept {
  return std::all_of(type.fields.begin(), type.fields.end(), [](const hal::Field& f) {
    return f.fusion != hal::Fusion::Virtual && f.fusion != hal::Fusion::Union && f.fusion != hal::Fusion::ByAngle;
  });
}

}  // namespace

PortFusion::PortFusion(core::Space& space, core::RobotId robot, const RealReadings& real) {
  constexpr std::size_t kUnit = sizeof(std::max_align_t);
  std::size_t largest = 1, units = 0;
  for (const hal::PortType* type : space.ports(robot)) {
    if (type->role != hal::Role::Sensor) continue;
    TANDEM_CHECK(type->align <= alignof(std::max_align_t), "ports have no alignment beyond the fundamental ones");
    for (const hal::Field& field : type->fields) {
      if (const hal::UsedBy used = hal::used_by(*type, field); used.field != nullptr)
        lists_.push_back({pairs_.size(), &field, used});
    }
    pairs_.push_back({type, space.port(robot, *type), nullptr, false, units});
    units += (type->size + kUnit - 1) / kUnit;
    largest = std::max(largest, type->size);
  }
  readings_ = std::make_unique<std::max_align_t[]>(units);
  scratch_ = std::make_unique<std::max_align_t[]>((largest + kUnit - 1) / kUnit);
  take_from(real);
}

void PortFusion::take_from(const RealReadings& real) {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    Pair& pair = pairs_[i];
    pair.real = real(*pair.type);
    pair.needed = pair.real != nullptr && comes_by_itself(*pair.type);
    pair.type->reset(reading(i));
  }
}

void PortFusion::latch() noexcept {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (pairs_[i].real != nullptr) std::memcpy(reading(i), pairs_[i].real, pairs_[i].type->size);
  }
  for (const List& list : lists_) {
    if (pairs_[list.pair].real == nullptr) continue;
    auto* const row = static_cast<std::byte*>(reading(list.pair));
    const std::size_t size = hal::size_of(list.field->scalar);
    const std::size_t used = std::min(list.field->count, hal::used_count(list.used, row, *list.field));
    const std::size_t tail = list.field->offset + used * size;
    std::memcpy(row + tail, static_cast<const std::byte*>(pairs_[list.pair].type->initial) + tail,
                (list.field->count - used) * size);
  }
}

void PortFusion::fuse() noexcept {
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    void* const fused = scratch_.get();
    std::memcpy(fused, reading(i), pair.type->size);
    hal::fuse(*pair.type, fused, pair.port);
    std::memcpy(pair.port, fused, pair.type->size);
  }
}

const hal::PortType* PortFusion::missing() const noexcept {
  for (const Pair& pair : pairs_) {
    if (pair.needed && static_cast<const hal::Reading*>(pair.real)->validity == hal::Validity::Absent) return pair.type;
  }
  return nullptr;
}

}  // namespace tandem::mixed_reality
