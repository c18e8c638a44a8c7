// Re-arming: under which condition and after which time a stopped robot may drive again.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "hal/params.hpp"
#include "hal/result.hpp"

namespace tandem::mixed_reality {

/// Who re-arms a stopped robot. Operator: a person says so. Time: nobody, it goes by itself after
/// all has been well for a time. Never: it stands until the end of the run.
enum class RearmBy : std::uint8_t { Operator, Time, Never };

/// Policy of `<bridge rearm="operator|after 2 s|never">`.
struct RearmPolicy {
  RearmBy by = RearmBy::Time;
  double after_s = 2.0;  ///< with Time: for so long all must have been well

  friend bool operator==(const RearmPolicy&, const RearmPolicy&) = default;
};

/// Reads "operator", "never" or "after <time>", a bare number being seconds. Error: what was written, and what would
/// do.
hal::Result<RearmPolicy> parse_rearm(std::string_view text);
/// The text that `parse_rearm` reads back.
std::string to_text(const RearmPolicy& policy);

/// Re-arming of a stopped robot.
///
/// From a link that is back, to driving: `settle_s` after the first tick in which all is well, at once with the ramp.
struct RearmParams {
  RearmPolicy policy = {};  ///< for the stops whose row of the safety table needs a re-arm
  double settle_s = 0.3;    ///< after every other stop, all must have been well for this long
  double ramp_m_s2 = 0.25;  ///< then the largest speed grows from 0 by this
  void describe(hal::ParamVisitor& v) {
    v.number("settle_after", settle_s, hal::unit::s, {0.0, 60.0},
             "All must have been well for this long before a stopped robot drives again.");
    v.number("rearm_ramp", ramp_m_s2, hal::unit::m_s2, {0.001, 100.0}, "Its largest speed then grows from 0 by this.");
  }
};

}  // namespace tandem::mixed_reality
