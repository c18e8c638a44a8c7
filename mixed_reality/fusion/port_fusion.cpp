#include "mixed_reality/fusion/port_fusion.hpp"

#include <algorithm>
#include <cstring>

#include "hal/check.hpp"

namespace tandem::mixed_reality {

PortFusion::PortFusion(core::Space& space, core::RobotId robot, const RealReadings& real) {
  std::size_t largest = 1;
  for (const hal::PortType* type : space.ports(robot)) {
    if (type->role != hal::Role::Sensor) continue;
    TANDEM_CHECK(type->align <= alignof(std::max_align_t), "ports have no alignment beyond the fundamental ones");
    pairs_.push_back({type, space.port(robot, *type), real(*type)});
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

}  // namespace tandem::mixed_reality
