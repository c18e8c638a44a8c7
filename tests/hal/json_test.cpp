#include "hal/json/json.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <vector>

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

TEST(JsonValue, OfAListOfPairsIsAnObjectAndOfAnyOtherListAnArray) {
  EXPECT_EQ(to_text(Json{{"a", 1}, {"b", {{"c", nullptr}}}}), R"({"a":1,"b":{"c":null}})");
  EXPECT_EQ(to_text(Json{{"a", 1}, {"b"}}), R"([["a",1],["b"]])");
  EXPECT_EQ(to_text(Json{{1, 2}, {3, 4}}), "[[1,2],[3,4]]");
  EXPECT_EQ(to_text(Json{{"a", 1}, {"a", 2}}), R"({"a":1})");
  EXPECT_EQ(to_text(Json::array({{"a", 1}})), R"([["a",1]])");
  EXPECT_TRUE(Json{}.is_null());
}

TEST(JsonValue, IsMadeOfContainers) {
  EXPECT_EQ(to_text(Json(std::vector<std::vector<int>>{{1}, {}, {2, 3}})), "[[1],[],[2,3]]");
  EXPECT_EQ(to_text(Json(std::map<std::string, double>{{"b", 1.0}, {"a", 0.5}})), R"({"a":0.5,"b":1.0})");
  EXPECT_EQ(to_text(Json(std::array<std::string, 2>{"x", "y"})), R"(["x","y"])");
  EXPECT_EQ(to_text(Json(std::string_view("text"))), "\"text\"");
}

TEST(JsonValue, GetsMembersAndElementsAsTheyAreNamed) {
  Json json;
  json["list"][2] = 7;
  json["inner"]["text"] = "x";
  json["inner"].push_back({"more", true});
  json["list"].emplace_back("end");
  EXPECT_EQ(to_text(json), R"({"list":[null,null,7,"end"],"inner":{"text":"x","more":true}})");
  json.erase("list");
  json.erase("nothing");
  json.update({{"inner", 1}, {"z", 2}});
  EXPECT_EQ(to_text(json), R"({"inner":1,"z":2})");
  EXPECT_TRUE(json.contains("z"));
  EXPECT_EQ(json.find("y"), json.end());
  EXPECT_EQ(*json.find("z"), 2);
  EXPECT_EQ(json.value("z", 0.0), 2.0);
  EXPECT_EQ(json.value("y", "none"), "none");
}

TEST(JsonValue, IsCopiedWhole) {
  const Json json{{"a", {1, {{"b", "text"}}}}};
  Json copy = json;
  copy["a"][1]["b"] = "other";
  EXPECT_EQ(to_text(json), R"({"a":[1,{"b":"text"}]})");
  EXPECT_NE(copy, json);
  copy = json;
  EXPECT_EQ(copy, json);
  Json of_itself = Json::array();
  of_itself.push_back(of_itself);
  of_itself.push_back(of_itself);
  EXPECT_EQ(to_text(of_itself), "[[],[[]]]");
}

TEST(JsonValue, ComparesNumbersAsNumbersAndTextsAsTexts) {
  EXPECT_EQ(Json(1), Json(1U));
  EXPECT_EQ(Json(1), 1.0);
  EXPECT_NE(Json(-1), Json(1));
  EXPECT_EQ(Json("a"), std::string("a"));
  EXPECT_NE(Json(1), "1");
  EXPECT_NE(Json(true), 1);
  EXPECT_NE(Json(nullptr), Json::object());
  EXPECT_EQ(Json(), nullptr);
  EXPECT_NE(Json("text"), nullptr);
}

TEST(JsonValue, IsReadAsWhatItIsOrNotAtAll) {
  const Json json{{"text", "x"}, {"numbers", {1, 2.5, 3U}}};
  EXPECT_EQ(json["numbers"].get<std::vector<double>>(), (std::vector<double>{1.0, 2.5, 3.0}));
  EXPECT_EQ((json["numbers"].get<std::array<int, 3>>()), (std::array<int, 3>{1, 2, 3}));
  EXPECT_EQ((Json{{"a", 1}, {"b", 2}}.get<std::map<std::string, int>>()),
            (std::map<std::string, int>{{"a", 1}, {"b", 2}}));
  EXPECT_THROW((void)(json["numbers"].get<std::map<std::string, int>>()), JsonError);
  EXPECT_THROW((void)json["numbers"].get<std::vector<std::string>>(), JsonError);
  EXPECT_THROW((void)(json["numbers"].get<std::array<int, 4>>()), JsonError);
  EXPECT_THROW((void)json["text"].get<double>(), JsonError);
  EXPECT_THROW((void)json["text"].get<bool>(), JsonError);
  EXPECT_THROW((void)json.at("none"), JsonError);
  EXPECT_THROW((void)json["numbers"].at(3), JsonError);
  EXPECT_THROW((void)json["numbers"].value("name", 1), JsonError);
  EXPECT_THROW(Json("x").push_back(1), JsonError);
  EXPECT_THROW(Json(1)["name"] = 1, JsonError);
}

TEST(JsonValue, IsWalkedThroughWhateverItIs) {
  const auto count = [](const Json& json) {
    int n = 0;
    for (const Json& one : json) n += one.is_null() ? 100 : 1;
    return n;
  };
  EXPECT_EQ(count(nullptr), 0);
  EXPECT_EQ(count("text"), 1);
  EXPECT_EQ(count(Json::array()), 0);
  EXPECT_EQ(count({1, 2}), 2);
  EXPECT_EQ(count({{"a", 1}, {"b", nullptr}}), 101);
  std::string names;
  const Json object{{"a", 1}, {"b", 2}};
  for (const auto& [name, value] : object.items()) names += name + to_text(value);
  EXPECT_EQ(names, "a1b2");
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
