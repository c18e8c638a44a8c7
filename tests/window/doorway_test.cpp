#include "window/doorway.hpp"

#include <gtest/gtest.h>

#include "window/page_files.hpp"

namespace tandem::window {
namespace {

TEST(Doorway, ReadsQueries) {
  EXPECT_EQ(query_value("/ws?token=abc&v=3", "token"), "abc");
  EXPECT_EQ(query_value("/ws?x=1&token=a%2Fb#there", "token"), "a/b");
  EXPECT_EQ(query_value("/ws?mytoken=abc", "token"), "");
  EXPECT_EQ(query_value("/ws", "token"), "");
  EXPECT_EQ(query_value("/ws?token", "token"), "");
  EXPECT_EQ(query_value("/ws?token=%4", "token"), "");
  EXPECT_EQ(query_value("/ws?token=%zz", "token"), "");
  EXPECT_EQ(query_value("/?token=%", "token"), "");
  EXPECT_EQ(path_of("/a?b#c"), "/a");
}

TEST(Doorway, AnswersToNumbersLocalhostAndThisMachineOnAnyPort) {
  const Doorway doorway{"lab3", {"https://arena.example:8443"}};
  for (const char* host : {"127.0.0.1:8123", "127.0.0.1", "localhost:9000", "LocalHost", "[::1]:80", "192.168.1.4:1",
                           "lab3:8123", "arena.example:8443"}) {
    EXPECT_TRUE(doorway.host_is_ours(host)) << host;
  }
  for (const char* host : {"", "evil.example", "127.0.0.1.evil.example", "1.2.3.4a", "arena.example",
                           "lab3.evil.example", "[::1", "[::1]x", "a:b:c", "localhost.evil.example:80"}) {
    EXPECT_FALSE(doorway.host_is_ours(host)) << host;
  }
}

TEST(Doorway, PagesOfOthersMayNotIn) {
  const Doorway doorway{"lab3", {"https://arena.example:8443"}};
  EXPECT_TRUE(doorway.origin_is_ours("", "127.0.0.1:8123"));  // no browser
  EXPECT_TRUE(doorway.origin_is_ours("http://127.0.0.1:8123", "127.0.0.1:8123"));
  EXPECT_TRUE(doorway.origin_is_ours("http://localhost:9000", "localhost:9000"));  // forwarded by ssh
  EXPECT_TRUE(doorway.origin_is_ours("https://arena.example:8443", "arena.example:8443"));
  EXPECT_FALSE(doorway.origin_is_ours("http://localhost:3000", "localhost:8123"));
  EXPECT_FALSE(doorway.origin_is_ours("http://evil.example", "127.0.0.1:8123"));
  EXPECT_FALSE(doorway.origin_is_ours("null", "127.0.0.1:8123"));
}

TEST(PageFiles, CarryThePageAndThreeJs) {
  for (const char* path : {"/index.html", "/three.module.js"}) {
    const PageFile* const file = find_page_file(path);
    ASSERT_NE(file, nullptr) << path;
    EXPECT_GT(file->content.size(), 100U);
    EXPECT_LT(file->packed.size(), file->content.size());
    EXPECT_EQ(file->packed.substr(0, 2), "\x1f\x8b");
  }
  EXPECT_EQ(find_page_file("/../secret"), nullptr);
}

}  // namespace
}  // namespace tandem::window
