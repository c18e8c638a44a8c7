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

void meet(IncidentCause& cause, std::uint32_t body) {
  const auto place = std::ranges::lower_bound(cause.met, body);
  if (place == cause.met.end() || *place != body) cause.met.insert(place, body);
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

std::string IncidentCause::text() const {
  return with_others(who, met.size() - 1, what);
}

void Incidents::note(std::uint32_t body, std::string who, std::string what) {
  who = hal::printable(who);
  what = hal::printable(hal::shortened(what));
  std::string key = cause_of(what);
  auto cause = std::find_if(causes.begin(), causes.end(), [&](const IncidentCause& c) { return c.key == key; });
  if (cause == causes.end()) {
    if (causes.size() == kCauses) return;
    cause = causes.insert(cause, {std::move(key), std::move(who), std::move(what), {}, 0});
  }
  latest = static_cast<std::uint64_t>(cause - causes.begin());
  meet(*cause, body);
}

bool Incidents::note_again(std::uint32_t body, std::string_view begin) {
  const auto cause = std::ranges::find_if(causes, [&](const IncidentCause& c) { return c.key.starts_with(begin); });
  if (cause == causes.end()) return false;
  latest = static_cast<std::uint64_t>(cause - causes.begin());
  meet(*cause, body);
  return true;
}

std::vector<std::string> Incidents::first() const {
  std::vector<std::string> texts;
  for (const IncidentCause& cause : causes) texts.push_back(cause.text());
  return texts;
}

void Incidents::tell(const hal::Log& log, bool all, hal::Severity severity) {
  for (IncidentCause& cause : causes) {
    if (cause.met.size() == cause.told || (cause.told > 0 && !all)) continue;
    log.write(severity, (cause.told > 0 ? "by the end: " : "") + cause.text());
    cause.told = cause.met.size();
  }
}

}  // namespace tandem::core
