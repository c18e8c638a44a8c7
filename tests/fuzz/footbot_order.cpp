// Orders to a foot-bot that is driven by hand, fed with anything that a datagram may hold.
//
// Two uses of one input: its bytes as a line; and each byte as a word of the language, so that most lines are nearly
// right. The promises: no crash, no undefined behaviour; what is understood has numbers within reason, and what is not
// has a message.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "controllers/footbot_manual/order.hpp"

namespace {

using namespace tandem::controllers;

constexpr std::array<const char*, 40> kWords = {
    "drive", "stop", "grip", "release", "turret", "off", "passive", "0",      "-0",     "10",
    "0.5",   "1e3",  ".5",   "-.5",     "+1",     "+-1", "1e",      "1e999",  "-1e308", "nan",
    "inf",   "m/s",  "cm/s", "mm/s",    "rad",    "deg", "rad/s",   "deg/s",  "cm",     "%",
    "/s",    "s",    "-",    "+",       ".",      "e",   "e5",      "error:", "\t",     "\r"};

void expect(bool condition) {
  if (!condition) std::abort();
}

void expect_sane(double value) {
  expect(std::fabs(value) <= 1e6);
}

void read(const std::string& line) {
  const auto order = parse_order(line);
  if (!order.ok()) return expect(!order.error().message.empty());
  if (const auto* drive = std::get_if<Drive>(&order.value())) {
    expect_sane(drive->ahead_m_s);
    expect_sane(drive->turn_rad_s);
  } else if (const auto* to = std::get_if<TurretTo>(&order.value())) {
    expect_sane(to->angle_rad);
  } else if (const auto* turn = std::get_if<TurretTurn>(&order.value())) {
    expect_sane(turn->speed_rad_s);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read(std::string(reinterpret_cast<const char*>(data), size));
  std::string words;
  for (std::size_t i = 0; i < size && i < 12; ++i) {
    words += kWords[data[i] % kWords.size()];
    if (data[i] < 200) words += ' ';
  }
  read(words);
  return 0;
}
