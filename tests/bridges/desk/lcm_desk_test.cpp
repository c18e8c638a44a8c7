#include "bridges/desk/lcm_desk.hpp"

#include <condition_variable>
#include <gtest/gtest.h>
#include <mutex>
#include <sys/stat.h>
#include <unistd.h>

namespace tandem::bridges::desk {
namespace {

using namespace std::chrono_literals;

TEST(LcmDesk, BytesOfACommandAreThoseOfTheDocumentedType) {
  const std::vector<std::byte> bytes = encode_command({7, "anna", "{\"do\":\"arm\"}", "ab", "0123"});
  ASSERT_EQ(bytes.size(), 8U + 8U + 4U + 5U + 4U + 13U + 4U + 3U + 4U + 5U);
  EXPECT_EQ(bytes[15], std::byte{7});
  EXPECT_EQ(bytes[19], std::byte{5}) << "with the zero at its end";
  EXPECT_EQ(bytes[20], std::byte{'a'});
  const auto back = decode_command(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->number, 7);
  EXPECT_EQ(back->who, "anna");
  EXPECT_EQ(back->text, "{\"do\":\"arm\"}");
  EXPECT_EQ(back->run, "ab");
  EXPECT_EQ(back->proof, "0123");
}

TEST(LcmDesk, WhatIsNoCommandIsNone) {
  const std::vector<std::byte> good = encode_command({1, "anna", "{}", "run", "proof"});
  for (std::size_t size = 0; size < good.size(); ++size) EXPECT_FALSE(decode_command({good.data(), size})) << size;
  for (std::size_t at = 0; at < good.size(); ++at) {
    std::vector<std::byte> bad = good;
    bad[at] = std::byte{0xFF};
    const auto read = decode_command(bad);
    EXPECT_TRUE(!read || read->who.size() <= kLongestWho) << at;
  }
  EXPECT_FALSE(decode_command(encode_command({1, std::string(65, 'a'), "{}", "", ""})));
  EXPECT_FALSE(decode_command(encode_command({1, "", "{}", "", ""}))) << "nobody";
  EXPECT_FALSE(decode_command(encode_reply({1, "anna", "{}", "", ""}))) << "of another type";
}

TEST(DeskKeys, AreReadByTheLine) {
  auto keys =
      parse_keys("# the laboratory\nanna operator 0123456789abcdef\n\n  ben\tviewer fedcba9876543210  # guest\n");
  ASSERT_TRUE(keys.ok()) << keys.error().message;
  ASSERT_EQ(keys->size(), 2U);
  EXPECT_EQ(keys.value()[0].who, "anna");
  EXPECT_EQ(keys.value()[0].role, hal::UserRole::Operator);
  EXPECT_EQ(keys.value()[1].role, hal::UserRole::Viewer);
  EXPECT_EQ(keys.value()[1].secret, "fedcba9876543210");
  EXPECT_EQ(key_of(keys.value(), "carl"), nullptr);
  EXPECT_EQ(key_of(keys.value(), "ben")->who, "ben");
}

TEST(DeskKeys, OfAnybodyAreForThoseWhoHaveNoneOfTheirOwn) {
  auto keys = parse_keys("* viewer 0123456789abcdef\nanna operator fedcba9876543210");
  ASSERT_TRUE(keys.ok());
  EXPECT_EQ(key_of(keys.value(), "anna")->role, hal::UserRole::Operator);
  EXPECT_EQ(key_of(keys.value(), "ben")->role, hal::UserRole::Viewer);
}

TEST(DeskKeys, WhatIsWrongIsSaidWithItsLine) {
  const auto why = [](const char* text) {
    auto keys = parse_keys(text);
    return keys.ok() ? "" : keys.error().message;
  };
  EXPECT_EQ(why("anna operator"), "line 1: a line is NAME ROLE SECRET");
  EXPECT_EQ(why("anna operator 0123456789abcdef more"), "line 1: a line is NAME ROLE SECRET");
  EXPECT_EQ(why("\nanna king 0123456789abcdef"), "line 2: 'king' is no role; there are operator and viewer");
  EXPECT_NE(why("anna operator secret").find("is short"), std::string::npos);
  EXPECT_NE(why("a viewer 0123456789abcdef\na viewer 0123456789abcdef").find("'a' has a key already"),
            std::string::npos);
  EXPECT_NE(why("# nobody\n").find("no key"), std::string::npos);
}

TEST(DeskKeys, ThatOthersMayReadAreRefused) {
  std::string path = testing::TempDir() + "desk_keys_XXXXXX";
  const int fd = mkstemp(path.data());
  ASSERT_GE(fd, 0);
  ASSERT_EQ(::write(fd, "a viewer 0123456789abcdef\n", 26), 26);
  EXPECT_TRUE(read_keys(path).ok());
  ASSERT_EQ(::fchmod(fd, 0640), 0);
  EXPECT_NE(read_keys(path).error().message.find("others may read them"), std::string::npos);
  ::close(fd);
  ::unlink(path.c_str());
}

/// A run's desk and whoever else is on its network.
class Network : public testing::Test {
 protected:
  Network() {
    auto opened = lcm_bus::LcmLink::open("memq://");
    link_ = std::move(opened).value();
    EXPECT_TRUE(link_
                    ->subscribe("lab\\.desk/reply",
                                [this](const lcm_bus::LcmMessage& message) {
                                  const std::lock_guard hold(lock_);
                                  if (const auto reply = decode_reply(message.data)) replies_.push_back(*reply);
                                  came_.notify_all();
                                })
                    .ok());
    auto desk =
        LcmDesk::open(link_, "lab.desk",
                      {{"ben", hal::UserRole::Operator, kSecret}, {"eve", hal::UserRole::Viewer, "another one of eve"}},
                      [this](const DeskMessage& message, hal::UserRole role, const LcmDesk::Reply& reply) {
                        taken_.push_back(message.text);
                        roles_.push_back(role);
                        reply("{\"ok\":true,\"echo\":" + message.text + "}");
                      });
    desk_ = std::move(desk).value();
  }
  /// The answer to it.
  DeskMessage say(const DeskMessage& command) {
    const std::size_t before = [&] {
      const std::lock_guard hold(lock_);
      return replies_.size();
    }();
    (void)link_->publish("lab.desk", encode_command(command));
    std::unique_lock hold(lock_);
    EXPECT_TRUE(came_.wait_for(hold, 10s, [&] { return replies_.size() > before; }));
    return replies_.size() > before ? replies_[before] : DeskMessage{};
  }
  std::string word_of_run() { return say({1, "ben", "{}", "", ""}).run; }
  static DeskMessage proved(DeskMessage m, const std::string& secret = kSecret, const char* channel = "lab.desk") {
    m.proof = proof_of(secret, Way::Command, channel, m.run, m.number, m.who, m.text);
    return m;
  }
  static constexpr const char* kSecret = "what ben alone knows";

