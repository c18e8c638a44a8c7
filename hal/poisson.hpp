// Numbers of events.
#pragma once
#include <algorithm>
#include <cstdint>

#include "hal/elementary.hpp"
#include "hal/random.hpp"

namespace tandem::hal {

/// Of the Poisson distribution: how many events there are where `mean` are expected; takes time in proportion to that.
/// [Knuth, The Art of Computer Programming 2, 3.4.1], by parts that exp(-mean) can tell from 0.
inline std::int64_t poisson(Random& random, double mean) noexcept {
  std::int64_t events = 0;
  while (mean > 0.0) {
    const double part = std::min(mean, 30.0);
    mean -= part;
    const double least = exp(-part);
    for (double product = random.uniform(); product > least; product *= random.uniform()) ++events;
  }
  return events;
}

}  // namespace tandem::hal
