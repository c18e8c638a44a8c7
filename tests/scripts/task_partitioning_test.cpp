// The case study's script, on a small scale: what it draws is what the runs gave.
#include <cmath>
#include <gmock/gmock.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::Folder;
using scenarios::text_of;
using testing::HasSubstr;
using testing::Not;

const std::string kScript = std::string(test::kSourceDir) + "/scripts/task_partitioning.py";

/// Runs python3 in `folder`; what it printed is in the files out and err there. @returns its exit code
int python(const Folder& folder, const std::string& arguments) {
  const std::string in_folder = "cd '" + folder.path().string() + "' && python3 -B ";
  const int status = std::system((in_folder + arguments + " >out 2>err </dev/null").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string program() {
  return " --program " + std::string(test::kBuildDir) + "/bin/tandem ";
}

std::vector<std::vector<double>> table(const std::filesystem::path& csv) {
  std::ifstream in(csv);
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(in, line);  // the header
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

TEST(TaskPartitioningScript, DrawsWhatTheRunsGave) {
  const Folder folder;
  ASSERT_EQ(python(folder, kScript + program() + "--seeds 2 --seconds 600 --carries 1,2 --output figures"), 0)
      << text_of(folder.path() / "err");
  const auto figures = folder.path() / "figures";

  // Of each kind the mean of both seeds every two minutes, and their difference.
  const auto ideal = table(figures / "ideal.csv");
  const auto noise = table(figures / "noise.csv");
  const auto difference = table(figures / "difference.csv");
  ASSERT_EQ(ideal.size(), 5U);
  ASSERT_EQ(noise.size(), 5U);
  ASSERT_EQ(difference.size(), 5U);
  double all = 0.0;
  for (std::size_t i = 0; i < 5; ++i) {
    for (const auto& [of_kind, kind] : {std::pair(&ideal, "ideal"), std::pair(&noise, "noise")}) {
      const auto one = table(figures / ("throughput_" + std::string(kind) + "_2_1.csv"));
      const auto two = table(figures / ("throughput_" + std::string(kind) + "_2_2.csv"));
      const auto& row = (*of_kind)[i];
      EXPECT_EQ(row[0], 2.0 * static_cast<double>(i + 1));
      EXPECT_NEAR(row[1], 0.5 * (one[i][1] + two[i][1]), 1e-5);
      EXPECT_NEAR(row[3] - row[1], 12.7062 * 0.5 * std::fabs(one[i][1] - two[i][1]), 1e-3);  // Student's t, 1 degree
      all += row[1];
    }
    EXPECT_NEAR(difference[i][1], ideal[i][1] - noise[i][1], 1e-5);
  }
  EXPECT_GT(all, 0.0) << "nobody brought anything";
  EXPECT_EQ(table(figures / "carries.csv").size(), 2U);

  // 61 robots end elsewhere than the one with ideal treels, which comes home.
  const auto ends = table(figures / "shuttle_ends.csv");
  ASSERT_EQ(ends.size(), 61U);
  double error_m = 0.0;
  for (const auto& end : ends) error_m += std::hypot(end[0] + 2.0, end[1]) / 61.0;
  EXPECT_GT(error_m, 0.5);
  EXPECT_THAT(text_of(folder.path() / "out"), HasSubstr("error after 4 m there and 4 m back, 61 seeds: mean "));

  for (const char* name : {"throughput.svg", "carries.svg", "shuttle.svg"}) {
    const std::string svg = text_of(figures / name);
    EXPECT_THAT(svg, HasSubstr("</svg>")) << name;
    EXPECT_THAT(svg, HasSubstr("seeds")) << name;
  }
}

TEST(TaskPartitioningScript, KnowsItsStatistics) {
  const Folder folder;
  // Quantiles of Student's t from tables. Wilcoxon's interval of ten pairs is from the 9th to the 47th of the 55 Walsh
  // averages: 8 is the critical value of the test at 5 % [Hollander and Wolfe 1999, table A.4].
  folder.write("check.py", "import sys\nsys.path.insert(0, '" + std::string(test::kSourceDir) + R"(/scripts')
import task_partitioning as t
for v, q in ((1, 12.706), (2, 4.303), (3, 3.182), (5, 2.571), (9, 2.262), (29, 2.045)):
    assert abs(t.student(v) / q - 1) < 0.01, v
d = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512]
walsh = sorted((a + b) / 2 for i, a in enumerate(d) for b in d[i:])
assert t.signed_rank(d) == (walsh[27], walsh[8], walsh[46])
assert t.signed_rank([-x for x in d]) == (-walsh[27], -walsh[46], -walsh[8])
)");
  EXPECT_EQ(python(folder, "check.py"), 0) << text_of(folder.path() / "err");
}

TEST(TaskPartitioningScript, SaysWhatIsWrong) {
  const Folder folder;
  EXPECT_EQ(python(folder, kScript + program() + "--seeds 1"), 2);
  EXPECT_THAT(text_of(folder.path() / "err"), HasSubstr("two seeds and 120 seconds"));
  EXPECT_EQ(python(folder, kScript + program() + "--seeds 2 --seconds 120 --carry -1 --carries '' --output f"), 1);
  EXPECT_THAT(text_of(folder.path() / "err"), HasSubstr("footbot_task_partitioning_ideal.xml failed"));
  EXPECT_THAT(text_of(folder.path() / "err"), Not(HasSubstr("Traceback")));
}

}  // namespace
}  // namespace tandem
