#include "tests/checkout.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace tandem::test {

const char* const kSourceDir = TANDEM_SOURCE_DIR;
const char* const kBuildDir = TANDEM_BINARY_DIR;

std::vector<std::string> experiments() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(kSourceDir) + "/configs")) {
    if (entry.path().extension() != ".xml") continue;
    std::ifstream in(entry.path());
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (text.find("<framework") != std::string::npos) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace tandem::test
