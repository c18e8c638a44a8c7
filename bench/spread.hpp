// The median of repeated measurements, and how far they lie apart.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace tandem::bench {

struct Spread {
  double median = 0.0;
  double smallest = 0.0;
  double largest = 0.0;
};

/// Of at least one value. The median of an even number of values is the mean of the two in the middle.
inline Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {0.5 * (values[(n - 1) / 2] + values[n / 2]), values.front(), values.back()};
}

}  // namespace tandem::bench
