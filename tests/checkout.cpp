#include "tests/checkout.hpp"

namespace tandem::test {

const char* const kSourceDir = TANDEM_SOURCE_DIR;
const char* const kBuildDir = TANDEM_BINARY_DIR;

}  // namespace tandem::test
