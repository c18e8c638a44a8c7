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
  const double now = raw, before = raw_;
  const double reach = kMostTimes * std::fabs(counts_per_ns_) * since_ns;  // of counting, from before or from 0
  const bool silent = since_ns > kSilentTimes * interval_ns_;
  const bool from_start = raw == 0 || (silent && std::fabs(now) <= reach);
  const bool anew = !first && from_start && std::fabs(now - before) > std::max(kLeast, reach);
  const bool went_on = !first && !anew && since_ns > 0.0;
  counts_per_ns_ = went_on ? (now - before) / since_ns : 0.0;
  interval_ns_ = first ? 0.0 : since_ns;
  raw_ = raw;
  taken_ns_ = taken_ns;
  return anew;
}

}  // namespace tandem::bridges::footbot
