#include "bridges/aseba/reopening_messages.hpp"

#include <chrono>
#include <thread>

namespace tandem::bridges::aseba {

ReopeningMessages::ReopeningMessages(MessageLinkOpener opener, hal::TimeNs first_pause_ns, hal::TimeNs longest_pause_ns)
    : opener_(std::move(opener)),
      first_pause_ns_(first_pause_ns),
      longest_pause_ns_(longest_pause_ns),
      pause_ns_(first_pause_ns) {
  work_.emplace(opener_);
}

void ReopeningMessages::look_after() noexcept {
  if (link_ != nullptr && link_->state() == Carrier::Gone) {
    before_ = statistics();
    before_.refused -= refused_;  // counted apart
    link_.reset();
    pause_ns_ = first_pause_ns_;
    next_try_ns_ = monotonic_ns() + pause_ns_;
  }
  if (link_ != nullptr) return;
  if (!work_) {
    if (monotonic_ns() >= next_try_ns_) work_.emplace(opener_);
    return;
  }
  auto result = work_->take();
  if (!result) return;
  work_.reset();
  if (*result) {
    link_ = std::move(*result).value();
    name_ = link_->name();
    trouble_.clear();
    if (openings_++ > 0) ++before_.times_up;
    pause_ns_ = first_pause_ns_;
  } else {
    trouble_ = result->error().message;
    ++failed_openings_;
    next_try_ns_ = monotonic_ns() + pause_ns_;
    pause_ns_ = std::min(2 * pause_ns_, longest_pause_ns_);
  }
}

bool ReopeningMessages::send(std::uint16_t type, std::span<const std::uint8_t> payload) noexcept {
  look_after();
  if (link_ != nullptr) return link_->send(type, payload);
  ++refused_;
  return false;
}

bool ReopeningMessages::receive(MessageView& message) noexcept {
  look_after();
  return link_ != nullptr && link_->receive(message);
}

bool ReopeningMessages::wait(hal::TimeNs timeout_ns) noexcept {
  look_after();
  if (link_ != nullptr) return link_->wait(timeout_ns);
  if (work_) {
    work_->wait(timeout_ns);
  } else {
    const hal::TimeNs pause = std::min(timeout_ns, std::max<hal::TimeNs>(next_try_ns_ - monotonic_ns(), 0));
    std::this_thread::sleep_for(std::chrono::nanoseconds(pause));
  }
  look_after();
  return false;
}

void ReopeningMessages::clear() noexcept {
  look_after();
  if (link_ != nullptr) link_->clear();
}

Carrier ReopeningMessages::state() const noexcept {
  return link_ != nullptr && link_->state() == Carrier::Up ? Carrier::Up : Carrier::Down;
}

MessageLinkStatistics ReopeningMessages::statistics() const noexcept {
  MessageLinkStatistics all = before_;
  all.refused += refused_;
  if (link_ == nullptr) return all;
  const MessageLinkStatistics s = link_->statistics();
  all.received += s.received;
  all.sent += s.sent;
  all.no_room += s.no_room;
  all.refused += s.refused;
  all.dropped += s.dropped;
  all.times_stuck += s.times_stuck;
  all.broken_in += s.broken_in;
  all.times_down += s.times_down;
  all.times_up += s.times_up;
  return all;
}

}  // namespace tandem::bridges::aseba
