#include "core/physics/dynamics3d/pair_finder.hpp"

#include <algorithm>

namespace tandem::core {

const std::vector<PairFinder::Pair>& PairFinder::find() {
  pairs_.clear();
  std::sort(spans_.begin(), spans_.end(), [](const Span& a, const Span& b) {
    return a.min_x_m < b.min_x_m || (a.min_x_m == b.min_x_m && a.number < b.number);
  });
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    const Span& a = spans_[i];
    for (std::size_t k = i + 1; k < spans_.size() && spans_[k].min_x_m <= a.max_x_m; ++k) {
      const Span& b = spans_[k];
      if (b.min_y_m > a.max_y_m || b.max_y_m < a.min_y_m) continue;
      if (a.number >= bodies_ && b.number >= bodies_) continue;
      pairs_.push_back({std::min(a.number, b.number), std::max(a.number, b.number)});
    }
  }
  return pairs_;
}

}  // namespace tandem::core
