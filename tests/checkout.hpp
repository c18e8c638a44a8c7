// Folders of the checkout and of the build that is tested, for tests that read or run files.
#pragma once
#include <string>
#include <vector>

namespace tandem::test {

// Defined in one source file, not by a macro: the paths must not be part of what compiles every other one, so that a
// compiler cache serves all clones.
extern const char* const kSourceDir;  ///< the checkout, without a trailing slash
extern const char* const kBuildDir;   ///< CMake's binary folder of this preset

/// Names of the experiments in configs/, sorted; other files there are parts of them.
std::vector<std::string> experiments();

}  // namespace tandem::test
