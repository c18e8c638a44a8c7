#include "hal/result.hpp"

#include <gtest/gtest.h>
#include <memory>
#include <vector>

#include "hal/log.hpp"

namespace tandem::hal {
namespace {

TEST(Result, IsAValueOrAnError) {
  const Result<int> good = 5;
  EXPECT_TRUE(good.ok());
  EXPECT_TRUE(static_cast<bool>(good));
  EXPECT_EQ(good.value(), 5);
  const Result<int> bad = Error{"no"};
  EXPECT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().message, "no");
}

TEST(Result, MovesWhatCannotBeCopied) {
  Result<std::unique_ptr<int>> owner = std::make_unique<int>(7);
  const std::unique_ptr<int> taken = std::move(owner).value();
  EXPECT_EQ(*taken, 7);
}

TEST(Result, TellsAnErrorFromAStringValue) {
  const Result<std::string> text = std::string("fine");
  EXPECT_TRUE(text.ok());
}

TEST(Status, IsGoodUntilAnErrorIsPutIn) {
  EXPECT_TRUE(Status{}.ok());
  const Status bad = Error{"broken"};
  EXPECT_FALSE(bad.ok());
  EXPECT_EQ(bad.error().message, "broken");
}

TEST(Log, HandsMessagesToItsSinkAndElseDropsThem) {
  Log{}.error("nobody listens");
  std::vector<std::pair<Severity, std::string>> heard;
  const Log log([&](Severity severity, std::string_view text) { heard.emplace_back(severity, text); });
  log.info("a");
  log.warning("b");
  log.error("c");
  const std::vector<std::pair<Severity, std::string>> expected = {
      {Severity::Info, "a"}, {Severity::Warning, "b"}, {Severity::Error, "c"}};
  EXPECT_EQ(heard, expected);
}

}  // namespace
}  // namespace tandem::hal
