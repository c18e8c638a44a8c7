#include "bridges/epuck_emulator/radio.hpp"

#include <algorithm>

namespace tandem::bridges::epuck_emulator {
namespace {

constexpr unsigned kWantsImage = 1, kWantsSensors = 2;
constexpr std::size_t kImage = std::size_t{160} * 120 * 2;

}  // namespace

void Radio::new_host() noexcept {
  arrived_ = 0;
  commanded_ = cut_ = false;  // it tells nothing before the first command of this host
  to_host_.clear();
}

// Whatever stands first: bytes out of step are obeyed as well.
void Radio::receive(std::uint8_t byte, hal::TimeNs at) {
  run_until(at);
  arriving_[arrived_++] = byte;
  if (arrived_ < kCommand) return;
  arrived_ = 0;
  if (!commanded_ && arriving_[0] != 0x80) return;
  command_ = arriving_;
  if (!commanded_ && !asking_) turn_ns_ = at;
  commanded_ = true;
}

void Radio::begin_turn(hal::TimeNs now) {
  asking_ = true;
  turn_ns_ = now + kPatience;
  answer_.clear();
  hal::TimeNs at = now;
  const auto say = [&](std::uint8_t byte) { to_robot_.push_back({byte, at += kByteNs}); };
  say(0xF7);
  for (std::size_t i = 2; i < kCommand; ++i) say(command_[i]);
  say(0xF8);
  say(0);
}

void Radio::end_turn(hal::TimeNs now) {
  asking_ = false;
  turn_ns_ = now + kPause;
  if (!commanded_) return;
  const unsigned wants = command_[1];
  if ((wants & kWantsImage) != 0) {
    std::vector<std::uint8_t> image(1 + kImage, 0x42);
    image[0] = 1;
    tell(std::move(image), now);
  }
  if ((wants & kWantsSensors) != 0) {
    std::vector<std::uint8_t> packet = {2};
    answer_.resize(kSensors);
    packet.insert(packet.end(), answer_.begin(), answer_.end());
    packet.push_back(0);
    tell(std::move(packet), now);
  } else if ((wants & kWantsImage) == 0) {
    tell({3}, now);
  }
}

void Radio::tell(std::vector<std::uint8_t> packet, hal::TimeNs at) {
  if (cut_) packet.resize((packet.size() + 1) / 2);
  cut_ = false;
  for (const std::uint8_t byte : packet) to_host_.push_back({byte, at});
}

void Radio::run_until(hal::TimeNs now) {
  for (;;) {
    while (!to_robot_.empty() && to_robot_.front().at <= now) {
      firmware_.receive(to_robot_.front().byte, to_robot_.front().at);
      to_robot_.pop_front();
    }
    firmware_.run_until(now);
    from_robot_.clear();
    firmware_.take_sent(now, from_robot_);
    for (const SentByte& s : from_robot_) {
      if (asking_ && answer_.size() < kSensors) answer_.push_back(s.byte);  // a greeting before is nobody's
    }
    if (asking_ && answer_.size() == kSensors) {
      end_turn(std::max(from_robot_.empty() ? now : from_robot_.back().at, turn_ns_ - kPatience));
    } else if (asking_ && now >= turn_ns_) {
      asking_ = false;  // the robot starts, or is deaf: nothing is told
      to_robot_.clear();
      turn_ns_ += kPause;
    } else if (!asking_ && commanded_ && now >= turn_ns_) {
      begin_turn(turn_ns_);
    } else {
      return;
    }
  }
}

void Radio::take_sent(hal::TimeNs now, std::vector<SentByte>& out) {
  while (!to_host_.empty() && to_host_.front().at <= now) {
    out.push_back(to_host_.front());
    to_host_.pop_front();
  }
}

std::optional<hal::TimeNs> Radio::next_event(hal::TimeNs patience_ns) const {
  std::optional<hal::TimeNs> next = firmware_.next_event(patience_ns);
  const auto consider = [&next](hal::TimeNs at) { next = next ? std::min(*next, at) : at; };
  if (!to_host_.empty()) consider(to_host_.front().at);
  if (!to_robot_.empty()) consider(to_robot_.back().at);
  if (asking_ || commanded_) consider(turn_ns_);
  return next;
}

}  // namespace tandem::bridges::epuck_emulator
