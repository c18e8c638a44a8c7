// Re-arming: under which condition and after which time a stopped robot may drive again.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "hal/params.hpp"
#include "hal/result.hpp"

namespace tandem::mixed_reality {

/// Re-arming of a stopped robot. In any case: a robot that is not proved to be the one that was armed (proof.hpp)
/// waits for a person.
enum class RearmBy : std::uint8_t {
  Proved,    ///< a short outage ends by itself; every other stop waits for a person
  Operator,  ///< every stop waits for a person
  Time,      ///< every stop ends by itself when all has been well for a time
  Never      ///< a short outage ends by itself; after every other stop it stands until the end of the run
};

/// Policy of `<bridge rearm="proved|operator|after 2 s|never">`.
struct RearmPolicy {
  RearmBy by = RearmBy::Proved;
  double after_s = 0.0;  ///< with Time: for so long all must have been well

  friend bool operator==(const RearmPolicy&, const RearmPolicy&) = default;
};

/// Reads "proved", "operator", "never" or "after <time>", a bare number being seconds. Error: what was written, and
/// what would do.
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
