// SHA-256, so that a report can say which controller file exactly was run.
#pragma once
#include <string>

#include "hal/result.hpp"

namespace tandem::app {

/// Hexadecimal digest [FIPS 180-4] of some bytes.
std::string sha256(const std::string& bytes);

/// Digest of a file. Error: it cannot be read.
hal::Result<std::string> sha256_of_file(const std::string& path);

}  // namespace tandem::app
