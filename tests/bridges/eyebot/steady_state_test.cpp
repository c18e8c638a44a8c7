// After its first messages the driver allocates nothing, whatever is said and told.
#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <new>

#include "hal/device/flight.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "tests/bridges/eyebot/scripted_robot.hpp"

namespace {

std::atomic<bool> counting{false};
std::atomic<std::uint64_t> allocations{0};

}  // namespace

// GCC cannot see that both sides are malloc and free.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

void* operator new(std::size_t size) {
  if (counting) ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace tandem::bridges::eyebot {
namespace {

class Counter final : public Outbox {
 public:
  bool publish(const std::string&, std::span<const std::byte>) noexcept override {
    ++said;
    return true;
  }
  std::uint64_t said = 0;
};

template <class Message>
std::vector<std::byte> bytes_of(Message message) {
  message.hdr.session = 77;
  std::vector<std::byte> buffer(messages::kMostBytes);
  const auto written = messages::encode(message, buffer);
  return {written.begin(), written.end()};
}

/// Delivers the message with another number and time.
void deliver(Inbox& inbox, Topic topic, std::vector<std::byte>& bytes, std::uint8_t seq, hal::TimeNs now) {
  bytes[19] = std::byte{seq};
  for (std::size_t i = 0; i < 8; ++i) bytes[15 - i] = static_cast<std::byte>(now / 1000 >> (8 * i) & 0xFF);
  inbox.deliver(topic, bytes, now);
}

TEST(EyebotDriver, AllocatesNothingInItsSteadyState) {
  Inbox inbox;
  Counter outbox;
  DriverSettings settings;
  settings.controlled = true;
  EyebotDriver driver(settings, inbox, outbox);
  for (const hal::PortType* type : port_types()) (void)driver.robot().require(*type);
  auto& speed = driver.robot().actuator<hal::QuadrotorSpeed>();
  auto& leds = driver.robot().actuator<hal::RingLeds>();
  auto& radio = driver.robot().actuator<hal::RangeAndBearingSend>();

  messages::Heartbeat heartbeat{};
  heartbeat.name = "a name that is longer than a small string";
  heartbeat.proto_major = 1;
  heartbeat.period_ms = 200;
  messages::Status status{};
  status.mode = messages::Status::MODE_VELOCITY;
  status.text = "words that are longer than a small string holds";
  messages::State state{};
  state.quat[0] = 1.0;
  state.pos_valid = 1;
  messages::Rab rab{};
  rab.n = 20;
  rab.pkt.resize(20);
  for (auto& p : rab.pkt) {
    p.len = 10;
    p.data.resize(10);
  }
  messages::Scan scan{};
  scan.n = 40;
  scan.sensor.resize(40);
  scan.dt_us.resize(40);
  scan.angle.resize(40);
  scan.range.resize(40);
  messages::Blobs blobs{};
  blobs.n = 30;
  blobs.blob.resize(30);
  auto h = bytes_of(heartbeat), s = bytes_of(status), p = bytes_of(state), r = bytes_of(rab), c = bytes_of(scan),
       b = bytes_of(blobs);
  hal::TimeNs now = 1000 * hal::kNsPerSecond;
  std::uint8_t seq = 0;
  const auto tick = [&] {
    now += 50 * kMs;
    ++seq;
    deliver(inbox, Topic::Heartbeat, h, seq, now);
    deliver(inbox, Topic::Status, s, seq, now);
    deliver(inbox, Topic::State, p, seq, now);
    deliver(inbox, Topic::Rab, r, seq, now);
    deliver(inbox, Topic::Scan, c, seq, now);
    deliver(inbox, Topic::Blobs, b, seq, now);
    driver.pump(now);
    driver.latch(seq, now);
    speed.set(0.01 * seq, 0.0, 0.0, 0.0);
    leds.rgb[0] = seq;
    radio.sending = true;
    radio.size = static_cast<std::uint8_t>(seq % 11);
    driver.commit(now);
  };
  for (int i = 0; i < 60; ++i) tick();
  const std::uint64_t said = outbox.said;
  counting = true;
  for (int i = 0; i < 60; ++i) tick();
  counting = false;
  EXPECT_EQ(allocations, 0U);
  EXPECT_GE(outbox.said - said, 180U);  // it did fly, shine and talk
  EXPECT_EQ(driver.state(), RobotState::Active);
}

}  // namespace
}  // namespace tandem::bridges::eyebot
