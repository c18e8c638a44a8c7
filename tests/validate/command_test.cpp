// The short form of `tandem validate`, as a person calls it.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>

#include "hal/json/json.hpp"
#include "tests/checkout.hpp"

namespace tandem {
namespace {

std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(ValidateCommand, WritesOneReportAndEndsByItsVerdicts) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "validation_short";
  std::filesystem::remove_all(folder);
  const int ended =
      std::system((std::string(test::kBuildDir) + "/bin/tandem" + " validate --short -o " + folder.string()).c_str());
  const hal::Json report = hal::parse_json(contents(folder / "validation.json")).value();
  const int failed = report["count"]["not_met"].get<int>() + report["count"]["not_made"].get<int>();
  EXPECT_EQ(WEXITSTATUS(ended), failed == 0 ? 0 : 4);
  EXPECT_GE(report["count"]["met"].get<int>(), 100);
  EXPECT_EQ(report["count"]["not_made"].get<int>(), 0);
  EXPECT_FALSE(report["about"]["fingerprint of the rows"].get<std::string>().empty());
  for (const char* title : {"Braking by friction", "Flying: hovering", "lens downwards, eye-bot", "distance scanner"})
    EXPECT_NE(contents(folder / "validation.html").find(title), std::string::npos) << title;
  EXPECT_EQ(contents(folder / "validation.pdf").substr(0, 5), "%PDF-");
}

}  // namespace
}  // namespace tandem
