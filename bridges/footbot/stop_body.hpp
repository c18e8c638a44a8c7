// The foot-bot's part of `StopMessages`: the messages that have its variables rest, as text.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bridges/footbot/wiring.hpp"

namespace tandem::bridges::footbot {

/// One message a line: its type, a blank, its payload in hexadecimal digits, "read back" where it is to be confirmed.
std::string to_stop_body(const std::vector<RestMessage>& messages);

/// The same back; nothing where the text is not of that form.
std::optional<std::vector<RestMessage>> from_stop_body(std::string_view body);

}  // namespace tandem::bridges::footbot
