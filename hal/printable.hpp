// Texts of strangers, made harmless before people, terminals and files get them.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace tandem::hal {

/// A message of a controller, a plug-in or a script is cut to this many bytes.
inline constexpr std::size_t kLongestMessage = 4096;

/// Foreign `text` as a terminal may get it: control characters but tabs and line ends, and bytes that are no
/// UTF-8, become \x1b and the like; characters that turn or hide what stands beside them (bidirectional controls,
/// characters without width, the other line ends of Unicode) become \u202e and the like.
std::string printable(std::string_view text);

/// `text` as one entry of a log: printable, and its further lines are indented, so that none can pass for an entry.
std::string printable_entry(std::string_view text);

/// At most `most` bytes of `text`, whole characters; what was cut is said.
std::string shortened(std::string_view text, std::size_t most = kLongestMessage);

}  // namespace tandem::hal
