#include "study/values.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <set>

#include "core/random/random.hpp"

namespace tandem::study {
namespace {

constexpr double kMostValues = 1e7;

std::string trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1));
}

/// At most 12 digits, so that 3 * 0.1 reads 0.3.
std::string text_of(double value) {
  char digits[40];
  const int n = std::snprintf(digits, sizeof digits, "%.12g", value == 0.0 ? 0.0 : value);
  return {digits, static_cast<std::size_t>(n)};
}

}  // namespace

hal::Result<Quantity> quantity_of(const std::string& text) {
  const std::string word = trimmed(text);
  Quantity q;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), q.number);
  if (error != std::errc() || !std::isfinite(q.number)) return hal::Error{"'" + text + "' must begin with a number"};
  const std::string unit = trimmed({end, static_cast<std::size_t>(word.data() + word.size() - end)});
  if (!unit.empty()) q.unit = " " + unit;
  return q;
}

hal::Result<std::vector<std::string>> list_of(const std::string& text) {
  const char between = text.find(';') != std::string::npos ? ';' : ',';
  std::vector<std::string> values;
  std::set<std::string> seen;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find(between, at), text.size());
    std::string value = trimmed(std::string_view(text).substr(at, end - at));
    if (value.empty()) return hal::Error{"'" + text + "' must be values separated by commas; one of them is empty"};
    if (!seen.insert(value).second) return hal::Error{"'" + value + "' stands twice in the list"};
    values.push_back(std::move(value));
    at = end + 1;
  }
  return values;
}

std::string Span::at(double part) const {
  double value = log ? from * std::pow(to / from, part) : from + (to - from) * part;
  if (part == 0.0) value = from;
  if (part == 1.0) value = to;
  return text_of(whole ? std::round(value) : value) + unit;
}

hal::Result<Span> span_of(const std::string& from, const std::string& to, bool log, bool whole) {
  auto first = quantity_of(from);
  if (!first.ok()) return first.error();
  auto last = quantity_of(to);
  if (!last.ok()) return last.error();
  if (first->unit != last->unit)
    return hal::Error{"'" + from + "' and '" + to + "' have different units; write both with the same one"};
  if (log && (first->number <= 0.0 || last->number <= 0.0))
    return hal::Error{"a logarithmic range needs ends above 0, not '" + from + "' and '" + to + "'"};
  return Span{first->number, last->number, first->unit, log, whole};
}

std::vector<std::string> spread(const Span& span, std::int64_t count) {
  std::vector<std::string> values;
  for (std::int64_t i = 0; i < count; ++i) {
    std::string value = span.at(count == 1 ? 0.0 : static_cast<double>(i) / static_cast<double>(count - 1));
    if (values.empty() || values.back() != value) values.push_back(std::move(value));
  }
  return values;
}

hal::Result<std::vector<std::string>> steps(const Span& span, const std::string& step) {
  auto by = quantity_of(step);
  if (!by.ok()) return by.error();
  if (span.log) return hal::Error{"a logarithmic range takes 'count' instead of 'step'"};
  if (by->unit != span.unit) return hal::Error{"'" + step + "' must have the unit of the range's ends"};
  const double intervals = (span.to - span.from) / by->number;
  if (!(intervals >= 0.0)) return hal::Error{"'" + step + "' does not lead from one end of the range to the other"};
  if (intervals > kMostValues) return hal::Error{"'" + step + "' makes more than ten million values"};
  std::vector<std::string> values;
  const auto last = static_cast<std::int64_t>(std::floor(intervals + 1e-9));
  for (std::int64_t i = 0; i <= last; ++i) {
    const double value = span.from + static_cast<double>(i) * by->number;
    std::string text = text_of(span.whole ? std::round(value) : value) + span.unit;
    if (values.empty() || values.back() != text) values.push_back(std::move(text));
  }
  return values;
}

std::vector<std::vector<std::string>> latin_hypercube(const std::vector<Span>& spans, std::int64_t points,
                                                      std::uint64_t seed) {
  const std::uint64_t own = core::own_seed(seed, "latin hypercube");
  const auto n = static_cast<std::size_t>(points);
  std::vector<std::vector<std::string>> values(spans.size());
  std::vector<std::size_t> parts(n);
  for (std::size_t s = 0; s < spans.size(); ++s) {
    const auto bits = [&](std::size_t i) {
      return core::draw(own, static_cast<std::uint32_t>(s), core::Stream::Plugin, static_cast<std::int64_t>(i));
    };
    std::iota(parts.begin(), parts.end(), std::size_t{0});
    for (std::size_t i = n; i > 1; --i)  // Fisher and Yates
      std::swap(parts[i - 1], parts[static_cast<std::size_t>((std::uint64_t{bits(i)[0]} * i) >> 32)]);
    for (std::size_t i = 0; i < n; ++i) {
      const double within = static_cast<double>(bits(i)[1]) * 0x1p-32;
      values[s].push_back(spans[s].at((static_cast<double>(parts[i]) + within) / static_cast<double>(n)));
    }
  }
  return values;
}

}  // namespace tandem::study
