// Preflight: everything that would stop a run with real robots, found before anything moves.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mixed_reality/session/mixed_session.hpp"

namespace tandem::mixed_reality {

/// Ok: as it is to be. Warn: the run begins, and may be worse for it. Fail: it would not begin, or its robots not
/// drive.
enum class Finding : std::uint8_t { Ok, Warn, Fail };
std::string_view name_of(Finding finding) noexcept;  ///< "ok", "warn", "fail"

struct PreflightRow {
  std::string about;  ///< "robot ep0", "tracker cam", "machine"
  std::string check;  ///< "link"
  Finding finding = Finding::Ok;
  std::string found;   ///< for people
  std::string advice;  ///< what to do; empty where nothing is
};
using PreflightRows = std::vector<PreflightRow>;

/// The worst of them.
Finding worst_of(const PreflightRows& rows) noexcept;

/// Links, firmware, readings, round trips, batteries, places, trackers and arena, as they are now. By the thread that
/// owns the session: after a while of MixedSession::stand_by, or between two ticks of a run.
PreflightRows look_over(const MixedSession& session);
/// This computer. `late`: how late the program woke up while it stood by.
PreflightRows look_over_machine(const core::Scenario& scenario, const hal::DurationHistogram& late);

/// First motion: the robot turns to the left and back by about 30 degrees, and its wheels and trackers are to have seen
/// that, of this robot and no other. Its row comes first, then one for each other robot that turned. Before a run, or
/// while one is held.
PreflightRows try_motion(MixedSession& session, const std::string& robot, const std::atomic<bool>& stop);

}  // namespace tandem::mixed_reality
