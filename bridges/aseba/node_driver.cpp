#include "bridges/aseba/node_driver.hpp"

namespace tandem::bridges::aseba {

const char* state_name(RobotState state) noexcept {
  switch (state) {
    case RobotState::Absent:
      return "absent";
    case RobotState::Searching:
      return "searching";
    case RobotState::Ready:
      return "ready";
    case RobotState::Active:
      return "active";
    case RobotState::Suspect:
      return "suspect";
    case RobotState::Lost:
      return "lost";
  }
  return "";
}

hal::Log detail::named(const hal::Log& log, const std::string& who) {
  return hal::Log([log, who](hal::Severity severity, std::string_view text) {
    const std::string line = who + std::string(text);
    if (severity == hal::Severity::Info) return log.info(line);
    if (severity == hal::Severity::Warning) return log.warning(line);
    log.error(line);
  });
}

}  // namespace tandem::bridges::aseba
