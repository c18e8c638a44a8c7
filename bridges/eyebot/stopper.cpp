#include "bridges/eyebot/stopper.hpp"

#include "bridges/link/link_text.hpp"
#include "hal/robot/eyebot.hpp"

namespace tandem::bridges::eyebot {
namespace {

using guardian::StopCause;
using guardian::StopState;
using hal::TimeNs;

constexpr TimeNs kWait = 20 * hal::kNsPerMs;
constexpr TimeNs kMute = 3 * hal::kNsPerSecond;
constexpr TimeNs kHoverWithin = 2 * hal::kNsPerSecond;  // then it is told to land all the same

DriverSettings settings_for(const StopDetails& details) {
  DriverSettings s;
  s.robot.id = s.name = details.name;
  s.hub = details.hub;
  s.session = details.session;
  // Newer than what an earlier stopper has said: no channel carries a hundred messages a second.
  const TimeNs hundredths = unix_ns() / (10 * hal::kNsPerMs) % 400'000'000;
  s.first_seq =
      static_cast<std::int32_t>(static_cast<std::uint32_t>(details.first_seq) + static_cast<std::uint32_t>(hundredths));
  s.controlled = true;
  return s;
}

std::unique_ptr<guardian::Stopper> make(const StopMessages& messages, StopCause cause) {
  StopDetails details = from_stop_body(messages.body).value_or(StopDetails{});
  if (const auto address = parse_link(messages.link); address.ok()) details.url = address.value().target;
  return std::make_unique<EyebotStopper>(details, cause);
}

}  // namespace

const guardian::StopperType& stopper_type() noexcept {
  static const guardian::StopperType type{hal::eyebot::kName, &make};
  return type;
}

EyebotStopper::EyebotStopper(const StopDetails& details, StopCause cause)
    : details_(details),
      land_(details.land && cause == StopCause::HubGone),
      inbox_(std::make_shared<Inbox>()),
      driver_(settings_for(details), *inbox_, *this) {}

bool EyebotStopper::publish(const std::string& channel, std::span<const std::byte> data) noexcept {
  return link_ && link_->publish(channel, data);
}

bool EyebotStopper::open() {
  auto opened = lcm_bus::LcmLink::open(details_.url);
  const auto deliver = [inbox = inbox_, name = details_.name](const lcm_bus::LcmMessage& m) {
    if (const auto topic = topic_of(name, m.channel)) inbox->deliver(*topic, m.data, m.received_ns);
  };
  hal::Status ready = opened.ok() ? hal::Status{} : hal::Status{opened.error()};
  if (ready.ok()) ready = opened.value()->subscribe("eyebot/" + details_.name + "/[a-z_]+", deliver);
  if (ready.ok()) ready = opened.value()->start();
  if (!ready.ok()) {
    link_trouble_ = ready.error().message;
    return false;
  }
  link_trouble_.clear();
  link_ = std::move(opened).value();
  opened_ns_ = lcm_bus::monotonic_ns();
  return true;
}

StopState EyebotStopper::step(TimeNs now) {
  if (details_.name.empty()) return StopState::Confirmed;  // nobody has ever spoken to it
  if (!link_) {
    if (!open()) return StopState::Unreachable;
    now = lcm_bus::monotonic_ns();  // opening may have taken long
  }
  if (begun_ns_ == 0) {
    begun_ns_ = now;
    driver_.stop(now);
  } else {
    driver_.pump(now);
  }
  if (!driver_.status().known || driver_.state() == RobotState::Lost) {
    if (now - opened_ns_ >= kMute) link_.reset();  // the network may have gone and come back
    inbox_->wait(kWait);
    return StopState::Unreachable;
  }
  if (land_ && (driver_.at_rest() || now - begun_ns_ >= kHoverWithin)) driver_.land(now);
  if (land_ ? driver_.landed() : driver_.at_rest()) return StopState::Confirmed;
  inbox_->wait(kWait);
  return StopState::Stopping;
}

}  // namespace tandem::bridges::eyebot
