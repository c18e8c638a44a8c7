#include "study/sweep/queue.hpp"

#include <algorithm>
#include <tuple>

namespace tandem::study {

RunQueue::RunQueue(const std::vector<std::int64_t>& runs, std::int64_t configurations, std::size_t workers)
    : runs_(runs), configurations_(configurations), own_(workers) {
  std::sort(runs_.begin(), runs_.end(), [configurations](std::int64_t a, std::int64_t b) {
    return std::tuple(a % configurations, a) < std::tuple(b % configurations, b);
  });
}

std::optional<std::int64_t> RunQueue::next(std::size_t worker) {
  std::deque<std::int64_t>& own = own_[worker];
  if (own.empty() && begun_ < runs_.size()) {
    const std::int64_t configuration = runs_[begun_] % configurations_;
    while (begun_ < runs_.size() && runs_[begun_] % configurations_ == configuration) own.push_back(runs_[begun_++]);
  }
  if (own.empty()) {
    const auto richest =
        std::max_element(own_.begin(), own_.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
    for (std::size_t take = (richest->size() + 1) / 2; take > 0; --take) {
      own.push_front(richest->back());
      richest->pop_back();
    }
  }
  if (own.empty()) return std::nullopt;
  const std::int64_t run = own.front();
  own.pop_front();
  return run;
}

}  // namespace tandem::study
