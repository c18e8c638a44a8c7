#include "mixed_reality/safety/rearm.hpp"

#include "hal/unit.hpp"

namespace tandem::mixed_reality {

hal::Result<RearmPolicy> parse_rearm(std::string_view text) {
  constexpr std::string_view kAfter = "after ";
  if (text == "proved") return RearmPolicy{RearmBy::Proved, 0.0};
  if (text == "operator") return RearmPolicy{RearmBy::Operator, 0.0};
  if (text == "never") return RearmPolicy{RearmBy::Never, 0.0};
  const std::string wrong =
      "'" + std::string(text) + "' is no way to re-arm; there are: proved, operator, after 2 s, never";
  if (!text.starts_with(kAfter)) return hal::Error{wrong};
  const hal::Result<double> after_s = hal::parse_quantity(text.substr(kAfter.size()), hal::unit::s);
  if (!after_s.ok()) return hal::Error{wrong + " (" + after_s.error().message + ")"};
  if (after_s.value() < 0.0) return hal::Error{wrong + " (a time is not negative)"};
  return RearmPolicy{RearmBy::Time, after_s.value()};
}

std::string to_text(const RearmPolicy& policy) {
  if (policy.by == RearmBy::Proved) return "proved";
  if (policy.by == RearmBy::Operator) return "operator";
  if (policy.by == RearmBy::Never) return "never";
  return "after " + hal::format_quantity(policy.after_s, hal::unit::s);
}

}  // namespace tandem::mixed_reality
