#include "hal/json/json.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace tandem::hal {
namespace {

TEST(JsonText, KeepsTheOrderAndWritesOneLine) {
  const Json json{{"b", "x\"y\\z\n"}, {"a", 1.5}, {"nan", std::nan("")}, {"list", {true, 3, nullptr}}};
  EXPECT_EQ(to_text(json), R"({"b":"x\"y\\z\n","a":1.5,"nan":null,"list":[true,3,null]})");
}

TEST(JsonText, WritesUtf8AndReplacesWhatIsNone) {
  EXPECT_EQ(to_text(Json("Zürich")), "\"Zürich\"");
  EXPECT_EQ(to_text(Json("Z\xFCrich")), "\"Z\xEF\xBF\xBDrich\"");
}

TEST(JsonObject, ReadsWhatTheWriterWrites) {
  const std::string text = "quote \" back\\slash \n \x01 é";
  for (const double number : {0.1, -1e-300, 12345678.9, std::numeric_limits<double>::max()}) {
    auto o = parse_json_object(to_text(Json{{"text", text}, {"number", number}}));
    ASSERT_TRUE(o.ok()) << o.error().message;
    EXPECT_EQ(o->at("text"), text);
    EXPECT_EQ(o->at("number"), number);
  }
}

TEST(JsonObject, SaysWhatIsWrongAndWhere) {
  const std::pair<const char*, const char*> kBroken[] = {{"", "column 1"},
                                                         {"[1]", "but a array"},
                                                         {"{", "column 2"},
                                                         {"{\"a\": 1", "column 8"},
                                                         {"{\"a\": 1,}", "column 9"},
                                                         {"{\"a\" 1}", "column 6"},
                                                         {"{\"a\": inf}", "column 7"},
                                                         {"{\"a\": 1e999}", "overflow"},
                                                         {"{\"a\": \"x}", "missing closing quote"},
                                                         {"{\"a\": \"\\ud800\"}", "column"},
                                                         {"{\"a\": 1, \"a\": 2}", "\"a\" stands twice"},
                                                         {"{\"a\": 1} x", "column 10"}};
  for (const auto& [text, why] : kBroken) {
    const auto o = parse_json_object(text);
    ASSERT_FALSE(o.ok()) << text;
    EXPECT_NE(o.error().message.find(why), std::string::npos) << text << ": " << o.error().message;
    EXPECT_EQ(o.error().message.find("it is no JSON object"), 0U) << o.error().message;
  }
}

TEST(JsonObject, RefusesEveryBeginningOfAGoodLine) {
  const std::string good = R"({"a": "x\u0041", "b": -1.5e3, "c": true, "d": null})";
  ASSERT_TRUE(parse_json_object(good).ok());
  for (std::size_t n = 0; n < good.size(); ++n) EXPECT_FALSE(parse_json_object(good.substr(0, n)).ok()) << n;
}

}  // namespace
}  // namespace tandem::hal
