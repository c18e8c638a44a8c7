#include "hal/unit.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace tandem::hal {
namespace {

constexpr std::array kUnits = {unit::percent, unit::m,   unit::cm,    unit::mm,    unit::m_s, unit::cm_s, unit::mm_s,
                               unit::rad,     unit::deg, unit::rad_s, unit::deg_s, unit::s,   unit::ms,   unit::us,
                               unit::min,     unit::hz,  unit::kg,    unit::g,     unit::V,   unit::m_s2};

std::string suffixes_of(Dim dim) {
  std::string list;
  for (const Unit& u : kUnits) {
    if (u.dim != dim) continue;
    if (!list.empty()) list += ", ";
    list += u.symbol;
  }
  return list.empty() ? "none" : list;
}

}  // namespace

std::string_view trimmed(std::string_view text) noexcept {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::span<const Unit> all_units() noexcept {
  return kUnits;
}

Result<double> parse_quantity(std::string_view text, const Unit& bare) {
  const std::string_view body = trimmed(text);
  std::string_view digits = body;
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  double number = 0.0;
  const auto [end, status] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (status != std::errc{} || !std::isfinite(number)) {
    return Error{"'" + std::string(text) + "' is not a number"};
  }
  const std::string_view suffix = trimmed({end, static_cast<std::size_t>(digits.data() + digits.size() - end)});
  if (suffix.empty() || suffix == bare.symbol) return number * bare.to_si;  // a unit of somebody's own, perhaps
  for (const Unit& u : kUnits) {
    if (u.symbol == suffix && u.dim == bare.dim) return number * u.to_si;
  }
  return Error{"'" + std::string(text) + "': unit '" + std::string(suffix) +
               "' does not fit; use one of: " + suffixes_of(bare.dim)};
}

std::string format_number(double value) {
  std::array<char, 32> buffer{};
  const auto [end, status] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return status == std::errc{} ? std::string(buffer.data(), end) : std::string("?");
}

namespace {

std::string with_symbol(double number, const Unit& unit) {
  std::string text = format_number(number);
  if (!unit.symbol.empty()) text += " " + std::string(unit.symbol);
  return text;
}

}  // namespace

std::string format_quantity(double value_si, const Unit& unit) {
  // Round to 12 digits so that 0.05 m/s reads "5 cm/s" and not "5.000000000000001 cm/s".
  double shown = value_si / unit.to_si;
  if (shown != 0.0 && std::isfinite(shown)) {
    const double scale = std::pow(10.0, 12.0 - std::ceil(std::log10(std::fabs(shown))));
    shown = std::round(shown * scale) / scale;
  }
  return with_symbol(shown, unit);
}

std::string format_exactly(double value_si, const Unit& unit) {
  const auto reads_back = [&](const std::string& text) {
    const Result<double> read = parse_quantity(text, unit);
    return read.ok() && read.value() == value_si;
  };
  std::string text = format_quantity(value_si, unit);
  if (reads_back(text)) return text;
  for (const Unit& si : kUnits) {
    if (si.dim == unit.dim && si.to_si == 1.0) return with_symbol(value_si, si);
  }
  // A unit of no dimension: what is nearest to the quotient and gives the value when multiplied again.
  double shown = value_si / unit.to_si;
  for (const double direction : {-HUGE_VAL, HUGE_VAL}) {
    double near = shown;
    for (int i = 0; i < 4 && near * unit.to_si != value_si; ++i) near = std::nextafter(near, direction);
    if (near * unit.to_si == value_si) shown = near;
  }
  return with_symbol(shown, unit);
}

}  // namespace tandem::hal
