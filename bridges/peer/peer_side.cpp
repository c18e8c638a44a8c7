#include "bridges/peer/peer_side.hpp"

#include <array>

namespace tandem::bridges::peer {
namespace {

constexpr hal::TimeNs kWriteWithin_ns = hal::kNsPerSecond;

}  // namespace

void PeerSide::link_opened() noexcept {
  reader_.clear();
  greeted_ = false;
  next_hello_ns_ = 0;
  ++counts_.links;
}

void PeerSide::pump(ByteLink& link, hal::TimeNs now) {
  if (heard_ns_ == 0) heard_ns_ = now;
  std::array<std::uint8_t, 4096> buffer;
  for (Received got = link.read(buffer); got.size > 0; got = link.read(buffer)) {
    reader_.push(std::span(buffer).first(got.size));
    while (const auto frame = reader_.next()) {
      heard_ns_ = now;
      if (!ended_) take(*frame, link);
    }
  }
  if (greeted_ || ended_ || now < next_hello_ns_) return;
  next_hello_ns_ = now + kHelloEvery_ns;
  Hello hello{wanted_, {}, -1, kVersion};
  if (controller_ != nullptr) hello = {told_->robot, told_->session, answered_, kVersion};
  send(link, MessageType::Hello, bytes_of(hello));
}

void PeerSide::take(const FrameReader::Frame& frame, ByteLink& link) {
  switch (frame.type) {
    case MessageType::Robot:
      return take_robot(frame.payload, link);
    case MessageType::Tick:
      return take_tick(frame.payload, link);
    case MessageType::End: {
      const auto end = read_farewell(frame.payload);
      ended_ = end.ok() ? end.value() : Farewell{true, end.error().message};
      return;
    }
    default:
      ++counts_.not_understood;
  }
}

/// Comes again when our Ready was lost, and on every new link.
void PeerSide::take_robot(std::span<const std::uint8_t> payload, ByteLink& link) {
  const auto robot = read_robot(payload);
  std::string why;
  if (!robot.ok()) {
    why = robot.error().message;
  } else if (robot.value().version != kVersion) {
    why = "the hub speaks version " + std::to_string(robot.value().version) + " of the protocol, this program " +
          std::to_string(kVersion);
  } else if (controller_ != nullptr && robot.value().session != told_->session && answered_ >= 0) {
    why = "the hub began another run; this controller is in the middle of one";
  } else if (controller_ == nullptr || robot.value().session != told_->session) {
    controller_.reset();  // one that has not stepped may begin in any run
    auto made = make_(robot.value());
    if (made.ok()) {
      told_ = robot.value();
      controller_ = std::move(made).value();
    } else {
      why = made.error().message;
    }
  }
  if (!why.empty()) {
    ended_ = Farewell{true, why};
    return leave(link, why);
  }
  greeted_ = true;
  Ready ready = controller_->robot().ready();
  ready.controller = controller_->copy();
  send(link, MessageType::Ready, bytes_of(ready));
}

void PeerSide::take_tick(std::span<const std::uint8_t> payload, ByteLink& link) {
  TickHead head;
  if (controller_ == nullptr || !take_head(payload, head) || head.tick < answered_) {
    ++counts_.not_understood;
    return;
  }
  greeted_ = true;
  if (head.tick == answered_) {
    ++counts_.asked_again;
    return send(link, MessageType::Commands, answer_);
  }
  if (!controller_->robot().take_readings(payload, head.flags)) {
    const std::string why = "tick " + std::to_string(head.tick) + " does not have the form that was agreed on";
    ended_ = Farewell{true, why};
    return leave(link, why);
  }
  answered_ = head.tick;
  answer_.clear();
  if (std::string what; controller_->step(head.tick, what)) {
    append_tick(answer_, head.tick, 0);
    controller_->robot().give_commands(answer_);
  } else {
    append_tick(answer_, head.tick, kThrew);
    answer_.insert(answer_.end(), what.begin(), what.end());
  }
  ++counts_.ticks;
  send(link, MessageType::Commands, answer_);
}

void PeerSide::leave(ByteLink& link, const std::string& why) {
  send(link, MessageType::Bye, bytes_of(Farewell{ended_ && ended_->error, why}));
}

void PeerSide::send(ByteLink& link, MessageType type, const std::vector<std::uint8_t>& payload) {
  (void)link.write(frame_of(type, payload), kWriteWithin_ns);
}

PeerCounts PeerSide::counts() const noexcept {
  PeerCounts counts = counts_;
  counts.garbled = reader_.garbled();
  return counts;
}

}  // namespace tandem::bridges::peer