  std::shared_ptr<lcm_bus::LcmLink> link_;
  std::mutex lock_;
  std::condition_variable came_;
  std::vector<DeskMessage> replies_;
  std::vector<std::string> taken_;  // of the link's thread, which is done when its reply has come
  std::vector<hal::UserRole> roles_;
  std::unique_ptr<LcmDesk> desk_;
};

TEST_F(Network, WhoProvesItsKeyIsAnsweredOnTheChannelBesideItsOwn) {
  (void)link_->publish("lab.desk", std::vector<std::byte>(5));
  (void)link_->publish("labXdesk", encode_command({1, "ben", "{}", "", ""}));
  const std::string run = word_of_run();
  EXPECT_EQ(run.size(), 32U);
  EXPECT_TRUE(taken_.empty());
  const DeskMessage reply = say(proved({42, "ben", "{\"do\":\"estop\"}", run, ""}));
  EXPECT_EQ(reply.number, 42);
  EXPECT_EQ(reply.who, "ben");
  EXPECT_EQ(reply.text, "{\"ok\":true,\"echo\":{\"do\":\"estop\"}}");
  EXPECT_EQ(reply.proof, proof_of(kSecret, Way::Reply, "lab.desk", run, 42, "ben", reply.text));
  EXPECT_EQ(roles_, (std::vector{hal::UserRole::Operator}));
  EXPECT_EQ(desk_->malformed(), 1U);
  EXPECT_EQ(desk_->refused(), 0U);
  (void)say(proved({43, "eve", "{}", run, ""}, "another one of eve"));
  EXPECT_EQ(roles_.back(), hal::UserRole::Viewer);
}

TEST_F(Network, WhoProvesNothingIsRefused) {
  const std::string run = word_of_run();
  const DeskMessage good = proved({5, "ben", "{\"do\":\"arm\"}", run, ""});
  std::vector<DeskMessage> bad(8, good);
  bad[0].proof.clear();
  bad[1].proof.back() = bad[1].proof.back() == '0' ? '1' : '0';
  bad[2].text = "{\"do\":\"aim\"}";
  bad[3].number = 6;
  bad[4] = proved({5, "ben", "{\"do\":\"arm\"}", run, ""}, "not the secret of ben");
  bad[5] = proved({5, "ben", "{\"do\":\"arm\"}", run, ""}, kSecret, "another desk");
  bad[6] = proved({5, "carl", "{\"do\":\"arm\"}", run, ""});
  bad[7].proof = proof_of(kSecret, Way::Reply, "lab.desk", run, 5, "ben", good.text);
  for (std::size_t i = 0; i < bad.size(); ++i) {
    const DeskMessage reply = say(bad[i]);
    EXPECT_NE(reply.text.find("\"ok\":false"), std::string::npos) << i << ": " << reply.text;
    EXPECT_EQ(reply.text.find("again"), std::string::npos) << i;
  }
  EXPECT_TRUE(taken_.empty());
  EXPECT_EQ(desk_->refused(), bad.size());
}

TEST_F(Network, WhatWasOverheardCountsForNobody) {
  const DeskMessage good = proved({5, "ben", "{\"do\":\"arm\"}", word_of_run(), ""});
  EXPECT_NE(say(good).text.find("\"ok\":true"), std::string::npos);
  EXPECT_NE(say(good).text.find("was said before"), std::string::npos) << "the same again";
  const DeskMessage former = proved({6, "ben", "{\"do\":\"arm\"}", std::string(32, 'a'), ""});
  EXPECT_NE(say(former).text.find("\"again\":true"), std::string::npos) << "of a former run";
  EXPECT_EQ(taken_.size(), 1U);
}

TEST(LcmDesk, AsksWithAKeyAndBelievesNobodyElse) {
  const std::string url = "udpm://239.255.76.68:7668?ttl=0";
  const DeskKey key{"ben", hal::UserRole::Operator, "what ben alone knows"};
  auto desk =
      LcmDesk::open(url, "lab.desk", {key}, [](const DeskMessage& message, hal::UserRole, const LcmDesk::Reply& reply) {
        reply("{\"ok\":true,\"echo\":" + message.text + "}");
      });
  if (!desk.ok()) GTEST_SKIP() << desk.error().message;
  const DeskMessage command{7, "ben", "{\"do\":\"status\"}", "", ""};
  const auto answer = ask(url, "lab.desk", key, command, 30s);
  ASSERT_TRUE(answer.ok()) << answer.error().message;
  EXPECT_EQ(answer.value(), "{\"ok\":true,\"echo\":{\"do\":\"status\"}}");
  const auto refused = ask(url, "lab.desk", {"ben", hal::UserRole::Operator, "what ben has forgotten"}, command, 30s);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("does not prove to have the key of 'ben'"), std::string::npos)
      << refused.error().message;
}

}  // namespace
}  // namespace tandem::bridges::desk
