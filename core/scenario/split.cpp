#include "core/scenario/split.hpp"

#include <charconv>

namespace tandem::core {
namespace {

constexpr std::size_t kMostDigits = 3;

std::optional<std::size_t> parse_count(std::string_view text) noexcept {
  if (text.empty() || text.size() > kMostDigits || text.front() == '0') return std::nullopt;
  std::size_t count = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (problem != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return count;
}

}  // namespace

std::optional<Split> parse_split(std::string_view text) noexcept {
  const std::size_t x = text.find('x');
  if (x == std::string_view::npos) return std::nullopt;
  const auto columns = parse_count(text.substr(0, x));
  const auto lines = parse_count(text.substr(x + 1));
  if (!columns || !lines) return std::nullopt;
  return Split{*columns, *lines};
}

}  // namespace tandem::core
