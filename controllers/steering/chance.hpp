// Random numbers for behaviours.
#pragma once
#include <cstdint>

namespace tandem::controllers {

/// A sequence that its seed determines (take `Robot::seed()`): SplitMix64 [Steele et al. 2014, "Fast splittable
/// pseudorandom number generators", OOPSLA]. A value, so that controllers that hold one can be copied.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) noexcept : state_(seed) {}

  /// Uniform in [low, high).
  double between(double low, double high) noexcept {
    return low + (high - low) * static_cast<double>(next() >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t next() noexcept {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace tandem::controllers
