#include "bridges/footbot_emulator/bus.hpp"

#include <algorithm>
#include <limits>

namespace tandem::bridges::footbot_emulator {

void Bus::send(std::size_t sender, const std::vector<Frame>& frames, hal::TimeNs ready) {
  for (const Frame& frame : frames) queues_[sender].push_back({frame, ready});
}

std::optional<Bus::Winner> Bus::winner() const {
  hal::TimeNs start = std::numeric_limits<hal::TimeNs>::max();
  for (const auto& queue : queues_) {
    if (!queue.empty()) start = std::min(start, std::max(free_at_, queue.front().at));
  }
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < queues_.size(); ++i) {
    if (queues_[i].empty() || queues_[i].front().at > start) continue;
    if (!first || queues_[i].front().frame.id < queues_[*first].front().frame.id) first = i;
  }
  if (!first) return std::nullopt;
  return Winner{*first, start + duration_ns(queues_[*first].front().frame)};
}

std::optional<Bus::Passed> Bus::next(hal::TimeNs now) {
  const auto won = winner();
  if (!won || won->end > now) return std::nullopt;
  Passed passed{won->sender, {queues_[won->sender].front().frame, won->end}};
  queues_[won->sender].pop_front();
  free_at_ = won->end;
  return passed;
}

std::optional<hal::TimeNs> Bus::next_at() const {
  const auto won = winner();
  if (!won) return std::nullopt;
  return won->end;
}

}  // namespace tandem::bridges::footbot_emulator
