// What an eye-bot is told.
#include <algorithm>

#include "bridges/eyebot/driver.hpp"
#include "bridges/eyebot/readings.hpp"
#include "bridges/eyebot_messages/codec.hpp"
#include "hal/check.hpp"

namespace tandem::bridges::eyebot {
namespace {

namespace messages = eyebot_messages;
using hal::TimeNs;

constexpr std::int32_t kVelocityHolds_ms = 500;
constexpr std::int32_t kPositionHolds_ms = 1600;  // three times as long
constexpr TimeNs kDeviceAgain = hal::kNsPerSecond;
constexpr TimeNs kClocksAgree = 100 * hal::kNsPerMs;  // a robot takes stamps that are 250 ms off
constexpr std::size_t kPayloadAt = messages::kHeaderEnd;

template <class Drive>
hal::Limited limited(Drive& drive, const hal::RobotKind& kind) noexcept {
  return drive.limit(hal::limiting<typename Drive::LimitedBy>(kind));
}

void put_big_endian(std::span<std::byte> bytes, std::uint64_t n) noexcept {
  for (std::size_t i = bytes.size(); i-- > 0; n >>= 8) bytes[i] = static_cast<std::byte>(n & 0xFF);
}

}  // namespace

/// By our clock, as the protocol has it, unless the robot's is so far off that it takes what we say for old.
TimeNs EyebotDriver::stamp_ns(TimeNs now) const noexcept {
  const TimeNs own = settings_.unix_clock();
  if (!robots_clock_ || !clock_.known()) return own;
  const TimeNs robots = now - clock_.offset_ns(now);
  return own - robots < kClocksAgree && robots - own < kClocksAgree ? own : robots;
}

void EyebotDriver::send(Voice& voice, TimeNs now) noexcept {
  put_big_endian(std::span(voice.bytes).subspan(8, 8), static_cast<std::uint64_t>(stamp_ns(now) / 1000));
  put_big_endian(std::span(voice.bytes).subspan(16, 4), static_cast<std::uint32_t>(voice.seq));
  put_big_endian(std::span(voice.bytes).subspan(20, 4), static_cast<std::uint32_t>(settings_.session));
  voice.seq = static_cast<std::int32_t>(static_cast<std::uint32_t>(voice.seq) + 1U);
  voice.said_ns = now;
  const bool sent = outbox_.publish(voice.channel, std::span(voice.bytes).first(voice.size));
  ++(sent ? statistics_.said : statistics_.unsent);
}

/// Says it when it differs from what was said last, or that was `again_ns` ago.
template <class Message>
void EyebotDriver::say(Told told, Message& message, TimeNs again_ns, TimeNs now) noexcept {
  Voice& v = voice(told);
  std::array<std::byte, sizeof v.bytes> bytes{};
  const auto written = messages::encode(message, bytes);
  TANDEM_CHECK(!written.empty(), "a command fits its buffer");
  const bool same =
      written.size() == v.size && std::equal(written.begin() + kPayloadAt, written.end(), v.bytes.begin() + kPayloadAt);
  if (same && now - v.said_ns < again_ns) return;
  std::copy(written.begin(), written.end(), v.bytes.begin());
  v.size = written.size();
  send(v, now);
}

void EyebotDriver::count(const hal::Limited& limited) noexcept {
  statistics_.clamped += limited.result == hal::LimitResult::Clamped ? 1 : 0;
  statistics_.not_finite += limited.result == hal::LimitResult::NotFinite ? 1 : 0;
}

/// What the controller wrote stays as it is: it may write once and never again.
void EyebotDriver::say_setpoint(TimeNs now) noexcept {
  statistics_.rearmed += interrupted_ ? 1 : 0;
  interrupted_ = false;
  hal::QuadrotorPosition position;
  if (robot_.uses<hal::QuadrotorPosition>()) position = robot_.port<hal::QuadrotorPosition>();
  count(position.limit(flight_));
  if (!position.hold) {
    messages::CmdPosition m{};
    write(position, settings_.world, m);
    m.max_speed = static_cast<float>(flight_.max_speed_m_s);
    m.timeout_ms = kPositionHolds_ms;
    if (setpoint_ != Told::Position) voice(Told::Position).size = 0;
    setpoint_ = Told::Position;
    say(Told::Position, m, kPositionAgain, now);
    return;
  }
  hal::QuadrotorSpeed speed;
  if (robot_.uses<hal::QuadrotorSpeed>()) speed = robot_.port<hal::QuadrotorSpeed>();
  count(speed.limit(flight_));
  messages::CmdVelocity m{};
  write(speed, settings_.world, m);
  m.timeout_ms = kVelocityHolds_ms;
  if (setpoint_ != Told::Velocity) voice(Told::Velocity).size = 0;
  setpoint_ = Told::Velocity;
  say(Told::Velocity, m, kVelocityAgain, now);
}

void EyebotDriver::say_devices(TimeNs now) noexcept {
  const bool lower = robot_.uses<hal::RingLeds>(), upper = robot_.uses<hal::UpperRingLeds>();
  const bool beacon = robot_.uses<hal::CameraLed>();
  if (lower || upper || beacon) {
    write(lower ? &robot_.port<hal::RingLeds>() : nullptr, upper ? &robot_.port<hal::UpperRingLeds>() : nullptr,
          beacon ? &robot_.port<hal::CameraLed>() : nullptr, leds_);
    say(Told::Leds, leds_, kDeviceAgain, now);
  }
  if (robot_.uses<hal::PanTiltDrive>()) {
    hal::PanTiltDrive drive = robot_.port<hal::PanTiltDrive>();
    count(limited(drive, robot_.kind()));
    messages::CmdPanTilt m{};
    write(drive, m);
    say(Told::PanTilt, m, kDeviceAgain, now);
  }
  if (robot_.uses<hal::ScannerDrive>()) {
    hal::ScannerDrive drive = robot_.port<hal::ScannerDrive>();
    count(limited(drive, robot_.kind()));
    messages::CmdScanner m{};
    write(drive, m);
    say(Told::Scanner, m, kDeviceAgain, now);
  }
  if (robot_.uses<hal::RangeAndBearingSend>()) {
    write(robot_.port<hal::RangeAndBearingSend>(), radio_);
    say(Told::Rab, radio_, kDeviceAgain, now);
  }
}

void EyebotDriver::say_order(TimeNs now) noexcept {
  const auto order = orders_.due(now);
  if (!order) return;
  messages::CmdMode m{};
  m.action = static_cast<std::int8_t>(order->action);
  m.param = order->param;
  if (order->action != Action::Nop) ordered_ = order->action;
  voice(Told::Mode).seq = order->seq;  // the same as often as it is said
  say(Told::Mode, m, 0, now);
}

void EyebotDriver::say_heartbeat(TimeNs now) noexcept {
  if (voice(Told::Heartbeat).size != 0 && now - voice(Told::Heartbeat).said_ns < kBeat) return;
  own_heartbeat_.uptime_ms = (now - started_ns_) / hal::kNsPerMs;
  say(Told::Heartbeat, own_heartbeat_, 0, now);
}

}  // namespace tandem::bridges::eyebot
