// The facade is complete in itself: each header compiles alone, as C++11 to C++20, with warnings as errors. What our
// robots lack is a message that names it.
#include <algorithm>
#include <cctype>
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

/// What the compiler says of a source; it must not take it.
std::string refused(const std::string& source) {
  const scenarios::Folder folder;
  folder.write("a.cpp", source);
  const std::string command = "g++ -std=c++11 -fsyntax-only -I" + std::string(kSourceDir) + "/compat/argos3/include " +
                              (folder.path() / "a.cpp").string() + " 2> " + (folder.path() / "said").string();
  EXPECT_NE(std::system(command.c_str()), 0) << source;
  return scenarios::text_of(folder.path() / "said");
}

TEST(ArgosHeaders, SayWhatToUseInsteadOfWhatTheyLeaveOut) {
  const fs::path top = fs::path(kSourceDir) / "compat/argos3/include";
  std::size_t left_out = 0;
  for (const auto& entry : fs::recursive_directory_iterator(top)) {
    if (!entry.is_regular_file() || scenarios::text_of(entry.path()).find("\n#error") == std::string::npos) continue;
    ++left_out;
    const std::string header = fs::relative(entry.path(), top).string();
    EXPECT_THAT(refused("#include <" + header + ">\n"),
                testing::AllOf(testing::ContainsRegex("Tandem's ARGoS layer has no [A-Za-z0-9_]+ \\("),
                               testing::HasSubstr("(" + entry.path().filename().string() + "). ")))
        << header;
  }
  EXPECT_GT(left_out, 60U);
  for (const char* role : {"sensor", "actuator"}) {
    std::string macro = std::string("REGISTER_") + role;
    std::transform(macro.begin(), macro.end(), macro.begin(), [](unsigned char c) { return std::toupper(c); });
    EXPECT_THAT(refused("#include <argos3/core/control_interface/ci_" + std::string(role) + ".h>\n" + macro +
                        "(CMine, \"mine\", \"default\", \"me\", \"1\", \"a\", \"b\", \"usable\");\n"),
                testing::HasSubstr("own " + std::string(role) + "s: make a plug-in"));
  }
}

}  // namespace
}  // namespace tandem::test
