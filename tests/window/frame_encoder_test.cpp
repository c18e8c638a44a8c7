#include "window/frame_encoder.hpp"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <numbers>

namespace tandem::window {
namespace {

using hal::Json;

template <class T>
T read_at(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Two robots: one with three LEDs and two values that move it, one without.
Frame two_robots(std::uint32_t members_number = 1) {
  auto members = std::make_shared<FrameMembers>();
  members->number = members_number;
  members->json = {{"ids", {"a", "b"}}};
  members->first_led = {0, 3, 3};
  members->first_value = {0, 2, 2};
  Frame frame;
  frame.tick = 42;
  frame.time_s = 4.2;
  frame.members = members;
  frame.x_m = {1.5, -2.0};
  frame.y_m = {0.25, 3.0};
  frame.cos_h = {0.0, 1.0};
  frame.sin_h = {1.0, 0.0};
  frame.z_m = {0.0F, 1.2345F};
  frame.values = {0.0F, -1.25F};
  frame.leds = {hal::kBlack, hal::kRed, hal::kBlack};
  return frame;
}

std::vector<Message> update(FrameEncoder& encoder, ViewerState& viewer, const std::vector<std::uint32_t>& layers = {}) {
  std::vector<Message> messages;
  encoder.update(viewer, layers, messages);
  return messages;
}

/// The first letters or the number of the type of each.
std::string types_of(const std::vector<Message>& messages) {
  std::string types;
  for (const Message& message : messages) {
    types += types.empty() ? "" : " ";
    types += message.binary ? std::to_string(read_at<std::uint32_t>(*message.bytes, 0))
                            : hal::parse_json(*message.bytes).value()["type"].get<std::string>();
  }
  return types;
}

TEST(FrameEncoder, HeadingsAreWithinOneStepOfTheExactAngle) {
  for (int i = -18000; i <= 18000; ++i) {
    const double angle = i * std::numbers::pi / 18000.0;
    const auto exact = static_cast<std::int64_t>(std::llround(angle / (2.0 * std::numbers::pi) * 65536.0));
    const auto off = static_cast<std::int16_t>(turns_of(std::cos(angle), std::sin(angle)) - exact);
    EXPECT_LE(std::abs(off), 1) << angle;
  }
}

TEST(FrameEncoder, PosesAreSixteenBytesARobotBehindThirtyTwo) {
  FrameEncoder encoder("");
  encoder.take(two_robots());
  ViewerState viewer;
  const auto messages = update(encoder, viewer);
  EXPECT_EQ(types_of(messages), "members marks 2 4 1");
  const std::string& poses = *messages.back().bytes;
  ASSERT_EQ(poses.size(), 32U + 2U * 16U);
  EXPECT_EQ(read_at<std::uint32_t>(poses, 4), 1U);
  EXPECT_EQ(read_at<std::int64_t>(poses, 8), 42);
  EXPECT_EQ(read_at<std::uint32_t>(poses, 16), 2U);
  EXPECT_EQ(read_at<std::uint32_t>(poses, 20), 1U);
  EXPECT_EQ(read_at<double>(poses, 24), 4.2);
  EXPECT_EQ(read_at<float>(poses, 32), 1.5F);
  EXPECT_EQ(read_at<float>(poses, 36), 0.25F);
  EXPECT_EQ(read_at<std::uint16_t>(poses, 40), 0U);
  EXPECT_EQ(read_at<std::uint16_t>(poses, 42), 16384U);
  EXPECT_EQ(read_at<std::uint16_t>(poses, 44), 0xF800U);
  EXPECT_EQ(read_at<std::uint16_t>(poses, 46), 0U);
  EXPECT_EQ(read_at<std::uint16_t>(poses, 56), 1235U);
  EXPECT_EQ(read_at<std::uint16_t>(poses, 60), 0U);
}

TEST(FrameEncoder, HeightsAboveTheirRangeAreSaidToBe) {
  FrameEncoder encoder("");
  Frame frame = two_robots();
  frame.z_m = {70.0F, -1.0F};
  encoder.take(std::move(frame));
  ViewerState viewer;
  const auto messages = update(encoder, viewer);
  EXPECT_EQ(read_at<std::uint16_t>(*messages.back().bytes, 40), 65535U);
  EXPECT_EQ(read_at<std::uint16_t>(*messages.back().bytes, 56), 0U);
}

TEST(FrameEncoder, LeanIsSentOfEverybody) {
  FrameEncoder encoder("");
  Frame frame = two_robots();
  const double half = 0.5 * 0.25 * std::numbers::pi;  // of a roll by 45 degrees
  frame.q_WB = {{1.0F, 0.0F, 0.0F, 0.0F},
                {static_cast<float>(std::cos(half)), static_cast<float>(std::sin(half)), 0.0F, 0.0F}};
  encoder.take(std::move(frame));
  ViewerState viewer;
  const auto messages = update(encoder, viewer);
  EXPECT_EQ(read_at<std::int8_t>(*messages.back().bytes, 32 + 16 + 14), 64);
  EXPECT_EQ(read_at<std::int8_t>(*messages.back().bytes, 32 + 16 + 15), 0);
}

TEST(FrameEncoder, LedsAreSentOnceAndWhenTheyChangeAlsoToWhoMissedFrames) {
  FrameEncoder encoder("");
  ViewerState fast, slow;
  encoder.take(two_robots());
  const auto first = update(encoder, fast);
  update(encoder, slow);
  ASSERT_EQ(types_of(first), "members marks 2 4 1");
  ASSERT_EQ(first[2].bytes->size(), 32U + 8U);
  EXPECT_EQ(read_at<std::uint32_t>(*first[2].bytes, 32), 0U);
  EXPECT_EQ(read_at<std::uint8_t>(*first[2].bytes, 36), 1U);
  EXPECT_EQ(read_at<std::uint8_t>(*first[2].bytes, 37), 255U);

  const auto same_members = encoder.frame().members;
  const auto next = [&](hal::Rgb led0) {
    Frame frame = two_robots();
    frame.members = same_members;
    frame.leds = {led0, hal::kRed, hal::kBlack};
    encoder.take(std::move(frame));
  };
  next(hal::kBlack);
  EXPECT_EQ(types_of(update(encoder, fast)), "1");
  next(hal::kGreen);
  EXPECT_EQ(types_of(update(encoder, fast)), "2 1");
  next(hal::kGreen);
  EXPECT_EQ(types_of(update(encoder, fast)), "1");
  const auto late = update(encoder, slow);  // missed the frame with the change
  EXPECT_EQ(types_of(late), "2 1");
  EXPECT_EQ(late[0].bytes->size(), 32U + 8U);
  EXPECT_EQ(types_of(update(encoder, slow)), "");
}

TEST(FrameEncoder, WhatMovesOnRobotsIsSentOnceAndWhenItChanges) {
  FrameEncoder encoder("");
  ViewerState fast, slow;
  encoder.take(two_robots());
  const auto first = update(encoder, fast);
  ASSERT_EQ(types_of(first), "members marks 2 4 1");
  const std::string& values = *first[3].bytes;
  ASSERT_EQ(values.size(), 32U + 12U) << "the other one is 0, as all are at first";
  EXPECT_EQ(read_at<std::uint32_t>(values, 32), 0U);
  EXPECT_EQ(read_at<std::uint32_t>(values, 36), 1U);
  EXPECT_EQ(read_at<float>(values, 40), -1.25F);

  const auto same_members = encoder.frame().members;
  const auto next = [&](float value) {
    Frame frame = two_robots();
    frame.members = same_members;
    frame.values[1] = value;
    encoder.take(std::move(frame));
  };
  next(-1.25F);
  EXPECT_EQ(types_of(update(encoder, fast)), "1");
  next(0.5F);
  EXPECT_EQ(types_of(update(encoder, fast)), "4 1");
  next(0.0F);
  const auto back = update(encoder, fast);
  ASSERT_EQ(types_of(back), "4 1");
  EXPECT_EQ(read_at<float>(*back[0].bytes, 40), 0.0F) << "what became 0 again is told";
  EXPECT_EQ(types_of(update(encoder, slow)), "members marks 2 4 1");
}

TEST(FrameEncoder, NewMembersAreTellingTheirLedsAnew) {
  FrameEncoder encoder("");
  ViewerState viewer;
  encoder.take(two_robots(1));
  update(encoder, viewer);
  encoder.take(two_robots(2));
  EXPECT_EQ(types_of(update(encoder, viewer)), "members marks 2 4 1");
}

TEST(FrameEncoder, ObjectsAreSentWhenTheyMoved) {
  FrameEncoder encoder("&token=t");
  ViewerState viewer, slow;
  const auto scene = std::make_shared<FrameScene>();
  scene->number = 1;
  scene->json = {{"objects", Json::array()}};
  scene->floor = std::make_shared<const core::FloorImage>();
  const auto show = [&](double x_m) {
    Frame frame;
    frame.scene = scene;
    frame.objects = {{0, x_m, 0.0, 0.0, 0.0}, {4, 1.0, 2.0, 0.0, 0.0}};
    encoder.take(std::move(frame));
    return update(encoder, viewer);
  };
  const auto first = show(0.0);
  EXPECT_EQ(types_of(first), "scene marks objects 1");
  EXPECT_EQ(hal::parse_json(*first[0].bytes).value()["floor"], "/floor.png?v=1&token=t");
  EXPECT_EQ(hal::parse_json(*first[2].bytes).value()["poses"].size(), 2U);
  EXPECT_EQ(types_of(show(0.0)), "1");
  const auto moved = show(0.5);
  EXPECT_EQ(types_of(moved), "objects 1");
  EXPECT_EQ(hal::to_text(hal::parse_json(*moved[0].bytes).value()["poses"]), "[[0,0.5,0.0,0.0,0.0]]");
}

TEST(FrameEncoder, LayersGoToWhoLooksAtThem) {
  FrameEncoder encoder("");
  ViewerState viewer, other;
  Frame frame = two_robots();
  frame.layers.push_back({3, {core::Segment{}}, Json::array({{{"text", "hello"}}})});
  encoder.take(std::move(frame));
  const auto messages = update(encoder, viewer, {3});
  EXPECT_EQ(types_of(messages), "members marks 2 4 1 3 texts");
  EXPECT_EQ(messages[5].bytes->size(), 32U + 28U);
  EXPECT_EQ(types_of(update(encoder, other)), "members marks 2 4 1");
  EXPECT_EQ(types_of(update(encoder, viewer, {3})), "");
}

TEST(FrameEncoder, MemoryOfTheLastFrameComesBack) {
  FrameEncoder encoder("");
  Frame first = two_robots();
  const double* const memory = first.x_m.data();
  encoder.take(std::move(first));
  Frame back = encoder.take(two_robots());
  EXPECT_EQ(back.x_m.data(), memory);
  back.clear();
  EXPECT_GE(back.x_m.capacity(), 2U);
}

}  // namespace
}  // namespace tandem::window
