// The facade is complete in itself: each header compiles alone, as C++11 to C++20, with warnings as errors. What our
// robots lack is a message that names it.
#include <filesystem>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::test {
namespace {

namespace fs = std::filesystem;

TEST(ArgosHeaders, NameNoneOfOurHeaders) {
  std::size_t headers = 0;
  const fs::path top = fs::path(kSourceDir) / "compat/argos3/include";
  for (const auto& entry : fs::recursive_directory_iterator(top)) {
    if (!entry.is_regular_file()) continue;
    std::istringstream lines(scenarios::text_of(entry.path()));
    ++headers;
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("#include")) continue;
      const bool of_the_language = line.starts_with("#include <") && line.find('/') == std::string::npos;
      EXPECT_TRUE(of_the_language || line.starts_with("#include <argos3/") || line == "#include <sys/types.h>")
          << entry.path() << ": " << line;
    }
  }
  EXPECT_GT(headers, 50U);
}

TEST(ArgosHeaders, SayWhatToUseInsteadOfWhatOurRobotsLack) {
  const scenarios::Folder folder;
  folder.write("radio.cpp", "#include <argos3/plugins/robots/generic/control_interface/ci_simple_radios_actuator.h>\n");
  const std::string command = "g++ -fsyntax-only -I" + std::string(kSourceDir) + "/compat/argos3/include " +
                              (folder.path() / "radio.cpp").string() + " 2> " + (folder.path() / "said").string();
  EXPECT_NE(std::system(command.c_str()), 0);
  EXPECT_THAT(scenarios::text_of(folder.path() / "said"),
              testing::AllOf(testing::HasSubstr("CCI_SimpleRadiosActuator"),
                             testing::HasSubstr("Use CCI_RangeAndBearingActuator")));
}

}  // namespace
}  // namespace tandem::test
