// Json's texts against nlohmann's: the same bytes and the same complaints, for values and texts that are made up.
#include <bit>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>

#include "hal/json/json.hpp"

namespace tandem::hal {
namespace {

using Other = nlohmann::ordered_json;

std::string made_up_text(bool utf8) {
  static const std::string kPieces[] = {"a", "key", "\"", "\\", "\n", "\x01", "\x7F", "é", "€", "😀", "/", " "};
  static const std::string kBroken[] = {"\xFC", "\xE2\x82", "\xC0\x80", "\xED\xA0\x80", "\xF8"};
  std::string text;
  for (int i = *rc::gen::inRange(0, 6); i > 0; --i)
    text += utf8 || *rc::gen::inRange(0, 4) != 0
                ? *rc::gen::elementOf(std::vector(std::begin(kPieces), std::end(kPieces)))
                : *rc::gen::elementOf(std::vector(std::begin(kBroken), std::end(kBroken)));
  return text;
}

/// With `plain`, what can be read again: texts in UTF-8, numbers that are finite.
Json made_up(int depth, bool plain) {
  switch (*rc::gen::inRange(0, depth > 0 ? 9 : 7)) {
    case 0:
      return nullptr;
    case 1:
      return *rc::gen::arbitrary<bool>();
    case 2:
      return *rc::gen::arbitrary<std::int64_t>();
    case 3:
      return *rc::gen::arbitrary<std::uint64_t>();
    case 4: {
      const auto number = std::bit_cast<double>(*rc::gen::resize(1000, rc::gen::arbitrary<std::uint64_t>()));
      return plain && !std::isfinite(number) ? 0.5 : number;
    }
    case 5:
      return *rc::gen::inRange(-1000, 1000) / 8.0;
    case 6:
      return made_up_text(plain);
    case 7: {
      Json all = Json::array();
      for (int i = *rc::gen::inRange(0, 5); i > 0; --i) all.push_back(made_up(depth - 1, plain));
      return all;
    }
    default: {
      Json all = Json::object();
      for (int i = *rc::gen::inRange(0, 5); i > 0; --i) all[made_up_text(plain)] = made_up(depth - 1, plain);
      return all;
    }
  }
}

Other other_of(const Json& json) {
  if (json.is_null()) return nullptr;
  if (json.is_boolean()) return json.get<bool>();
  if (json.is_number_unsigned()) return json.get<std::uint64_t>();
  if (json.is_number_integer()) return json.get<std::int64_t>();
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return json.text();
  Other all = json.is_array() ? Other::array() : Other::object();
  if (json.is_array())
    for (const Json& one : json) all.push_back(other_of(one));
  for (const auto& [name, value] : json.items()) all[name] = other_of(value);
  return all;
}

TEST(JsonTexts, AreThoseOfNlohmann) {
  EXPECT_TRUE(rc::check([] {
    const Json json = made_up(4, false);
    const int indent = *rc::gen::inRange(-1, 4);
    RC_ASSERT(to_text(json, indent) == other_of(json).dump(indent, ' ', false, Other::error_handler_t::replace));
  }));
}

TEST(JsonTexts, BecomeTheSameValueAgain) {
  EXPECT_TRUE(rc::check([] {
    const Json json = made_up(4, true);
    const auto again = parse_json(to_text(json, *rc::gen::inRange(-1, 4)));
    RC_ASSERT(again.ok());
    RC_ASSERT(again.value() == json);
    RC_ASSERT(to_text(again.value()) == to_text(json));
  }));
}

TEST(JsonTexts, AreRefusedAsNlohmannRefusesThem) {
  EXPECT_TRUE(rc::check([] {
    std::string text = to_text(made_up(3, true));
    for (int i = *rc::gen::inRange(0, 4); i > 0 && !text.empty(); --i) {
      const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
      if (*rc::gen::arbitrary<bool>())
        text.erase(at, 1);
      else
        text.insert(at, *rc::gen::elementOf(
                            std::vector<std::string>{"\"", "{", "]", ",", "1e999", "\\ud800", "\xFF", "-", "tru"}));
    }
    std::string why;
    Other other;
    try {
      other = Other::parse(text);
    } catch (const Other::exception& problem) {
      why = problem.what();
    }
    const auto json = parse_json(text);
    RC_ASSERT(json.ok() == why.empty());
    if (json.ok())
      RC_ASSERT(other_of(json.value()) == other);
    else
      RC_ASSERT(json.error().message == "it is no JSON: " + why.substr(why.find("] ") + 2));
  }));
}

TEST(JsonTexts, OfUtf8AreThoseThatNlohmannWritesAsTheyAre) {
  EXPECT_TRUE(rc::check([] {
    const std::string text = made_up_text(false);
    bool good = true;
    try {
      (void)Other(text).dump();
    } catch (const Other::exception&) {
      good = false;
    }
    RC_ASSERT(is_utf8(text) == good);
  }));
}

TEST(JsonTexts, MayBeAHundredThousandArraysDeep) {
  const std::string deep(100'000, '[');
  EXPECT_FALSE(parse_json(deep).ok());
  EXPECT_TRUE(parse_json(deep + std::string(deep.size(), ']')).ok());
}

}  // namespace
}  // namespace tandem::hal
