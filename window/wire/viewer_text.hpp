// Texts of viewers: read into commands. Anybody may have written them.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "hal/json/json.hpp"
#include "hal/result.hpp"
#include "hal/user_role.hpp"

namespace tandem::window {

using hal::UserRole;

inline constexpr std::size_t kMostTextBytes = std::size_t{64} << 10;
inline constexpr int kMostTextDepth = 32;
inline constexpr std::size_t kMostIdBytes = 64;

struct ViewerCommand {
  hal::Json id;      ///< number or short text: of the answer; null: none is wanted
  std::string name;  ///< what stands under "do"
  hal::Json whole;   ///< the object without its id
};

/// Errors: no JSON object, deeper than kMostTextDepth, no text "do", an id that is neither a number nor a short text.
hal::Result<ViewerCommand> read_viewer_text(std::string_view text);

/// Whether this role may say this command. A viewer may ask how things are and stop all real robots: a stop
/// is harmless, and what follows it needs an operator.
bool may_say(UserRole role, std::string_view command) noexcept;

/// The texts of a list under this name; what is no list of texts is an error that says so. Absent: empty.
hal::Result<std::vector<std::string>> text_list(const hal::Json& object, const char* name);

}  // namespace tandem::window
