// Random numbers for controllers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string_view>
#include <utility>

namespace tandem::hal {

/// The seed of one robot, or of anything else that has a name, in the run with this seed.
std::uint64_t seed_of(std::uint64_t run_seed, std::string_view name) noexcept;

/// A sequence of random numbers that its seed and its stream determine, with the same bits on every machine. Take it
/// from Robot::random(). A value: a copy goes on as the original does, so controllers that hold one can be copied. Also
/// a generator as the standard library's distributions want it; their results differ between libraries, the members'
/// do not.
class Random {
 public:
  using result_type = std::uint64_t;

  /// Streams of one seed are independent of one another.
  explicit Random(std::uint64_t seed, std::uint32_t stream = 0) noexcept : seed_(seed), stream_(stream) {}

  /// In [0, 1), 53 bits.
  double uniform() noexcept { return static_cast<double>((*this)() >> 11) * 0x1p-53; }
  /// In [low, high).
  double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }
  /// In [low, high], both included, all equally likely; `low` when `high` is not above it.
  std::int64_t integer(std::int64_t low, std::int64_t high) noexcept;
  /// True with this probability; never for 0 and less, always for 1 and more.
  bool chance(double probability) noexcept { return uniform() < probability; }
  /// Of the normal distribution [Box and Muller 1958].
  double normal(double mean = 0.0, double deviation = 1.0) noexcept;
  /// Of the exponential distribution: the time to the next event of those that come every `mean` on average.
  double exponential(double mean = 1.0) noexcept;
  /// Puts the values into a random order, all orders equally likely.
  template <class Values>
  void shuffle(Values&& values) noexcept {
    using std::swap;
    for (std::size_t left = std::size(values); left > 1; --left)
      swap(values[left - 1], values[static_cast<std::size_t>(integer(0, static_cast<std::int64_t>(left) - 1))]);
  }

  /// 64 random bits.
  std::uint64_t operator()() noexcept;
  static constexpr std::uint64_t min() noexcept { return 0; }
  static constexpr std::uint64_t max() noexcept { return std::numeric_limits<std::uint64_t>::max(); }

 private:
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;  // numbers of 64 bits so far
  std::uint64_t next_ = 0;   // the second half of the last block, when `drawn_` is odd
  std::uint32_t stream_;
};

}  // namespace tandem::hal
