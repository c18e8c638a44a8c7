// The runs that are still to be made, shared out among workers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace tandem::study {

/// Gives each worker runs of one configuration after the other, so that it can keep its world; a worker without work
/// takes half of what another one has left.
class RunQueue {
 public:
  /// `runs` are numbers; run n has configuration n % `configurations`.
  RunQueue(const std::vector<std::int64_t>& runs, std::int64_t configurations, std::size_t workers);

  /// The next run of this worker; nothing: none is left.
  std::optional<std::int64_t> next(std::size_t worker);
  /// A run that was taken and not made.
  void put_back(std::size_t worker, std::int64_t run) { own_[worker].push_front(run); }

 private:
  std::vector<std::int64_t> runs_;  // by configuration, then by number
  std::int64_t configurations_;
  std::size_t begun_ = 0;  // of runs_, those before are in own_ or gone
  std::vector<std::deque<std::int64_t>> own_;
};

}  // namespace tandem::study
