// Infrared proximity: the nearest body or thing along each ray.
#pragma once
#include "core/device/device.hpp"

namespace tandem::core {

/// All implementations of the proximity sensor.
std::vector<DeviceType> proximity_types();

/// Variants of the kernel's inner loops. Both give the same bits.
enum class VectorCode { Baseline, Avx2 };

/// The best that this processor has; `use_vector_code` overrides it, for tests.
VectorCode vector_code() noexcept;
void use_vector_code(VectorCode code) noexcept;
bool has_avx2() noexcept;

}  // namespace tandem::core
