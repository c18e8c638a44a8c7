#include "bridges/footbot/memory_watch.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::bridges::footbot {
namespace {

bool all_zero(std::span<const std::int16_t> words) noexcept {
  return std::ranges::all_of(words, [](std::int16_t word) { return word == 0; });
}

}  // namespace

void ToldWords::sent(std::span<const std::int16_t> words, hal::TimeNs now) noexcept {
  if (all_zero(words)) zeros_sent_ns_ = now;
}

bool ToldWords::forgotten(std::span<const std::int16_t> words, hal::TimeNs taken_ns) noexcept {
  if (taken_ns == 0 || taken_ns == taken_ns_) return false;
  taken_ns_ = taken_ns;
  const bool zeros = all_zero(words);
  const bool forgotten = held_ && zeros && taken_ns - zeros_sent_ns_ > kOldAnswers_ns;
  held_ = !zeros;
  return forgotten;
}

bool ModuleCounter::began_anew(std::int32_t raw, hal::TimeNs taken_ns) noexcept {
  if (taken_ns == 0 || taken_ns == taken_ns_) return false;
  const bool first = taken_ns_ == 0;
  const auto since_ns = static_cast<double>(taken_ns - taken_ns_);
  const double way = std::fabs(static_cast<double>(raw_));  // back to 0
  const bool anew = !first && raw == 0 && way > kLeast && way > kMostTimes * std::fabs(counts_per_ns_) * since_ns;
  const bool went_on = !first && !anew && since_ns > 0.0;
  counts_per_ns_ = went_on ? (static_cast<double>(raw) - static_cast<double>(raw_)) / since_ns : 0.0;
  raw_ = raw;
  taken_ns_ = taken_ns;
  return anew;
}

}  // namespace tandem::bridges::footbot
