#include "core/sim/incidents.hpp"

#include <algorithm>

#include "hal/printable.hpp"

namespace tandem::core {
namespace {

constexpr bool is_digit(char c) noexcept {
  return c >= '0' && c <= '9';
}

/// Behind the number that begins at `at`: "12", "0.5", "1e-05".
std::size_t end_of_number(std::string_view text, std::size_t at) noexcept {
  const auto digits = [&] {
    while (at < text.size() && is_digit(text[at])) ++at;
  };
  const auto follows = [&](std::size_t i) { return i < text.size() && is_digit(text[i]); };
  digits();
  if (at < text.size() && text[at] == '.' && follows(at + 1)) {
    ++at;
    digits();
  }
  const std::size_t sign = at + 1 < text.size() && (text[at + 1] == '-' || text[at + 1] == '+') ? 1 : 0;
  if (at < text.size() && text[at] == 'e' && follows(at + 1 + sign)) {
    at += 1 + sign;
    digits();
  }
  return at;
}

}  // namespace

std::string cause_of(std::string_view text) {
  std::string cause;
  for (std::size_t at = 0; at < text.size();) {
    if (!is_digit(text[at])) {
      cause += text[at++];
      continue;
    }
    const std::size_t end = end_of_number(text, at);
    const bool place = cause.ends_with("line ") || (cause.ends_with(':') && end < text.size() && text[end] == ':');
    if (!place && (cause.ends_with(" -") || cause.ends_with("(-"))) cause.pop_back();
    cause += place ? text.substr(at, end - at) : std::string_view("#");
    at = end;
  }
  return cause;
}

std::string with_others(std::string_view who, std::size_t others, std::string_view what) {
  return std::string(who) + (others > 0 ? " (and " + std::to_string(others) + " more)" : std::string()) +
         std::string(what);
}

void Incidents::note(std::uint32_t body, std::string who, std::string what) {
  who = hal::printable(who);
  what = hal::printable(hal::shortened(what));
  std::string key = cause_of(what);
  auto cause = std::find_if(causes.begin(), causes.end(), [&](const IncidentCause& c) { return c.key == key; });
  if (cause == causes.end()) {
    if (causes.size() == kCauses) return;
    first.push_back(who + what);
    cause = causes.insert(cause, {std::move(key), std::move(who), std::move(what), {}, 0});
  }
  latest = static_cast<std::uint64_t>(cause - causes.begin());
  const auto place = std::lower_bound(cause->met.begin(), cause->met.end(), body);
  if (place == cause->met.end() || *place != body) cause->met.insert(place, body);
}

void Incidents::tell(const hal::Log& log, bool all, hal::Severity severity) {
  for (std::size_t i = 0; i < causes.size(); ++i) {
    IncidentCause& cause = causes[i];
    if (cause.met.size() == cause.told) continue;
    first[i] = with_others(cause.who, cause.met.size() - 1, cause.what);
    if (cause.told > 0 && !all) continue;
    log.write(severity, (cause.told > 0 ? "by the end: " : "") + first[i]);
    cause.told = cause.met.size();
  }
}

}  // namespace tandem::core
