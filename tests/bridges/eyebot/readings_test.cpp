#include "bridges/eyebot/readings.hpp"

#include <cmath>
#include <gmock/gmock.h>

#include "hal/device/distance_scanner.hpp"
#include "hal/robot/eyebot.hpp"

namespace tandem::bridges::eyebot {
namespace {

namespace messages = eyebot_messages;
using testing::Each;
using testing::ElementsAre;
using testing::FloatEq;

const double kRight = std::acos(0.0);

TEST(WorldFrame, TurnsAndShiftsThereAndBack) {
  const WorldFrame world = {{1.0, 2.0, 3.0}, kRight};
  const Vector run = world.place_in_run({1.0, 0.0, 0.5});
  EXPECT_NEAR(run[0], 1.0, 1e-12);
  EXPECT_NEAR(run[1], 3.0, 1e-12);
  EXPECT_NEAR(run[2], 3.5, 1e-12);
  const Vector back = world.place_of_robot(run);
  EXPECT_NEAR(back[0], 1.0, 1e-12);
  EXPECT_NEAR(back[1], 0.0, 1e-12);
  EXPECT_NEAR(back[2], 0.5, 1e-12);
  EXPECT_NEAR(world.heading_of_robot(-kRight - 0.5), 2.0 * kRight - 0.5, 1e-12);
}

TEST(WorldFrame, TurnsOrientationsAndGivesThemLengthOne) {
  const WorldFrame world = {{}, kRight};
  const Quaternion q = world.orientation_in_run({1.05, 0.0, 0.0, 0.0});
  EXPECT_NEAR(q[0], std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(q[3], std::sqrt(0.5), 1e-12);
  const Vector ahead = turned(q, {1.0, 0.0, 0.0});
  EXPECT_NEAR(ahead[0], 0.0, 1e-12);
  EXPECT_NEAR(ahead[1], 1.0, 1e-12);
  // Lying on its left side, its z axis turns about the world's -y: a yaw rate of the body is none of the world.
  const Quaternion lying = {std::sqrt(0.5), -std::sqrt(0.5), 0.0, 0.0};
  EXPECT_NEAR(turned(lying, {0.0, 0.0, 1.0})[2], 0.0, 1e-12);
  EXPECT_NEAR(turned(lying, {0.0, 0.0, 1.0})[1], 1.0, 1e-12);
}

TEST(EyebotReadings, ProximityIsTurnedIntoDistance) {
  messages::Prox m{};
  m.proximity[0] = 1.0F;
  m.proximity[1] = 0.25F;
  m.proximity[2] = 7.0F;
  hal::Proximity port;
  read(m, hal::eyebot::kind(), port);
  EXPECT_EQ(port.count, 24U);
  EXPECT_EQ(port.range_m, 3.0F);
  EXPECT_EQ(port.distance_m[0], 0.0F);
  EXPECT_EQ(port.distance_m[1], 2.25F);
  EXPECT_EQ(port.distance_m[2], 0.0F);
  EXPECT_EQ(port.distance_m[23], 3.0F);
}

TEST(EyebotReadings, AnUnknownChargeComesFromTheVoltage) {
  messages::Battery m{};
  m.voltage = 11.25F;
  m.charge = -1.0F;
  hal::Battery port;
  read(m, hal::eyebot::kind(), port);
  EXPECT_FLOAT_EQ(port.charge, 0.5F);
  EXPECT_EQ(port.supply_V, 11.25F);
  m.charge = 0.75F;
  read(m, hal::eyebot::kind(), port);
  EXPECT_EQ(port.charge, 0.75F);
  m.charge = -1.0F;
  m.voltage = 3.0F;
  read(m, hal::eyebot::kind(), port);
  EXPECT_EQ(port.charge, 0.0F);
}

void add_sample(messages::Scan& m, std::uint8_t head, float angle, float range) {
  ++m.n;
  m.sensor.push_back(head);
  m.dt_us.push_back(0);
  m.angle.push_back(angle);
  m.range.push_back(range);
}

TEST(EyebotReadings, AScanIsSortedByHeads) {
  messages::Scan m{};
  m.head_angle = 0.5F;
  add_sample(m, 0, 0.1F, 0.2F);
  add_sample(m, 1, 1.6F, -1.0F);
  add_sample(m, 2, 3.1F, -2.0F);
  add_sample(m, 0, 0.2F, 99.0F);
  add_sample(m, 9, 0.0F, 1.0F);  // there is no such head
  hal::DistanceScanner port;
  read(m, hal::eyebot::kind(), port);
  EXPECT_EQ(port.samples, 2U);
  EXPECT_EQ(port.count, 8U);
  EXPECT_EQ(port.turn_rad, 0.5F);
  EXPECT_EQ(port.angle(0, 0), 0.1F);
  EXPECT_EQ(port.distance(0, 0), 0.2F);
  EXPECT_TRUE(port.sees_nothing(0, 1));
  EXPECT_TRUE(port.too_near(1, 0));
  EXPECT_EQ(port.distance(1, 0), static_cast<float>(hal::eyebot::kind().part<hal::ScannerPart>()->heads[0].min_m));
  EXPECT_TRUE(port.sees_nothing(1, 1));
  EXPECT_TRUE(port.sees_nothing(2, 0));
  EXPECT_TRUE(port.sees_nothing(3, 0));
}

TEST(EyebotReadings, OfALongScanTheNewestSamplesCount) {
  messages::Scan m{};
  for (int i = 0; i < 10; ++i) add_sample(m, 1, 0.1F * static_cast<float>(i), 0.5F + 0.05F * static_cast<float>(i));
  hal::DistanceScanner port;
  read(m, hal::eyebot::kind(), port);
  ASSERT_EQ(port.samples, hal::DistanceScanner::kSamples);
  EXPECT_THAT(port.distance(1, 0), FloatEq(0.7F));
  EXPECT_THAT(port.distance(1, 5), FloatEq(0.95F));
  messages::Scan none{};
  read(none, hal::eyebot::kind(), port);
  EXPECT_EQ(port.count, 0U);
}

messages::Blob blob(float x, float range, std::uint8_t red) {
  messages::Blob b{};
  b.x = x;
  b.range = range;
  b.rgb[0] = red;
  return b;
}

TEST(EyebotReadings, BlobsComeNearestFirstAndUnknownOnesLast) {
  messages::Blobs m{};
  m.width = 640;
  m.height = 480;
  m.blob = {blob(1.0F, 2.0F, 10), blob(2.0F, -1.0F, 20), blob(3.0F, 1.0F, 30), blob(4.0F, 2.0F, 40)};
  m.n = 4;
  hal::PerspectiveCamera port;
  read(m, port);
  ASSERT_EQ(port.count, 4U);
  EXPECT_EQ(port.width_px, 640U);
  EXPECT_THAT(std::vector<float>(port.x_px.begin(), port.x_px.begin() + 4), ElementsAre(3.0F, 1.0F, 4.0F, 2.0F));
  EXPECT_EQ(port.color(0).r, 30);
  read(m, port);
  EXPECT_EQ(port.count, 4U);  // those of before are gone
}

TEST(EyebotReadings, TheFarthestBlobsAreDropped) {
  messages::Blobs m{};
  for (int i = 0; i < 70; ++i) m.blob.push_back(blob(static_cast<float>(i), static_cast<float>(100 - i), 0));
  m.n = 70;
  hal::PerspectiveCamera port;
  read(m, port);
  EXPECT_EQ(port.count, 64U);
  EXPECT_EQ(port.dropped, 6U);
  EXPECT_EQ(port.x_px[0], 69.0F);
  EXPECT_EQ(port.x_px[63], 6.0F);
}

TEST(EyebotReadings, LongPacketsAreCut) {
  messages::Rab m{};
  m.n = 1;
  m.pkt.resize(1);
  m.pkt[0].data.assign(127, 9);
  m.pkt[0].len = 127;
  m.pkt[0].range = 1.0F;
  hal::RangeAndBearing port;
  add(m, port);
  ASSERT_EQ(port.count, 1U);
  EXPECT_EQ(port.size[0], hal::kRabPayloadMax);
}

TEST(EyebotReadings, NoEchoIsNoEcho) {
  messages::Altitude m{};
  m.ground = -7.0F;
  m.ceiling = 1.5F;
  hal::Altimeter port;
  read(m, port);
  EXPECT_EQ(port.ground_m, -1.0F);
  EXPECT_EQ(port.ceiling_m, 1.5F);
}

TEST(EyebotCommands, LightsThatNobodyCommandsAreNotDriven) {
  hal::CameraLed camera;
  camera.set(hal::kGreen);
  messages::Leds m{};
  m.upper[3][1] = 200;
  write(nullptr, nullptr, &camera, m);
  EXPECT_EQ(m.rings, 4);
  EXPECT_EQ(m.upper[3][1], 0);
  EXPECT_EQ(m.beacon[1], 255);
}

}  // namespace
}  // namespace tandem::bridges::eyebot
