#include "bridges/lcm/lcm_link.hpp"

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <fstream>
#include <gmock/gmock.h>
#include <mutex>
#include <sched.h>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "tests/bridges/lcm/event_log.hpp"
#include "tests/bridges/lcm/witness.hpp"

namespace tandem::bridges::lcm_bus {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::span<const std::byte> bytes(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

/// What came, "channel=text"; shared with the handlers.
struct Heard {
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::string> all;

  LcmLink::Handler handler() {
    return [this](const LcmMessage& m) {
      const std::lock_guard lock(mutex);
      all.push_back(std::string(m.channel) + "=" +
                    std::string(reinterpret_cast<const char*>(m.data.data()), m.data.size()));
      changed.notify_all();
    };
  }
  std::vector<std::string> wait_for(std::size_t count) {
    std::unique_lock lock(mutex);
    changed.wait_for(lock, std::chrono::seconds(30), [&] { return all.size() >= count; });
    return all;
  }
};

std::shared_ptr<LcmLink> opened(const std::string& url) {
  auto link = LcmLink::open(url);
  EXPECT_TRUE(link.ok()) << (link.ok() ? "" : link.error().message);
  return link.ok() ? link.value() : nullptr;
}

TEST(LcmLink, CarriesMessagesInOrderToThoseWhoAskForTheirChannel) {
  Heard robot, hub;
  const auto link = opened("memq://");
  ASSERT_TRUE(link->subscribe("eyebot/eb0/.*", robot.handler()).ok());
  ASSERT_TRUE(link->subscribe("hub/[^/]+/heartbeat", hub.handler()).ok());
  ASSERT_TRUE(link->start().ok());
  ASSERT_TRUE(link->start().ok());  // the second does nothing
  EXPECT_TRUE(link->publish("eyebot/eb0/state", bytes("a")));
  EXPECT_TRUE(link->publish("eyebot/eb00/state", bytes("not for us")));
  EXPECT_TRUE(link->publish("hub/t/heartbeat", bytes("")));
  EXPECT_TRUE(link->publish("eyebot/eb0/cmd/mode", bytes("b")));
  EXPECT_THAT(robot.wait_for(2), ElementsAre("eyebot/eb0/state=a", "eyebot/eb0/cmd/mode=b"));
  EXPECT_THAT(hub.wait_for(1), ElementsAre("hub/t/heartbeat="));
  const LcmStatistics s = link->statistics();
  EXPECT_EQ(s.received, 3U);
  EXPECT_EQ(s.received_bytes, 2U);
  EXPECT_EQ(s.published, 4U);
  EXPECT_EQ(s.published_bytes, 12U);
}

TEST(LcmLink, TakesWhatItsHandlersPublish) {
  Heard heard;
  const auto link = opened("memq://");
  auto* bare = link.get();
  ASSERT_TRUE(link->subscribe("ask", [bare](const LcmMessage& m) { bare->publish("answer", m.data); }).ok());
  ASSERT_TRUE(link->subscribe("answer", heard.handler()).ok());
  ASSERT_TRUE(link->start().ok());
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(link->publish("ask", bytes(std::to_string(i))));
  const auto all = heard.wait_for(1000);
  ASSERT_EQ(all.size(), 1000U);
  EXPECT_EQ(all.back(), "answer=999");
}

TEST(LcmLink, OutlivesAHandlerThatThrows) {
  Heard heard;
  const auto link = opened("memq://");
  ASSERT_TRUE(link->subscribe("bad", [](const LcmMessage&) { throw std::runtime_error("no"); }).ok());
  ASSERT_TRUE(link->subscribe("good", heard.handler()).ok());
  ASSERT_TRUE(link->start().ok());
  ASSERT_TRUE(link->publish("bad", bytes("x")));
  ASSERT_TRUE(link->publish("good", bytes("x")));
  EXPECT_THAT(heard.wait_for(1), ElementsAre("good=x"));
  EXPECT_EQ(link->statistics().dropped, 1U);
}

TEST(LcmLink, RefusesChannelsThatLcmCannotCarry) {
  const auto link = opened("memq://");
  EXPECT_FALSE(link->publish("", bytes("x")));
  EXPECT_FALSE(link->publish(std::string(64, 'c'), bytes("x")));
  EXPECT_EQ(link->statistics().unsent, 2U);
}

TEST(LcmLink, SaysWhatIsWrongWithAUrl) {
  const auto error_of = [](const std::string& url) {
    const auto link = LcmLink::open(url);
    return link.ok() ? std::string() : link.error().message;
  };
  EXPECT_THAT(error_of("tcpq://127.0.0.1:7700"), HasSubstr("write udpm://"));
  EXPECT_THAT(error_of("239.255.76.67"), HasSubstr("write udpm://"));
  EXPECT_THAT(error_of("udpm://127.0.0.1:7667?ttl=0"), HasSubstr("'127.0.0.1' is no multicast group"));
  EXPECT_THAT(error_of("udpm://robots:7667"), HasSubstr("'robots' is no multicast group"));
}

TEST(LcmLink, SaysThatThereIsNoRoute) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {  // on a network where nothing is
    if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) ::_exit(77);
    const auto link = LcmLink::open("");
    const std::string said = link.ok() ? "it opened" : link.error().message;
    ::_exit(::write(ends[1], said.data(), said.size()) == static_cast<ssize_t>(said.size()) ? 0 : 1);
  }
  ::close(ends[1]);
  std::string said(1000, '\0');
  const ssize_t n = ::read(ends[0], said.data(), said.size());
  said.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "no network of one's own may be made here";
  EXPECT_THAT(said, HasSubstr("no route for multicast"));
  EXPECT_THAT(said, HasSubstr("udpm://239.255.76.67:7667?ttl=0"));
}

/// Run by on_loopback.sh.
class OnLoopback : public testing::Test {
 protected:
  void SetUp() override {
    if (std::getenv("TANDEM_LOOPBACK") == nullptr) GTEST_SKIP() << "run by on_loopback.sh";
  }
};

TEST_F(OnLoopback, TwoLinksHearOneAnother) {
  Heard heard;
  const auto here = opened("");
  const auto there = opened("udpm://239.255.76.67:7667?ttl=0");
  ASSERT_TRUE(there->subscribe("big", heard.handler()).ok());
  ASSERT_TRUE(there->start().ok());
  const std::string big(200000, 'x');  // in four datagrams
  ASSERT_TRUE(here->publish("big", bytes(big)));
  EXPECT_THAT(heard.wait_for(1), ElementsAre("big=" + big));
}

TEST_F(OnLoopback, LcmsOwnRecorderHearsTheSame) {
  const auto link = opened("");
  Witness witness("eyebot/.*");
  ASSERT_TRUE(witness.wait_until_it_hears(*link));
  // Fewer than its queue of 30 holds.
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(link->publish("eyebot/eb0/n" + std::to_string(i), bytes("data")));
  ASSERT_TRUE(witness.wait_for("eyebot/eb0/n19", *link));
  int n = 0;
  for (const LoggedEvent& event : witness.end(*link)) {
    if (event.channel.find("/n") == std::string::npos) continue;
    EXPECT_EQ(event.channel, "eyebot/eb0/n" + std::to_string(n++));
    EXPECT_EQ(std::string(event.data.begin(), event.data.end()), "data");
  }
  EXPECT_EQ(n, 20);
}

}  // namespace
}  // namespace tandem::bridges::lcm_bus
