// Instructions for stopping one robot without its hub, as plain text for the guardian process.
#pragma once
#include <cstdint>
#include <string>

#include "bridges/robot_identity.hpp"

namespace tandem::bridges {

/// Everything that it takes to stop one real robot. `version` grows whenever any other field changes (a module came, a
/// session began), so that keepers of copies know when to renew them.
struct StopMessages {
  std::string robot;  ///< its id in the experiment, for people
  std::string kind;   ///< names the `StopperType` that understands `body`, e.g. "e-puck"
  std::string link;   ///< LINK text with absolute paths: the guardian has no other folder to start from
  std::string body;   ///< the kind's own; any bytes
  std::uint64_t version = 0;
  std::string name = {};        ///< which robot, where several share the link (an eye-bot's name); else ""
  RobotIdentity identity = {};  ///< its identity, as far as known by now

  friend bool operator==(const StopMessages&, const StopMessages&) = default;
};

}  // namespace tandem::bridges
