#include "bridges/epuck/stopper.hpp"

#include <algorithm>
#include <array>

#include "bridges/link/link_text.hpp"
#include "hal/robot/epuck.hpp"

namespace tandem::bridges::epuck {
namespace {

using guardian::StopState;
using hal::TimeNs;

constexpr TimeNs kStep = 40 * hal::kNsPerMs;
constexpr TimeNs kWriteWithin = 20 * hal::kNsPerMs;  // four times as long as the longest burst takes

std::unique_ptr<guardian::Stopper> make(const StopMessages& messages, guardian::StopCause) {
  const auto opener = [link = messages.link]() -> hal::Result<std::unique_ptr<ByteLink>> {
    const auto address = parse_link(link);
    if (!address.ok()) return address.error();
    LinkTerms terms;
    terms.beside = true;
    const auto open = byte_link_opener(address.value(), terms);
    if (!open.ok()) return open.error();
    return open.value()();
  };
  return std::make_unique<EpuckStopper>(opener, stop_timing_for(messages.link));
}

}  // namespace

const guardian::StopperType& stopper_type() noexcept {
  static const guardian::StopperType type{hal::epuck::kName, &make};
  return type;
}

bool EpuckStopper::open(TimeNs now) {
  auto opened = opener_();
  if (!opened.ok()) {
    trouble_ = opened.error().message;
    return false;
  }
  link_ = std::move(opened).value();
  procedure_.begin(now);
  return true;
}

void EpuckStopper::hang_up() {
  link_.reset();
  trouble_ = "the link hung up";
}

StopState EpuckStopper::step(TimeNs now) {
  if (!link_) {
    if (!open(now)) return StopState::Unreachable;
    now = monotonic_ns();  // opening may have taken long
  }
  std::array<std::uint8_t, 256> buffer{};
  for (const TimeNs end = now + kStep; now < end && !procedure_.confirmed(); now = monotonic_ns()) {
    Packet out;
    procedure_.poll(now, out);
    if (!out.empty()) link_->write(out.bytes(), kWriteWithin);
    const TimeNs due = std::min(end, procedure_.next_deadline());
    link_->wait(std::max<TimeNs>(0, due - monotonic_ns()));
    const Received received = link_->read(buffer);
    for (std::size_t i = 0; i < received.size; ++i) procedure_.on_byte(buffer[i], received.at_ns);
    if (link_->state() == LinkState::HungUp) {
      hang_up();
      return StopState::Unreachable;
    }
  }
  if (procedure_.confirmed()) return StopState::Confirmed;
  trouble_ = procedure_.answered() ? "it still moves, or its answers are damaged" : "it does not answer";
  return procedure_.answered() ? StopState::Stopping : StopState::Unreachable;
}

}  // namespace tandem::bridges::epuck
