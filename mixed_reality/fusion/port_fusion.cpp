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
  std::size_t largest = 1;
  for (const hal::PortType* type : space.ports(robot)) {
    if (type->role != hal::Role::Sensor) continue;
    TANDEM_CHECK(type->align <= alignof(std::max_align_t), "ports have no alignment beyond the fundamental ones");
    const void* device = real(*type);
    pairs_.push_back({type, space.port(robot, *type), device, device != nullptr && comes_by_itself(*type)});
    largest = std::max(largest, type->size);
  }
  scratch_ = std::make_unique<std::max_align_t[]>((largest + sizeof(std::max_align_t) - 1) / sizeof(std::max_align_t));
}

void PortFusion::fuse() noexcept {
  for (const Pair& pair : pairs_) {
    void* fused = scratch_.get();
    pair.type->reset(fused);
    if (pair.real != nullptr) std::memcpy(fused, pair.real, pair.type->size);
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
