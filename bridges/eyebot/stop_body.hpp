// The eye-bot's part of `StopMessages`: in whose name it is to be spoken to, and how its flight is to end.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "bridges/eyebot/bridge.hpp"

namespace tandem::bridges::eyebot {

/// One line: the robot's name, the hub's name, the hub's session, 1 to land or 0 to hover, the first
/// number of a message. The url is in the link.
std::string to_stop_body(const StopDetails& details);

/// The same back, without the url; nothing where the text is not of that form.
std::optional<StopDetails> from_stop_body(std::string_view body);

}  // namespace tandem::bridges::eyebot
