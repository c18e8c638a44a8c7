#include "hal/json/json_access.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace tandem::hal {
namespace {

/// As others may have written it.
const Json kWritten =
    parse_json(R"({"text": "a", "number": -1.5, "whole": -3, "count": 18446744073709551615, "yes": true,
  "no": false, "null": null, "list": ["b", 4, null, -2.5], "object": {"in": 1}})")
        .value();

TEST(JsonAccess, GivesWhatIsThere) {
  EXPECT_EQ(text_of(kWritten, "text", "other"), "a");
  EXPECT_EQ(number_of(kWritten, "number", 9.0), -1.5);
  EXPECT_EQ(number_of(kWritten, "whole", 9.0), -3.0);
  EXPECT_EQ(whole_of(kWritten, "whole", 9), -3);
  EXPECT_EQ(count_of(kWritten, "count"), 18446744073709551615U);
  EXPECT_TRUE(flag_of(kWritten, "yes"));
  EXPECT_EQ(list_of(kWritten, "list").size(), 4U);
  EXPECT_EQ(count_of(object_of(kWritten, "object"), "in"), 1U);
  EXPECT_EQ(texts_of(kWritten, "list"), (std::vector<std::string>{"b", "", "", ""}));
  EXPECT_EQ(item_of(list_of(kWritten, "list"), 3), -2.5);
  EXPECT_EQ(member_of(kWritten, "text"), &kWritten["text"]);
}

TEST(JsonAccess, TakesTheOtherValueForWhatIsMissingOrOfAnotherKind) {
  for (const char* const key : {"missing", "null", "list", "object", "yes"}) {
    EXPECT_EQ(text_of(kWritten, key, "other"), "other") << key;
    EXPECT_EQ(number_of(kWritten, key, 9.0), 9.0) << key;
    EXPECT_EQ(whole_of(kWritten, key, 9), 9) << key;
    EXPECT_EQ(count_of(kWritten, key, 9), 9U) << key;
  }
  EXPECT_EQ(whole_of(kWritten, "number", 9), 9);
  EXPECT_EQ(count_of(kWritten, "whole", 9), 9U);
  EXPECT_FALSE(flag_of(kWritten, "no") || flag_of(kWritten, "text") || flag_of(kWritten, "missing"));
  EXPECT_TRUE(list_of(kWritten, "object").is_array() && list_of(kWritten, "object").empty());
  EXPECT_TRUE(object_of(kWritten, "list").is_object() && object_of(kWritten, "list").empty());
  EXPECT_EQ(item_of(list_of(kWritten, "list"), 0, 7.0), 7.0);
  EXPECT_EQ(item_of(list_of(kWritten, "list"), 4, 7.0), 7.0);
  EXPECT_EQ(number_of({{"inf", INFINITY}}, "inf", 9.0), 9.0);
}

TEST(JsonAccess, TakesTheOtherValueForMembersOfWhatHasNone) {
  for (const Json& none : {Json(), Json(3), Json("text"), Json::array({1, 2})}) {
    EXPECT_EQ(member_of(none, "text"), nullptr);
    EXPECT_EQ(text_of(none, "text", "other"), "other");
    EXPECT_EQ(number_of(none, "text", 9.0), 9.0);
    EXPECT_FALSE(flag_of(none, "text"));
    EXPECT_TRUE(texts_of(none, "text").empty());
    EXPECT_EQ(item_of(list_of(none, "text"), 0, 7.0), 7.0);
  }
}

}  // namespace
}  // namespace tandem::hal
