#include "bridges/desk/lcm_desk.hpp"

#include <condition_variable>
#include <gtest/gtest.h>
#include <mutex>

namespace tandem::bridges::desk {
namespace {

using namespace std::chrono_literals;

TEST(LcmDesk, BytesOfACommandAreThoseOfTheDocumentedType) {
  const std::vector<std::byte> bytes = encode_command({7, "anna", "{\"do\":\"arm\"}"});
  ASSERT_EQ(bytes.size(), 8U + 8U + 4U + 5U + 4U + 13U);
  EXPECT_EQ(bytes[15], std::byte{7});
  EXPECT_EQ(bytes[19], std::byte{5}) << "with the zero at its end";
  EXPECT_EQ(bytes[20], std::byte{'a'});
  const auto back = decode_command(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->number, 7);
  EXPECT_EQ(back->who, "anna");
  EXPECT_EQ(back->text, "{\"do\":\"arm\"}");
}

TEST(LcmDesk, WhatIsNoCommandIsNone) {
  const std::vector<std::byte> good = encode_command({1, "anna", "{}"});
  for (std::size_t size = 0; size < good.size(); ++size) EXPECT_FALSE(decode_command({good.data(), size})) << size;
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::vector<std::byte> bad = good;
    bad[at] = std::byte{0xFF};
    const auto read = decode_command(bad);
    EXPECT_TRUE(!read || read->who.size() <= kLongestWho) << at;
  }
  EXPECT_FALSE(decode_command(encode_command({1, std::string(65, 'a'), "{}"})));
  EXPECT_FALSE(decode_command(encode_command({1, "", "{}"}))) << "nobody";
  EXPECT_FALSE(decode_command(encode_reply({1, "anna", "{}"}))) << "of another type";
}

TEST(LcmDesk, AnswersWhoeverAskedOnTheChannelBesideItsOwn) {
  auto opened = lcm_bus::LcmLink::open("memq://");
  ASSERT_TRUE(opened.ok());
  const std::shared_ptr<lcm_bus::LcmLink> link = std::move(opened).value();
  std::mutex lock;
  std::condition_variable came;
  std::vector<DeskMessage> replies;
  ASSERT_TRUE(link->subscribe("lab\\.desk/reply",
                              [&](const lcm_bus::LcmMessage& message) {
                                const std::lock_guard hold(lock);
                                if (const auto reply = decode_reply(message.data)) replies.push_back(*reply);
                                came.notify_all();
                              })
                  .ok());
  auto desk = LcmDesk::open(link, "lab.desk", [](const DeskMessage& message, const LcmDesk::Reply& reply) {
    reply("{\"ok\":true,\"echo\":" + message.text + "}");
  });
  ASSERT_TRUE(desk.ok());
  const std::vector<std::byte> command = encode_command({42, "ben", "{\"do\":\"estop\"}"});
  (void)link->publish("lab.desk", std::vector<std::byte>(5));
  (void)link->publish("labXdesk", command);
  (void)link->publish("lab.desk", command);
  std::unique_lock hold(lock);
  ASSERT_TRUE(came.wait_for(hold, 10s, [&] { return !replies.empty(); }));
  ASSERT_EQ(replies.size(), 1U);
  EXPECT_EQ(replies[0].number, 42);
  EXPECT_EQ(replies[0].who, "ben");
  EXPECT_EQ(replies[0].text, "{\"ok\":true,\"echo\":{\"do\":\"estop\"}}");
  EXPECT_EQ(desk.value()->malformed(), 1U);
}

}  // namespace
}  // namespace tandem::bridges::desk
