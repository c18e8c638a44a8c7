// Input files: regular files alone. Devices, pipes and sockets, which may never end, and folders are refused.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include "hal/result.hpp"

namespace tandem::hal {

/// A file is read whole up to this size, unless its reader allows less or more.
inline constexpr std::size_t kLargestInput = std::size_t{1} << 30;

/// A descriptor for reading, close-on-exec; the caller closes it. Never waits. Errors, each "WHAT 'PATH': why": not
/// there, no permission, no regular file. `what`: as messages call it, "the script"; empty: the message is the reason
/// alone.
Result<int> open_input_file(const std::string& path, std::string_view what);

/// Whether `open_input_file` would open it.
Status check_input_file(const std::string& path, std::string_view what);

/// All bytes of a file. Errors: those of `open_input_file`; larger than `most_bytes`; it cannot be read to its end.
Result<std::string> read_whole_file(const std::string& path, std::string_view what,
                                    std::size_t most_bytes = kLargestInput);

}  // namespace tandem::hal
