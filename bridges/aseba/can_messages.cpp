#include "bridges/aseba/can_messages.hpp"

namespace tandem::bridges::aseba {

CanMessages::CanMessages(std::unique_ptr<CanLink> link, const CanMessagesSettings& settings, Clock clock)
    : link_(std::move(link)),
      settings_(settings),
      clock_(std::move(clock)),
      queue_(std::make_unique<std::array<Queued, kCapacity>>()),
      tokens_(static_cast<double>(settings_.burst)),
      tokens_at_ns_(clock_()) {}

Carrier CanMessages::state() const noexcept {
  if (link_->state() == BusState::Gone) return Carrier::Gone;
  return can_pass(link_->state()) ? Carrier::Up : Carrier::Down;
}

void CanMessages::watch_carrier() noexcept {
  const bool up = state() == Carrier::Up;
  if (up == up_) return;
  up_ = up;
  if (up) {
    ++statistics_.times_up;
  } else {
    ++statistics_.times_down;
    assembler_.clear();
    drop_all();
  }
}

/// Forgets every queued frame, also those of a message that is half on its way.
void CanMessages::drop_all() noexcept {
  if (count_ > 0 && !at(0).first) broken_ = true;
  for (std::size_t i = 0; i < count_; ++i) statistics_.dropped += at(i).last ? 1U : 0U;
  count_ = 0;
}

void CanMessages::clear() noexcept {
  std::size_t keep = 0;
  if (count_ > 0 && !at(0).first) {
    while (!at(keep++).last) {
    }
  }
  for (std::size_t i = keep; i < count_; ++i) statistics_.dropped += at(i).last ? 1U : 0U;
  count_ = keep;
  flush(clock_());
}

bool CanMessages::may_send(hal::TimeNs now) noexcept {
  const double elapsed_s = hal::to_seconds(std::max<hal::TimeNs>(now - tokens_at_ns_, 0));
  tokens_ = std::min(static_cast<double>(settings_.burst), tokens_ + elapsed_s * settings_.frames_per_s);
  tokens_at_ns_ = now;
  return tokens_ >= 1.0;
}

void CanMessages::flush(hal::TimeNs now) noexcept {
  watch_carrier();
  if (!up_) return;
  if (count_ > 0 && now - at(0).since_ns > settings_.send_timeout_ns) {
    ++statistics_.times_stuck;
    drop_all();
  }
  while ((count_ > 0 || broken_) && may_send(now)) {
    const Sent sent = link_->send(broken_ ? closing_frame(settings_.source) : at(0).frame);
    if (sent == Sent::Full) return;
    if (sent == Sent::Refused) {
      drop_all();
      watch_carrier();
      return;
    }
    tokens_ -= 1.0;
    if (broken_) {
      broken_ = false;
      continue;
    }
    if (at(0).last) ++statistics_.sent;
    first_ = (first_ + 1) % kCapacity;
    --count_;
  }
}

bool CanMessages::send(std::uint16_t type, std::span<const std::uint8_t> payload) noexcept {
  const hal::TimeNs now = clock_();
  flush(now);
  if (!up_ || payload.size() > kMostPayload) {
    ++statistics_.refused;
    return false;
  }
  const std::size_t frames = frames_for(payload.size());
  if (count_ > 0 && count_ + frames > std::min(settings_.most_waiting, kCapacity)) {
    ++statistics_.no_room;
    return false;
  }
  for (std::size_t i = 0; i < frames; ++i) {
    at(count_++) = {fragment(settings_.source, type, payload, i), i == 0, i + 1 == frames, now};
  }
  flush(now);
  return true;
}

bool CanMessages::receive(MessageView& message) noexcept {
  const hal::TimeNs now = clock_();
  flush(now);
  CanFrame frame;
  while (link_->receive(frame)) {
    if (const auto complete = assembler_.push(frame)) {
      ++statistics_.received;
      message = *complete;
      return true;
    }
  }
  assembler_.expire(now);
  watch_carrier();
  return false;
}

bool CanMessages::wait(hal::TimeNs timeout_ns) noexcept {
  flush(clock_());
  // Frames that wait for the bus or for their turn leave with a later call.
  const bool ready = link_->wait(count_ > 0 ? std::min(timeout_ns, hal::kNsPerMs) : timeout_ns);
  flush(clock_());
  return ready;
}

MessageLinkStatistics CanMessages::statistics() const noexcept {
  MessageLinkStatistics all = statistics_;
  const AssemblerStatistics& a = assembler_.statistics();
  all.broken_in = a.foreign + a.bad_length + a.lost_stop + a.stray_normal + a.stray_stop + a.too_long + a.timed_out;
  return all;
}

}  // namespace tandem::bridges::aseba
