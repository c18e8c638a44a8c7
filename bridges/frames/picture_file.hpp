// Pictures in files: PNG and PGM.
#pragma once
#include <string>

#include "bridges/frames/frame.hpp"
#include "hal/result.hpp"

namespace tandem::bridges::frames {

/// As grey. Errors: it cannot be read, it is neither, it is too large.
hal::Result<Frame> read_picture(const std::string& path);

}  // namespace tandem::bridges::frames
