// The emulated radio of an e-puck2, told by hand what a host sends.
#include "bridges/epuck_emulator/radio.hpp"

#include <gmock/gmock.h>

#include "tests/bridges/epuck_emulator/held_body.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr hal::TimeNs kMs = hal::kNsPerMs;

/// 80, what, flags, left, right, leds, colours, sound.
Bytes command(std::uint8_t what, std::uint8_t left, std::uint8_t left_high = 0) {
  Bytes bytes(21, 0);
  bytes[0] = 0x80;
  bytes[1] = what;
  bytes[3] = left;
  bytes[4] = left_high;
  return bytes;
}

struct Rig {
  Rig() : firmware({.variant = Variant::Epuck2, .selector = 15}, body, {}), radio(firmware) { firmware.power_on(0); }
  void say(const Bytes& bytes) {
    for (const std::uint8_t byte : bytes) radio.receive(byte, now);
  }
  Bytes hear(hal::TimeNs duration) {
    Bytes all;
    for (const hal::TimeNs end = now + duration; now < end;) {
      now += kMs;
      radio.run_until(now);
      std::vector<SentByte> sent;
      radio.take_sent(now, sent);
      for (const SentByte& s : sent) all.push_back(s.byte);
    }
    return all;
  }
  hal::TimeNs now = hal::kNsPerSecond;
  HeldBody body;
  Firmware firmware;
  Radio radio;
};

TEST(Radio, SaysNothingBeforeTheFirstCommand) {
  Rig rig;
  EXPECT_TRUE(rig.hear(hal::kNsPerSecond).empty());
}

TEST(Radio, ObeysACommandAndTellsAllSensors) {
  Rig rig;
  rig.say(command(2, 0xF4, 1));
  const Bytes told = rig.hear(20 * kMs);
  EXPECT_NEAR(rig.body.command().left_m_s, 500 * 0.1288e-3, 1e-5);
  EXPECT_EQ(rig.body.command().right_m_s, 0.0);
  ASSERT_EQ(told.size(), 105U);
  EXPECT_EQ(told[0], 2);
  EXPECT_EQ(told[1 + 89], 15) << "the selector";
  EXPECT_EQ(told[1 + 4] | told[1 + 5] << 8, 800) << "1 g upwards, calibrated";
}

TEST(Radio, GoesOnTellingWithoutFurtherCommandsAndTheRobotGoesOnDriving) {
  Rig rig;
  rig.say(command(2, 100));
  const Bytes told = rig.hear(hal::kNsPerSecond);
  EXPECT_EQ(told.size() % 105, 0U);
  EXPECT_GT(told.size() / 105, 20U);
  EXPECT_LT(told.size() / 105, 90U);
  rig.radio.new_host();
  EXPECT_TRUE(rig.hear(200 * kMs).empty()) << "the next host has said nothing yet";
  EXPECT_GT(rig.body.command().left_m_s, 0.0);
}

TEST(Radio, SendsImagesAndEmptyPacketsAsAsked) {
  Rig rig;
  rig.say(command(0, 0));
  EXPECT_EQ(rig.hear(15 * kMs), Bytes{3});
  Rig camera;
  camera.say(command(1, 0));
  const Bytes image = camera.hear(15 * kMs);
  ASSERT_EQ(image.size(), 38401U);
  EXPECT_EQ(image[0], 1);
}

TEST(Radio, ObeysWhatIsOutOfStep) {
  Rig rig;
  rig.say(command(2, 0));
  rig.hear(50 * kMs);
  Bytes shifted = command(2, 0);
  rig.say(Bytes(shifted.begin() + 3, shifted.end()));  // three bytes are missing
  rig.say(command(2, 0));
  rig.say(command(2, 0));
  rig.hear(100 * kMs);
  EXPECT_NE(rig.body.command().rgb, (std::array<std::uint8_t, 12>{})) << "a head among the colours";
}

TEST(Radio, ForgetsWhatAHostHadSentInPart) {
  Rig rig;
  rig.say({0x80, 2, 0, 1, 1});
  rig.radio.new_host();
  rig.say(command(2, 0xF4, 1));
  rig.hear(20 * kMs);
  EXPECT_NEAR(rig.body.command().left_m_s, 500 * 0.1288e-3, 1e-5);
}

}  // namespace
}  // namespace tandem::bridges::epuck_emulator
