// The counter-based random function that all chance of a run is made of.
#pragma once
#include <Random123/philox.h>
#include <array>
#include <cstdint>

namespace tandem::hal {

/// Philox4x32-10 [Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3"]: four independent 32-bit numbers,
/// a function of counter and key alone, the same on every machine.
inline std::array<std::uint32_t, 4> philox(const std::array<std::uint32_t, 4>& counter, std::uint64_t key) noexcept {
  const r123::Philox4x32::ctr_type at = {{counter[0], counter[1], counter[2], counter[3]}};
  const r123::Philox4x32::key_type of = {{static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)}};
  const auto out = r123::Philox4x32{}(at, of);
  return {out[0], out[1], out[2], out[3]};
}

}  // namespace tandem::hal
