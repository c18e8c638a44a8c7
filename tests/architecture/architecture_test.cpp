#include <fstream>
#include <gtest/gtest.h>
#include <regex>
#include <unistd.h>

#include "tests/architecture/rules.hpp"
#include "tests/checkout.hpp"

namespace tandem::architecture {
namespace {

namespace fs = std::filesystem;

const LibraryOwners kOwners = {
    {"tinyxml2", "hal/xml"},
    {"nlohmann/", "hal/json"},
    {"png.h", "core/field bridges/frames"},
    {"apriltag/", "bridges/apriltag"},
    {"librsvg/", "core/view"},
    {"cairo", "core/view"},
    {"Random123/", "hal"},
    {"Eigen/", "hal mixed_reality/tracking mixed_reality/gap bridges/calibration"},
    {"libserial/", "bridges/link"},
    {"lcm/", "bridges/lcm"},
    {"eyebot/", "bridges/eyebot_messages"},
    {"eyebot_c/", "bridges/eyebot_emulator"},
    {"CLI/", "app"},
    {"fmt/", "app app/lab app/live app/pictures app/real app/study app/window bench validate"},
    {"boost/", "window window/wire"},
    {"hdf5.h", "core/record/hdf5"},
    {"libdeflate.h", "core/record"},
    {"sqlite3", "study/table"},
    {"box2d/", "core/physics/dynamics2d"},
    {"pybind11/", "python"},
    {"Python.h", "python"},
    {"ode/", "core/physics/dynamics3d"}};

TEST(Architecture, HoldsInThisTree) {
  const Dependencies dependencies = read_dependencies(fs::path(test::kBuildDir) / "architecture.txt");
  ASSERT_GT(dependencies.size(), 15U);
  for (const std::string& rule : broken_rules(test::kSourceDir, dependencies, kOwners)) ADD_FAILURE() << rule;
}

/// Lines of the layers' code that match, the files aside whose path does.
std::string lines_that_name(const std::regex& what, const std::vector<std::string>& layers, const std::regex& aside) {
  std::string found;
  std::size_t files = 0;
  for (const std::string& layer : layers) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(test::kSourceDir) / layer)) {
      const std::string path = fs::relative(entry.path(), test::kSourceDir).string();
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
      if (std::regex_search(path, aside)) continue;
      ++files;
      std::ifstream in(entry.path());
      std::string line;
      for (int number = 1; std::getline(in, line); ++number) {
        if (std::regex_search(line, what)) found += path + ":" + std::to_string(number) + ": " + line + "\n";
      }
    }
  }
  EXPECT_GT(files, 150U);
  return found;
}

TEST(Architecture, OneSourceIncludesNlohmann) {
  EXPECT_EQ(lines_that_name(std::regex("nlohmann"),
                            {"app", "bench", "bridges", "controllers", "core", "examples", "hal", "hooks", "library",
                             "mixed_reality", "python", "study", "validate", "window"},
                            std::regex("^hal/json/(json_text\\.cpp|CMakeLists\\.txt)$")),
            "");
}

TEST(Architecture, OnlyItsOwnFoldersAndTheCatalogsPagesNameARobot) {
  EXPECT_EQ(lines_that_name(std::regex("e-?puck|foot-?bot|eye-?bot|thymio", std::regex::icase),
                            {"app", "core", "mixed_reality"},
                            std::regex("^app/(.*catalog\\.cpp|module/module_table\\.hpp)$")),
            "");
}

TEST(Architecture, OnlyItsOwnFolderAndTheCatalogsPageNameAnEngine) {
  EXPECT_EQ(
      lines_that_name(
          std::regex("(kinematics|dynamics|particle)[23]d", std::regex::icase),
          {"app", "core", "mixed_reality", "hal", "hooks"},
          std::regex(
              "^app/(catalog\\.cpp|dynamics/register\\.cpp|module/module_table\\.hpp)$|^core/physics/[a-z]+[23]d/")),
      "");
}

/// A small tree that breaks one rule at a time.
class CheatingTree : public testing::Test {
 protected:
  CheatingTree() : top_(fs::path(testing::TempDir()) / ("tandem_cheating_tree_" + std::to_string(getpid()))) {
    fs::remove_all(top_);
    write("hal/port.hpp", "");
    write("core/space/space.hpp", "#include \"hal/port.hpp\"\n");
  }
  ~CheatingTree() override { fs::remove_all(top_); }

  void write(const std::string& path, const std::string& text) {
    fs::create_directories((top_ / path).parent_path());
    std::ofstream(top_ / path) << text;
  }
  std::string broken() {
    std::string all;
    for (const std::string& rule : broken_rules(top_, dependencies_, kOwners)) all += rule + "\n";
    return all;
  }

  fs::path top_;
  Dependencies dependencies_ = {
      {"hal", {}}, {"core/space", {"hal"}}, {"core/device", {"hal"}}, {"bridges/link", {"hal"}}};
};

TEST_F(CheatingTree, IsFineAsLongAsItDoesNot) {
  EXPECT_EQ(broken(), "");
}

TEST_F(CheatingTree, IncludesWhatItDoesNotDeclare) {
  write("core/device/device.hpp", "\n#include \"core/space/space.hpp\"\n");
  EXPECT_EQ(broken(), "core/device/device.hpp:2: core/device does not declare core/space\n");
}

TEST_F(CheatingTree, DependsAgainstTheLayers) {
  dependencies_["bridges/link"].insert("core/space");
  EXPECT_EQ(broken(), "bridges/link/CMakeLists.txt: bridges/link may not depend on core/space\n");
}

TEST_F(CheatingTree, IncludesALibraryOutsideItsFolder) {
  write("core/space/xml.cpp", "#include <tinyxml2.h>\n");
  EXPECT_EQ(broken(), "core/space/xml.cpp:1: <tinyxml2.h> belongs to hal/xml alone\n");
}

TEST_F(CheatingTree, HasARoomForEverything) {
  fs::create_directories(top_ / "core/utils");
  EXPECT_EQ(broken(), "core/utils: a folder's name says what is in it\n");
}

TEST_F(CheatingTree, IncludesByAShortName) {
  write("hal/other.hpp", "#include \"port.hpp\"\n");
  EXPECT_NE(broken().find("is not named from the top"), std::string::npos);
}

TEST_F(CheatingTree, HasSubFoldersInACircle) {
  write("hal/a/a.hpp", "#include \"hal/b/b.hpp\"\n#include \"hal/port.hpp\"\n");
  write("hal/b/b.hpp", "");
  EXPECT_EQ(broken(), "");
  write("hal/b/b.cpp", "#include \"hal/c/c.hpp\"\n");
  write("hal/c/c.hpp", "#include \"hal/a/a.hpp\"\n");
  EXPECT_NE(broken().find("hal/a and hal/b include one another, in a circle"), std::string::npos);
}

TEST_F(CheatingTree, HasTwoTypesOfOneName) {
  write("hal/device.hpp", "namespace tandem::hal {\nstruct Frame {\n};\n}\n");
  write("core/device/device.hpp", "namespace tandem::core {\nclass Frame final : Base {\n};\n}\n");
  EXPECT_EQ(broken(), "");
  write("core/space/frame.hpp", "namespace tandem::core {\nclass Other;\nstruct Frame {\n};\n}\n");
  EXPECT_NE(broken().find("tandem::core::Frame is defined by core/"), std::string::npos) << broken();
}

}  // namespace
}  // namespace tandem::architecture
