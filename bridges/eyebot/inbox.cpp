#include "bridges/eyebot/inbox.hpp"

#include <chrono>

#include "bridges/eyebot_messages/codec.hpp"

namespace tandem::bridges::eyebot {
namespace {

constexpr unsigned kBelieveAfter = 20;
constexpr std::size_t kUsualBytes = 2048;

std::uint64_t type_of(std::span<const std::byte> data) noexcept {
  std::uint64_t type = 0;
  for (std::size_t i = 0; i < 8; ++i) type = type << 8 | std::to_integer<std::uint64_t>(data[i]);
  return type;
}

}  // namespace

Inbox::Inbox() {
  for (std::size_t i = 0; i < kTopics; ++i) {
    const auto topic = static_cast<Topic>(i);
    slots_[i].depth = topic == Topic::Ack || topic == Topic::Heartbeat || topic == Topic::Rab ? kRow : 1;
    for (std::size_t k = 0; k < slots_[i].depth; ++k) slots_[i].letters[k].data.reserve(kUsualBytes);
  }
}

bool Inbox::in_order(Slot& slot, std::int32_t session, std::int32_t seq) noexcept {
  if (slot.known && session == slot.session) {
    const auto step = static_cast<std::int32_t>(static_cast<std::uint32_t>(seq) - static_cast<std::uint32_t>(slot.seq));
    if (step <= 0 && ++slot.old_in_row < kBelieveAfter) {
      ++slot.statistics.old;
      return false;
    }
    if (step > 1) slot.statistics.lost += static_cast<std::uint64_t>(step - 1);
  }
  slot.known = true;
  slot.session = session;
  slot.seq = seq;
  slot.old_in_row = 0;
  return true;
}

void Inbox::put(Slot& slot, std::span<const std::byte> data, hal::TimeNs received_ns) noexcept {
  if (slot.count == slot.depth) {
    ++slot.statistics.replaced;
    slot.first = (slot.first + 1) % slot.depth;
    --slot.count;
  }
  Letter& letter = slot.letters[(slot.first + slot.count) % slot.depth];
  letter.data.assign(data.begin(), data.end());
  letter.received_ns = received_ns;
  ++slot.count;
}

void Inbox::deliver(Topic topic, std::span<const std::byte> data, hal::TimeNs received_ns) noexcept {
  const auto header = eyebot_messages::peek_header(data);
  const bool fits = header && data.size() <= eyebot_messages::kMostBytes && type_of(data) == topic_fingerprint(topic);
  {
    const std::lock_guard lock(mutex_);
    Slot& slot = slots_[static_cast<std::size_t>(topic)];
    ++slot.statistics.received;
    if (!fits) {
      ++slot.statistics.refused;
      return;
    }
    if (!in_order(slot, header->session, header->seq)) return;
    put(slot, data, received_ns);
    news_ = true;
  }
  changed_.notify_one();
}

bool Inbox::take(Topic topic, Letter& letter) noexcept {
  const std::lock_guard lock(mutex_);
  Slot& slot = slots_[static_cast<std::size_t>(topic)];
  if (slot.count == 0) return false;
  std::swap(letter, slot.letters[slot.first]);
  slot.first = (slot.first + 1) % slot.depth;
  --slot.count;
  return true;
}

void Inbox::wait(hal::TimeNs timeout_ns) {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::nanoseconds(timeout_ns), [this] { return news_; });
  news_ = false;
}

void Inbox::wake() {
  {
    const std::lock_guard lock(mutex_);
    news_ = true;
  }
  changed_.notify_one();
}

TopicStatistics Inbox::statistics(Topic topic) const {
  const std::lock_guard lock(mutex_);
  return slots_[static_cast<std::size_t>(topic)].statistics;
}

TopicStatistics Inbox::statistics() const {
  const std::lock_guard lock(mutex_);
  TopicStatistics all;
  for (const Slot& slot : slots_) {
    all.received += slot.statistics.received;
    all.lost += slot.statistics.lost;
    all.old += slot.statistics.old;
    all.replaced += slot.statistics.replaced;
    all.refused += slot.statistics.refused;
  }
  return all;
}

}  // namespace tandem::bridges::eyebot
