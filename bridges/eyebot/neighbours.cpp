#include "bridges/eyebot/neighbours.hpp"

#include <algorithm>

namespace tandem::bridges::eyebot {

void Neighbours::hear_robot(std::string_view name) {
  const std::lock_guard lock(mutex_);
  const auto end = robots_.begin() + static_cast<std::ptrdiff_t>(robot_count_);
  if (robot_count_ == kMost || std::find(robots_.begin(), end, name) != end) return;
  robots_[robot_count_++] = name;
}

void Neighbours::hear_hub(std::string_view name, std::int32_t session) {
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < hub_count_; ++i) {
    if (hubs_[i].name != name) continue;
    hubs_[i].session = session;
    return;
  }
  if (hub_count_ < kMost) hubs_[hub_count_++] = {std::string(name), session};
}

void Neighbours::hear_command(std::int32_t session, hal::TimeNs received_ns) noexcept {
  commander_.store(session, std::memory_order_relaxed);
  commanded_ns_.store(received_ns, std::memory_order_relaxed);
}

std::string Neighbours::hub_of(std::int32_t session) const {
  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < hub_count_; ++i) {
    if (session != 0 && hubs_[i].session == session) return "another hub, '" + hubs_[i].name + "',";
  }
  return "another hub";
}

std::string Neighbours::robots() const {
  const std::lock_guard lock(mutex_);
  std::array<std::string, kMost> sorted = robots_;
  const auto end = sorted.begin() + static_cast<std::ptrdiff_t>(robot_count_);
  std::sort(sorted.begin(), end);
  std::string text;
  for (auto name = sorted.begin(); name != end; ++name) text += (text.empty() ? "" : ", ") + *name;
  return text;
}

}  // namespace tandem::bridges::eyebot
