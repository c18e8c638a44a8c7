#include "controllers/footbot_manual/order.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "hal/unit.hpp"

namespace tandem::controllers {
namespace {

using Words = std::vector<std::string_view>;

constexpr double kMost = 1e6;  // m/s, rad/s or rad: sums and products of such numbers are finite
constexpr const char* kOrders =
    "drive SPEED TURN (such as 'drive 10 cm/s 0.5 rad/s'), stop, grip, release, turret ANGLE, turret TURN, turret off, "
    "turret passive";

Words words_of(std::string_view line) {
  Words words;
  for (std::size_t at = 0; (at = line.find_first_not_of(" \t\r\n", at)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t\r\n", at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

bool starts_number(std::string_view word) {
  return word.find_first_of("0123456789") <= 2 && word.find_first_not_of("+-.0123456789") != 0;
}

/// Numbers with the units that follow them, after the first word.
std::vector<std::string> quantities(const Words& words) {
  std::vector<std::string> all;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (all.empty() || starts_number(words[i]))
      all.emplace_back(words[i]);
    else
      all.back() += " " + std::string(words[i]);
  }
  return all;
}

/// A number that has a unit, or is 0.
hal::Result<double> quantity(const std::string& text, const hal::Unit& like) {
  const auto value = hal::parse_quantity(text, like);
  const bool bare = text.find_first_not_of("+-.0123456789eE") == std::string::npos;
  if (value.ok() && bare && value.value() != 0.0)
    return hal::Error{"'" + text + "' has no unit; write '" + text + " " + std::string(like.symbol) + "'"};
  if (value.ok() && std::fabs(value.value()) > kMost) return hal::Error{"'" + text + "' is beyond all reason"};
  return value;
}

hal::Result<Order> parse_drive(const Words& words) {
  const auto given = quantities(words);
  if (given.size() != 2) return hal::Error{"'drive' takes a speed and a turn: 'drive 10 cm/s 0.5 rad/s'"};
  const auto ahead = quantity(given[0], hal::unit::m_s);
  if (!ahead.ok()) return ahead.error();
  const auto turn = quantity(given[1], hal::unit::rad_s);
  if (!turn.ok()) return turn.error();
  return Order(Drive{ahead.value(), turn.value()});
}

hal::Result<Order> parse_turret(const Words& words) {
  if (words.size() == 2 && words[1] == "off") return Order(TurretFree{false});
  if (words.size() == 2 && words[1] == "passive") return Order(TurretFree{true});
  const auto given = quantities(words);
  if (given.size() != 1)
    return hal::Error{"'turret' takes an angle ('90 deg'), a speed ('20 deg/s'), 'off' or 'passive'"};
  if (given[0].ends_with("/s")) {
    const auto speed = quantity(given[0], hal::unit::rad_s);
    if (!speed.ok()) return speed.error();
    return Order(TurretTurn{speed.value()});
  }
  const auto angle = quantity(given[0], hal::unit::rad);
  if (!angle.ok()) return angle.error();
  return Order(TurretTo{angle.value()});
}

std::optional<Order> word_alone(std::string_view word) {
  if (word == "stop") return Drive{};
  if (word == "grip") return Grip{true};
  if (word == "release") return Grip{false};
  return std::nullopt;
}

}  // namespace

hal::Result<Order> parse_order(std::string_view line) {
  const Words words = words_of(line);
  if (words.empty()) return hal::Error{std::string("an empty line; there are: ") + kOrders};
  if (words[0] == "drive") return parse_drive(words);
  if (words[0] == "turret") return parse_turret(words);
  const auto alone = word_alone(words[0]);
  if (!alone) return hal::Error{"no order '" + std::string(words[0]) + "'; there are: " + kOrders};
  if (words.size() > 1) return hal::Error{"'" + std::string(words[0]) + "' takes nothing after it"};
  return *alone;
}

}  // namespace tandem::controllers
