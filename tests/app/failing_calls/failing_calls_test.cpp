// One call of a run fails: an allocation, a thread, something opened, read or written. TANDEM_FAULT_RUNS=N lets each of
// the first N calls of every kind fail, one a run; else it is a selection of the first 2,000.
#include <cstdlib>
#include <gmock/gmock.h>
#include <sstream>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::Folder;
using scenarios::Tandem;
using scenarios::text_of;

constexpr const char* kExperiment = R"(<tandem>
  <framework><experiment length="1" ticks_per_second="10" random_seed="7"/><system threads="2"/></framework>
  <controllers>
    <epuck_diffusion id="walk" library="epuck_diffusion">
      <actuators><differential_steering/></actuators>
      <sensors><proximity implementation="noisy" noise_level="0.02"/></sensors>
      <params alpha="7.5" delta="0.1" velocity="5 cm/s"/>
    </epuck_diffusion>
  </controllers>
  <arena size="4,4,1">
    <distribute>
      <position method="uniform" min="-1,-1,0" max="1,1,0"/>
      <orientation method="uniform" min="0,0,0" max="360,0,0"/>
      <entity quantity="5" max_trials="1000"><e-puck id="ep"><controller config="walk"/></e-puck></entity>
    </distribute>
  </arena>
</tandem>
)";

std::vector<int> chosen_calls() {
  std::vector<int> all;
  const char* const asked = std::getenv("TANDEM_FAULT_RUNS");
  if (asked != nullptr) {
    for (int n = 1; n <= std::atoi(asked); ++n) all.push_back(n);
  } else {
    for (double n = 1.0; n <= 2000.0; n = std::max(n + 1.0, 1.4 * n)) all.push_back(static_cast<int>(n));
  }
  return all;
}

bool whole_report(const std::string& text) {
  return text == "old\n" ||
         (text.starts_with("{\"finished\"") && text.ends_with("}\n") && text.find("</tandem>") != std::string::npos);
}

bool whole_trajectory(const std::string& text) {
  if (text == "old\n") return true;
  std::istringstream in(text);
  std::string line;
  std::getline(in, line);
  if (line != "tick,time_s,id,x_m,y_m,z_m,heading_rad" || !text.ends_with('\n')) return false;
  while (std::getline(in, line)) {
    if (std::count(line.begin(), line.end(), ',') != 6) return false;
  }
  return true;
}

class FailingCalls : public testing::TestWithParam<const char*> {};

TEST_P(FailingCalls, AreToldAndLeaveWholeOutputs) {
  Folder folder;
  folder.write("e.xml", kExperiment);
  ASSERT_EQ(
      setenv("LD_PRELOAD", (std::string(test::kBuildDir) + "/tests/failing_calls/libfailing_calls.so").c_str(), 1), 0);
  int failed = 0;
  for (const int n : chosen_calls()) {
    const std::string which = std::string(GetParam()) + ":" + std::to_string(n);
    folder.write("r.json", "old\n");
    folder.write("t.csv", "old\n");
    setenv("TANDEM_FAILING_CALL", which.c_str(), 1);
    Tandem run({"run", "e.xml", "--report", "r.json", "--trajectory", "t.csv", "--picture", "p.svg"}, folder.path());
    const int code = run.wait(60);
    unsetenv("TANDEM_FAILING_CALL");
    const std::string said = run.errors();
    EXPECT_TRUE(code == 0 || code == 1 || code == 3) << which << ": " << code << "\n" << said;
    EXPECT_EQ(code == 0, said.find("error") == std::string::npos) << which << ": " << code << "\n" << said;
    EXPECT_EQ(said.find("crashed"), std::string::npos) << which << "\n" << said;
    EXPECT_TRUE(whole_report(text_of(folder.path() / "r.json"))) << which << "\n" << said;
    EXPECT_TRUE(whole_trajectory(text_of(folder.path() / "t.csv"))) << which << "\n" << said;
    failed += code != 0 ? 1 : 0;
    if (testing::Test::HasFailure()) break;
  }
  unsetenv("LD_PRELOAD");
  if (std::string(GetParam()) != "read") {
    EXPECT_GT(failed, 0) << "none of the calls was one that matters";
  }
}

INSTANTIATE_TEST_SUITE_P(OfKind, FailingCalls, testing::Values("alloc", "thread", "open", "read", "write"),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace tandem
