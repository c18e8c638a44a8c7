// Durations counted by size, without allocating: for the quantiles of a run of any length.
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "hal/time.hpp"

namespace tandem::hal {

/// Counts durations in buckets of at most 1/16 of their value, so that a quantile is at most 6.25 % too large.
class DurationHistogram {
 public:
  /// Negative durations count as 0.
  void add(TimeNs duration_ns) noexcept {
    const std::uint64_t value = duration_ns > 0 ? static_cast<std::uint64_t>(duration_ns) : 0;
    ++buckets_[bucket_of(value)];
    ++count_;
    if (duration_ns > largest_ns_) largest_ns_ = duration_ns;
  }

  /// Adds what another one has counted.
  void add(const DurationHistogram& other) noexcept {
    for (std::size_t i = 0; i < kBuckets; ++i) buckets_[i] += other.buckets_[i];
    count_ += other.count_;
    if (other.largest_ns_ > largest_ns_) largest_ns_ = other.largest_ns_;
  }

  std::uint64_t count() const noexcept { return count_; }
  TimeNs largest_ns() const noexcept { return largest_ns_; }

  /// The duration that a share `q` (0 to 1) of all did not exceed: the upper end of its bucket, but never more than the
  /// largest. 0 when nothing was counted.
  TimeNs quantile_ns(double q) const noexcept {
    if (count_ == 0) return 0;
    const double wanted = q * static_cast<double>(count_);
    std::uint64_t seen = 0;
    for (std::size_t i = 0; i < kBuckets; ++i) {
      seen += buckets_[i];
      if (seen > 0 && static_cast<double>(seen) >= wanted)
        return upper_end(i) < largest_ns_ ? upper_end(i) : largest_ns_;
    }
    return largest_ns_;
  }

 private:
  static constexpr unsigned kSplitBits = 4;  // 16 buckets for each doubling
  static constexpr std::size_t kSplit = std::size_t{1} << kSplitBits;
  static constexpr std::size_t kBuckets = (64 - kSplitBits) * kSplit;

  static std::size_t bucket_of(std::uint64_t value) noexcept {
    if (value < kSplit) return static_cast<std::size_t>(value);
    const auto shift = static_cast<unsigned>(std::bit_width(value)) - 1U - kSplitBits;
    return static_cast<std::size_t>((value >> shift) + static_cast<std::uint64_t>(shift) * kSplit);
  }
  static TimeNs upper_end(std::size_t bucket) noexcept {
    if (bucket < 2 * kSplit) return static_cast<TimeNs>(bucket);
    const std::size_t shift = bucket / kSplit - 1;
    const std::uint64_t mantissa = bucket - shift * kSplit;
    return static_cast<TimeNs>(((mantissa + 1) << shift) - 1);
  }

  std::array<std::uint32_t, kBuckets> buckets_{};
  std::uint64_t count_ = 0;
  TimeNs largest_ns_ = 0;
};

}  // namespace tandem::hal
