#include "app/bench/flat_json.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

#include "app/json.hpp"

namespace tandem::app {
namespace {

TEST(FlatJson, ReadsEverySortOfValue) {
  auto o = parse_flat_json(R"( { "a" : -1.5e3 ,"b":"x", "c":true,"d":false,"e":null, "":0 } )");
  ASSERT_TRUE(o.ok()) << o.error().message;
  EXPECT_EQ(o->size(), 6U);
  EXPECT_EQ(std::get<double>(o->at("a")), -1500.0);
  EXPECT_EQ(std::get<std::string>(o->at("b")), "x");
  EXPECT_TRUE(std::get<bool>(o->at("c")));
  EXPECT_FALSE(std::get<bool>(o->at("d")));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(o->at("e")));
  EXPECT_EQ(std::get<double>(o->at("")), 0.0);
  ASSERT_TRUE(parse_flat_json("{}").ok());
}

TEST(FlatJson, ReadsEscapes) {
  auto o = parse_flat_json(R"({"a": "\"\\\/\b\f\n\r\t\u0041\u00e9\u20AC"})");
  ASSERT_TRUE(o.ok()) << o.error().message;
  EXPECT_EQ(std::get<std::string>(o->at("a")), "\"\\/\b\f\n\r\tA\xC3\xA9\xE2\x82\xAC");
}

TEST(FlatJson, ReadsWhatTheWriterWrites) {
  const std::string text = "quote \" back\\slash \n \x01 é";
  for (const double number : {0.1, -1e-300, 12345678.9, std::numeric_limits<double>::max()}) {
    Json json;
    json.begin_object().field("text", text).field("number", number).field("nan", std::nan("")).end_object();
    auto o = parse_flat_json(json.text());
    ASSERT_TRUE(o.ok()) << o.error().message;
    EXPECT_EQ(std::get<std::string>(o->at("text")), text);
    EXPECT_EQ(std::get<double>(o->at("number")), number);
    EXPECT_TRUE(std::holds_alternative<std::monostate>(o->at("nan")));
  }
}

TEST(FlatJson, SaysWhatIsWrongAndWhere) {
  const std::pair<const char*, const char*> kBroken[] = {
      {"", "no '{' at character 1"},
      {"[1]", "no '{' at character 1"},
      {"{", "no name in quotes at character 2"},
      {"{\"a\": 1", "neither ',' nor '}' at character 8"},
      {"{\"a\": 1,}", "no name in quotes at character 9"},
      {"{\"a\" 1}", "no ':' at character 6"},
      {"{\"a\": [1]}", "no text, number or word at character 7"},
      {"{\"a\": {}}", "no text, number or word at character 7"},
      {"{\"a\": inf}", "no text, number or word at character 7"},
      {"{\"a\": -}", "no text, number or word at character 7"},
      {"{\"a\": 1e999}", "too large or too small at character 7"},
      {"{\"a\": \"x}", "without its closing quote at character 10"},
      {"{\"a\": \"\\x\"}", "an unknown escape"},
      {"{\"a\": \"\\ud800\"}", "an unknown escape"},
      {"{\"a\": \"\\u12\"}", "an unknown escape"},
      {"{\"a\": \"\t\"}", "a control character in a text"},
      {"{\"a\": 1, \"a\": 2}", "a name that was there before"},
      {"{\"a\": 1} x", "something after the object at character 10"},
      {"{\"a\": 1}{\"a\": 1}", "something after the object at character 9"}};
  for (const auto& [text, why] : kBroken) {
    auto o = parse_flat_json(text);
    ASSERT_FALSE(o.ok()) << text;
    EXPECT_NE(o.error().message.find(why), std::string::npos) << text << ": " << o.error().message;
  }
}

TEST(FlatJson, RefusesEveryBeginningOfAGoodLine) {
  const std::string good = R"({"a": "x\u0041", "b": -1.5e3, "c": true, "d": null})";
  ASSERT_TRUE(parse_flat_json(good).ok());
  for (std::size_t n = 0; n < good.size(); ++n) EXPECT_FALSE(parse_flat_json(good.substr(0, n)).ok()) << n;
}

}  // namespace
}  // namespace tandem::app
