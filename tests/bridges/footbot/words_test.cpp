// Words of modules and what they mean.
#include "bridges/footbot/words.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "hal/device/ring_sensors.hpp"

namespace tandem::bridges::footbot {
namespace {

FieldMap row(WordForm form, std::size_t word = 0, std::size_t count = 1, int word_step = 1) {
  FieldMap map;
  map.port = &hal::port_type<hal::Proximity>();
  map.field = map.port->field("distance");
  map.form = form;
  map.word = word;
  map.count = count;
  map.word_step = word_step;
  return map;
}

TEST(FootbotWords, LieAsTheFormSays) {
  const std::array<std::int16_t, 4> words = {-2, 1, 0x7F01, -1};
  EXPECT_EQ(raw_number(row(WordForm::Int16), words, 0), -2);
  EXPECT_EQ(raw_number(row(WordForm::Uint16), words, 0), 65534);
  EXPECT_EQ(raw_number(row(WordForm::Int32LowFirst), words, 0), 0x1FFFE);
  EXPECT_EQ(raw_number(row(WordForm::Int32HighFirst), words, 0), -131071);  // FFFE 0001
  EXPECT_EQ(raw_number(row(WordForm::Int32LowFirst, 0, 2), words, 1), static_cast<std::int32_t>(0xFFFF7F01));
  EXPECT_EQ(raw_number(row(WordForm::Bytes, 2, 4), words, 0), 0x01);
  EXPECT_EQ(raw_number(row(WordForm::Bytes, 2, 4), words, 1), 0x7F);
  EXPECT_EQ(raw_number(row(WordForm::Bytes, 2, 4), words, 3), 0xFF);
}

TEST(FootbotWords, ComeBackAsTheyWereWritten) {
  for (const WordForm form :
       {WordForm::Int16, WordForm::Uint16, WordForm::Int32LowFirst, WordForm::Int32HighFirst, WordForm::Bytes}) {
    for (const std::int32_t number : {0, 1, 77, 255, 256, 32767, 65535, -1, -32768, 123456789, -123456789}) {
      if (number < smallest(form) || number > largest(form)) continue;
      std::array<std::int16_t, 6> words{};
      words.fill(0x5555);
      const FieldMap map = row(form, 1, 2, 1);
      set_raw_number(map, words, 1, number);
      EXPECT_EQ(raw_number(map, words, 1), number);
      EXPECT_EQ(raw_number(map, words, 0),
                raw_number(map, std::array<std::int16_t, 6>{0x5555, 0x5555, 0x5555, 0, 0, 0}, 0))
          << "the neighbour is touched";
      EXPECT_EQ(words[0], 0x5555);
      EXPECT_EQ(words[5], 0x5555);
    }
  }
}

TEST(FootbotWords, KnowHowFarTheyReach) {
  const auto reach = [](const FieldMap& map) { return std::pair(words_of(map).first, words_of(map).behind); };
  using Pair = std::pair<std::ptrdiff_t, std::ptrdiff_t>;
  EXPECT_EQ(reach(row(WordForm::Int16, 3, 4)), Pair(3, 7));
  EXPECT_EQ(reach(row(WordForm::Int16, 3, 4, -1)), Pair(0, 4));
  EXPECT_EQ(reach(row(WordForm::Int16, 2, 4, -1)), Pair(-1, 3));
  EXPECT_EQ(reach(row(WordForm::Int16, 1, 3, 2)), Pair(1, 6));
  EXPECT_EQ(reach(row(WordForm::Int32LowFirst, 1, 3)), Pair(1, 7));
  EXPECT_EQ(reach(row(WordForm::Bytes, 1, 5)), Pair(1, 4));
  EXPECT_EQ(reach(row(WordForm::Bytes, 1, 4)), Pair(1, 3));
  EXPECT_EQ(reach(row(WordForm::Bytes, 0, 2, -1)), Pair(-1, 1));
}

TEST(FootbotWords, MeanWhatScaleCurveAndSpecialsSay) {
  FieldMap map = row(WordForm::Int16);
  map.scale = -0.5;
  map.offset = 10.0;
  map.min = 0.0;
  map.specials = {{-1.0, 99.0}};
  EXPECT_EQ(to_value(map, 4), 8.0);
  EXPECT_EQ(to_value(map, 30), 0.0);
  EXPECT_EQ(to_value(map, -1), 99.0);
  map.curve = {{0, 0.1}, {100, 0.05}, {1000, 0.0}};
  EXPECT_DOUBLE_EQ(to_value(map, -5), 0.1);
  EXPECT_DOUBLE_EQ(to_value(map, 50), 0.075);
  EXPECT_DOUBLE_EQ(to_value(map, 100), 0.05);
  EXPECT_DOUBLE_EQ(to_value(map, 550), 0.025);
  EXPECT_DOUBLE_EQ(to_value(map, 5000), 0.0);
}

TEST(FootbotWords, AreRoundedAndKeptWithinTheirLimits) {
  FieldMap map = row(WordForm::Int16);
  map.scale = 0.25;
  EXPECT_EQ(to_raw(map, 1.1), 4);
  EXPECT_EQ(to_raw(map, 1.13), 5);
  EXPECT_EQ(to_raw(map, -1e9), -32768);
  EXPECT_EQ(to_raw(map, 1e300), 32767);
  map.least = -7;
  map.most = 9;
  map.rest = 3;
  EXPECT_EQ(to_raw(map, 1e6), 9);
  EXPECT_EQ(to_raw(map, -1e6), -7);
  EXPECT_EQ(to_raw(map, std::nan("")), 3);
  EXPECT_EQ(to_raw(map, std::numeric_limits<double>::infinity()), 3);
}

TEST(FootbotWords, CountOnAcrossTheirWrap) {
  EXPECT_EQ(counter_difference(WordForm::Int16, -32768, 32767), 1);
  EXPECT_EQ(counter_difference(WordForm::Uint16, 3, 65533), 6);
  EXPECT_EQ(counter_difference(WordForm::Uint16, 65533, 3), -6);
  EXPECT_EQ(counter_difference(WordForm::Bytes, 1, 255), 2);
  EXPECT_EQ(counter_difference(WordForm::Int32LowFirst, std::numeric_limits<std::int32_t>::min(),
                               std::numeric_limits<std::int32_t>::max()),
            1);
}

}  // namespace
}  // namespace tandem::bridges::footbot
