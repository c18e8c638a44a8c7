#include "hal/random.hpp"

#include <cmath>

#include "hal/elementary.hpp"
#include "hal/philox.hpp"

namespace tandem::hal {

std::uint64_t seed_of(std::uint64_t run_seed, std::string_view name) noexcept {
  std::uint64_t hash = 1469598103934665603ULL;  // FNV-1a
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  constexpr std::uint32_t kSeeds = 0x53454544;  // tells this use of the run's key from others
  const auto bits =
      philox({static_cast<std::uint32_t>(hash), static_cast<std::uint32_t>(hash >> 32), kSeeds, 0}, run_seed);
  return (static_cast<std::uint64_t>(bits[0]) << 32) | bits[1];
}

std::uint64_t Random::operator()() noexcept {
  const std::uint64_t number = drawn_++;
  if (number % 2 != 0) return next_;
  const std::uint64_t block = number / 2;
  const auto bits =
      philox({static_cast<std::uint32_t>(block), static_cast<std::uint32_t>(block >> 32), stream_, 0}, seed_);
  next_ = (static_cast<std::uint64_t>(bits[2]) << 32) | bits[3];
  return (static_cast<std::uint64_t>(bits[0]) << 32) | bits[1];
}

std::int64_t Random::integer(std::int64_t low, std::int64_t high) noexcept {
  if (high <= low) return low;
  const std::uint64_t most = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
  std::uint64_t mask = most;
  for (const int shift : {1, 2, 4, 8, 16, 32}) mask |= mask >> shift;
  std::uint64_t drawn = (*this)() & mask;
  while (drawn > most) drawn = (*this)() & mask;  // at worst every second one is too large
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(low) + drawn);
}

double Random::normal(double mean, double deviation) noexcept {
  constexpr double kTwoPi = 0x1.921fb54442d18p+2;
  const double length = std::sqrt(-2.0 * log(1.0 - uniform()));
  return mean + deviation * length * cos(kTwoPi * uniform());
}

double Random::exponential(double mean) noexcept {
  return -mean * log(1.0 - uniform());
}

}  // namespace tandem::hal
