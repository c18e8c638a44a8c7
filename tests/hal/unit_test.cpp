#include "hal/unit.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <rapidcheck.h>
#include <set>

#include "hal/rounded.hpp"

namespace tandem::hal {
namespace {

using testing::HasSubstr;

double parsed(std::string_view text, const Unit& bare) {
  const auto result = parse_quantity(text, bare);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
  return result.ok() ? result.value() : -999.0;
}

std::string refused(std::string_view text, const Unit& bare) {
  const auto result = parse_quantity(text, bare);
  EXPECT_FALSE(result.ok()) << text << " was taken as " << (result.ok() ? result.value() : 0.0);
  return result.ok() ? "" : result.error().message;
}

TEST(ParseQuantity, TakesSuffixesOfTheDimension) {
  EXPECT_DOUBLE_EQ(parsed("4 cm", unit::m), 0.04);
  EXPECT_DOUBLE_EQ(parsed("4cm", unit::m), 0.04);
  EXPECT_DOUBLE_EQ(parsed("  4\tmm ", unit::m), 0.004);
  EXPECT_DOUBLE_EQ(parsed("-90 deg", unit::rad), -std::acos(-1.0) / 2.0);
  EXPECT_DOUBLE_EQ(parsed("2 min", unit::s), 120.0);
  EXPECT_DOUBLE_EQ(parsed("5 cm/s", unit::m_s), 0.05);
  EXPECT_DOUBLE_EQ(parsed("180 deg/s", unit::rad_s), std::acos(-1.0));
  EXPECT_DOUBLE_EQ(parsed("250 g", unit::kg), 0.25);
  EXPECT_DOUBLE_EQ(parsed("50 %", unit::none), 0.5);
}

TEST(ParseQuantity, TakesAUnitThatIsNoneOfOursWhereAPartHasItItself) {
  constexpr Unit kNewton{Dim::None, "mN", 0.001};
  EXPECT_DOUBLE_EQ(parse_quantity("18 mN", kNewton).value(), 0.018);
  EXPECT_DOUBLE_EQ(parse_quantity(format_quantity(0.018, kNewton), kNewton).value(), 0.018);
  EXPECT_FALSE(parse_quantity("18 mN", unit::m).ok());
}

TEST(ParseQuantity, TakesABareNumberInTheGivenUnit) {
  EXPECT_DOUBLE_EQ(parsed("4", unit::cm), 0.04);
  EXPECT_DOUBLE_EQ(parsed("+4e1", unit::m), 40.0);
  EXPECT_DOUBLE_EQ(parsed(".5", unit::none), 0.5);
}

TEST(ParseQuantity, RefusesWhatIsNoNumber) {
  for (const char* text :
       {"", " ", "cm", "four", "+", "-", "+-5", "++5", "--5", "nan", "inf", "-inf", "1e999", "1e-999", "0,5"}) {
    EXPECT_FALSE(parse_quantity(text, unit::m).ok()) << text;
  }
  EXPECT_EQ(refused("four", unit::m), "'four' is not a number");
}

TEST(ParseQuantity, NamesTheUnitsThatWouldDo) {
  EXPECT_EQ(refused("4 s", unit::m), "'4 s': unit 's' does not fit; use one of: m, cm, mm");
  EXPECT_THAT(refused("4 parsec", unit::m), HasSubstr("'parsec' does not fit"));
  EXPECT_THAT(refused("4 5", unit::m), HasSubstr("'5' does not fit"));
  EXPECT_THAT(refused("4 m", unit::none), HasSubstr("use one of: %"));
  EXPECT_THAT(refused("0x10", unit::none), HasSubstr("'x10' does not fit"));
}

TEST(Units, HaveSymbolsOfTheirOwn) {
  std::set<std::string_view> symbols;
  for (const Unit& u : all_units()) {
    EXPECT_FALSE(u.symbol.empty());
    EXPECT_GT(u.to_si, 0.0);
    EXPECT_TRUE(symbols.insert(u.symbol).second) << u.symbol;
  }
}

TEST(Unit, PlacesForPeopleHaveMillimetres) {
  EXPECT_EQ(place_text(1.0 / 3.0, -0.00001), "(0.333, 0)");
  EXPECT_EQ(place_text(-2.5, 1e300), "(-2.5, 1e+300)");
  EXPECT_EQ(rounded(2.0 / 3.0, 1), "0.7");
  EXPECT_EQ(rounded(-1.23456), "-1.235");
}

TEST(FormatNumber, IsShortAndExact) {
  EXPECT_EQ(format_number(0.1), "0.1");
  EXPECT_EQ(format_number(5.0), "5");
  EXPECT_EQ(format_number(-0.0), "-0");
  EXPECT_EQ(format_number(1.0 / 3.0), "0.3333333333333333");
}

TEST(FormatQuantity, ReadsAsPeopleWroteIt) {
  EXPECT_EQ(format_quantity(0.05, unit::cm_s), "5 cm/s");
  EXPECT_EQ(format_quantity(0.129, unit::cm_s), "12.9 cm/s");
  EXPECT_EQ(format_quantity(90.0 * unit::deg.to_si, unit::deg), "90 deg");
  EXPECT_EQ(format_quantity(0.0, unit::m), "0 m");
  EXPECT_EQ(format_quantity(0.25, unit::none), "0.25");
}

Unit any_unit() {
  return *rc::gen::elementOf(std::vector<Unit>(all_units().begin(), all_units().end()));
}

TEST(Units, EveryNumberIsReadBackExactly) {
  EXPECT_TRUE(rc::check([](double number) {
    if (number != 0.0 && std::fpclassify(number) != FP_NORMAL) return;
    RC_ASSERT(parse_quantity(format_number(number), unit::none).value() == number);
    RC_ASSERT(parse_quantity("+" + format_number(std::fabs(number)), unit::none).value() == std::fabs(number));
  }));
}

TEST(Units, EverySuffixMultiplies) {
  EXPECT_TRUE(rc::check([](int number) {
    const Unit u = any_unit();
    const Unit bare{u.dim, "", 1.0};
    RC_ASSERT(parse_quantity(std::to_string(number) + " " + std::string(u.symbol), bare).value() == number * u.to_si);
    RC_ASSERT(parse_quantity(std::to_string(number), u).value() == number * u.to_si);
  }));
}

TEST(Units, FormattedQuantitiesReadBackToTwelveDigits) {
  EXPECT_TRUE(rc::check([](int mantissa, std::uint8_t exponent) {
    const Unit u = any_unit();
    const double value = mantissa * std::pow(10.0, exponent % 24 - 12);
    const double back = parse_quantity(format_quantity(value, u), u).value();
    RC_ASSERT(std::fabs(back - value) <= 1e-11 * std::fabs(value));
  }));
}

TEST(Units, ExactTextReadsBackAsTheSameBits) {
  EXPECT_EQ(format_exactly(0.05, unit::cm_s), "5 cm/s");
  EXPECT_EQ(format_exactly(0.1 + 0.2, unit::m), "0.30000000000000004 m");
  EXPECT_TRUE(rc::check([](std::int64_t mantissa, std::uint8_t exponent) {
    const Unit u = any_unit();
    const double value = static_cast<double>(mantissa) / 3.0 * std::pow(10.0, exponent % 24 - 12);
    if (u.symbol == unit::percent.symbol) return;  // no dimension, so no unit to fall back on
    RC_ASSERT(parse_quantity(format_exactly(value, u), u).value() == value);
  }));
}

TEST(ParseQuantity, NeverCrashesAndNeverReturnsWhatIsNotFinite) {
  EXPECT_TRUE(rc::check([](const std::string& text) {
    const auto result = parse_quantity(text, any_unit());
    const bool good = !result.ok() || std::isfinite(result.value());
    RC_ASSERT(good);
  }));
  const auto pieces = rc::gen::container<std::string>(rc::gen::elementOf(std::string("0159+-.eE cmdegs/%naif\t")));
  EXPECT_TRUE(rc::check([&] {
    const auto result = parse_quantity(*pieces, any_unit());
    const bool good = !result.ok() || std::isfinite(result.value());
    RC_ASSERT(good);
  }));
}

}  // namespace
}  // namespace tandem::hal
