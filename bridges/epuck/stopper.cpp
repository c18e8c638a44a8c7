#include "bridges/epuck/stopper.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <unistd.h>

#include "bridges/epuck/link.hpp"
#include "bridges/epuck/wifi_session.hpp"
#include "bridges/link/tcp_link.hpp"
#include "hal/robot/epuck.hpp"

namespace tandem::bridges::epuck {
namespace {

using guardian::StopState;
using hal::TimeNs;

constexpr std::string_view kSocket = "socket=";
constexpr TimeNs kStep = 40 * hal::kNsPerMs;
constexpr TimeNs kWriteWithin = 20 * hal::kNsPerMs;  // four times as long as the longest burst takes

/// -1: the body names none.
int descriptor_in(std::string_view body) noexcept {
  int descriptor = -1;
  if (!body.starts_with(kSocket)) return -1;
  body.remove_prefix(kSocket.size());
  const auto [end, error] = std::from_chars(body.data(), body.data() + body.size(), descriptor);
  return error == std::errc{} && end == body.data() + body.size() ? descriptor : -1;
}

std::unique_ptr<guardian::Stopper> make(const StopMessages& messages, guardian::StopCause cause) {
  LinkTerms terms;
  terms.beside = true;
  const auto link = epuck_link(messages.link, terms);
  if (!link.ok()) {
    const auto fails = [error = link.error()]() -> hal::Result<std::unique_ptr<ByteLink>> { return error; };
    return std::make_unique<EpuckStopper>(fails, StopTiming{});
  }
  LinkOpener open = link.value().open;
  const int held = descriptor_in(messages.body);
  if (cause == guardian::StopCause::HubFrozen && held >= 0 && link.value().port != 0) {
    open = [connect = open, held, port = link.value().port] {
      end_connection_of(::getppid(), held, port);
      return connect();
    };
  }
  return std::make_unique<EpuckStopper>(open, stop_timing_for(messages.link), link.value().wire);
}

}  // namespace

const guardian::StopperType& stopper_type() noexcept {
  static const guardian::StopperType type{hal::epuck::kName, &make};
  return type;
}

std::string stop_body(int descriptor) {
  return descriptor >= 0 ? std::string(kSocket) + std::to_string(descriptor) : std::string();
}

EpuckStopper::EpuckStopper(LinkOpener opener, const StopTiming& timing, WireForm wire) : opener_(std::move(opener)) {
  if (wire == WireForm::Wifi)
    talk_ = std::make_unique<WifiStop>(timing);
  else
    talk_ = std::make_unique<StopProcedure>(timing);
}

bool EpuckStopper::open(TimeNs now) {
  auto opened = opener_();
  if (!opened.ok()) {
    trouble_ = opened.error().message;
    return false;
  }
  link_ = std::move(opened).value();
  talk_->begin(std::max(now, monotonic_ns()));  // opening may have taken long
  return true;
}

void EpuckStopper::hang_up(const std::string& why) {
  link_.reset();
  trouble_ = why;
}

StopState EpuckStopper::step(TimeNs now) {
  if (!link_) {
    if (!open(now)) return StopState::Unreachable;
    now = monotonic_ns();
  }
  std::array<std::uint8_t, 256> buffer{};
  for (const TimeNs end = now + kStep; now < end && !talk_->confirmed(); now = monotonic_ns()) {
    Packet out;
    talk_->poll(now, out);
    if (!out.empty() && link_->write(out.bytes(), kWriteWithin) < out.size() && link_->state() == LinkState::Open &&
        talk_->needs_whole_packets()) {
      hang_up("the link does not take what is sent");
      return StopState::Unreachable;
    }
    const TimeNs due = std::min(end, talk_->next_deadline());
    link_->wait(std::max<TimeNs>(0, due - monotonic_ns()));
    const Received received = link_->read(buffer);
    talk_->on_bytes(std::span(buffer).first(received.size), received.at_ns);
    if (link_->state() == LinkState::HungUp || talk_->wants_new_link()) {
      hang_up(link_->state() == LinkState::HungUp ? "the link hung up" : "nothing comes");
      return StopState::Unreachable;
    }
  }
  if (talk_->confirmed()) return StopState::Confirmed;
  trouble_ = talk_->answered() ? "it still moves, or its answers are damaged" : "it does not answer";
  return talk_->answered() ? StopState::Stopping : StopState::Unreachable;
}

}  // namespace tandem::bridges::epuck
