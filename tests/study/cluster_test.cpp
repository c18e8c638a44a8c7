// `tandem sweep --slurm` on a cluster of two nodes: the table is the one that this machine would have made.
#include "tests/study/cluster.hpp"

#include <gmock/gmock.h>

#include "hal/program.hpp"
#include "study/batches/plan.hpp"
#include "study/batches/results.hpp"

namespace tandem::study {
namespace {

using scenarios::eventually;
using scenarios::Folder;
using scenarios::Tandem;
using scenarios::text_of;
using testing::HasSubstr;

constexpr const char* kExperiment = R"(<tandem>
  <framework><experiment length="60" ticks_per_second="10" random_seed="1"/></framework>
  <controllers>
    <epuck_diffusion id="walk" library="epuck_diffusion">
      <actuators><differential_steering/></actuators>
      <sensors><proximity implementation="noisy" noise_level="0.02"/></sensors>
      <params alpha="7.5" delta="0.1" velocity="5 cm/s"/>
    </epuck_diffusion>
  </controllers>
  <loop_functions library="test_measuring" label="measuring" gain="1"/>
  <arena size="3,3,1" escape="stop">
    <distribute>
      <position method="uniform" min="-1,-1,0" max="1,1,0"/>
      <orientation method="uniform" min="0,0,0" max="360,0,0"/>
      <entity quantity="10" max_trials="100"><e-puck id="ep"><controller config="walk"/></e-puck></entity>
    </distribute>
  </arena>
</tandem>
)";

class ClusterSweep : public testing::Test {
 protected:
  void study(int seeds) {
    folder_.write("e.xml", kExperiment);
    folder_.write("s.xml",
                  "<study><experiment file=\"e.xml\"/><parameter path=\"loop_functions.gain\" values=\"1, 2\"/>"
                  "<seeds first=\"1\" count=\"" +
                      std::to_string(seeds) + "\"/></study>\n");
  }
  int tandem(const std::vector<std::string>& arguments) {
    Tandem program(arguments, folder_.path());
    const int code = program.wait(120.0);
    errors_ = program.errors();
    return code;
  }
  /// A table as CSV without its times, which are the last two columns.
  std::string without_times(const std::string& name) const {
    std::istringstream in(text_of(folder_.path() / name));
    std::string all;
    for (std::string line; std::getline(in, line);) {
      for (int i = 0; i < 2; ++i) line.erase(line.rfind(','));
      all += line + "\n";
    }
    return all;
  }

  Folder folder_;
  std::string errors_;
};

TEST_F(ClusterSweep, MakesTheTableThatThisMachineMakes) {
  const Cluster cluster;
  // Nothing of Slurm but sbatch is to be found.
  const std::string sbatch = hal::find_program("sbatch");
  ASSERT_FALSE(sbatch.empty());
  std::filesystem::create_directory(folder_.path() / "bin");
  std::filesystem::create_symlink(sbatch, folder_.path() / "bin" / "sbatch");
  const std::string path = std::getenv("PATH");
  study(20);
  setenv("PATH", (folder_.path() / "bin").c_str(), 1);
  const int code = tandem({"sweep", "s.xml", "--slurm", "--batch", "10"});
  setenv("PATH", path.c_str(), 1);
  ASSERT_EQ(code, 0) << errors_ << cluster.log();
  EXPECT_THAT(errors_, HasSubstr("makes 40 runs in 4 batches"));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "s.sqlite.batches"));
  ASSERT_EQ(tandem({"sweep", "s.xml", "--table", "here.sqlite"}), 0) << errors_;
  EXPECT_EQ(without_times("s.csv"), without_times("here.csv"));
}

TEST_F(ClusterSweep, LosesNothingWhenAJobIsKilledOrTheSweepIsInterrupted) {
  const Cluster cluster;
  study(60);
  const auto results = [&] {
    std::size_t bytes = 0;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "s.sqlite.batches" / "1", error)) {
      if (entry.path().extension() == ".results") bytes += entry.file_size(error);
    }
    return bytes;
  };
  // The jobs may be done before anybody gets hold of them: then another table is begun.
  for (int code = 0, tries = 0; code == 0; ++tries) {
    ASSERT_LT(tries, 20) << "it always ends before it is interrupted";
    for (const char* left : {"s.sqlite", "s.csv", "s.sqlite.batches"})
      std::filesystem::remove_all(folder_.path() / left);
    Tandem program({"sweep", "s.xml", "--slurm", "--batch", "60"}, folder_.path());
    ASSERT_TRUE(eventually([&] { return results() > 1'000 || program.wait(0.0) == 0; }, 60.0))
        << program.errors() << cluster.log();
    const auto jobs = cluster.processes_with("--batch-number");
    if (!jobs.empty()) {
      for (const pid_t job : jobs) kill(job, SIGKILL);
      program.signal(SIGINT);
    }
    code = program.wait();
    if (code == 0) continue;
    ASSERT_EQ(code, 130) << program.errors();
    EXPECT_THAT(program.errors(), HasSubstr("collect what they make with: tandem sweep s.xml --resume --slurm"));
  }

  EXPECT_EQ(tandem({"sweep", "s.xml", "--resume"}), 1);
  EXPECT_THAT(errors_, HasSubstr("tandem sweep s.xml --resume --slurm collects them"));

  ASSERT_EQ(tandem({"sweep", "s.xml", "--resume", "--slurm"}), 0) << errors_ << cluster.log();
  EXPECT_THAT(errors_, HasSubstr("makes")) << "what the killed jobs have left is handed over anew";
  ASSERT_EQ(tandem({"sweep", "s.xml", "--table", "here.sqlite"}), 0) << errors_;
  EXPECT_EQ(without_times("s.csv"), without_times("here.csv"));
}

TEST_F(ClusterSweep, SaysWhatIsWrong) {
  study(2);
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder_.path().c_str(), 1);
  EXPECT_EQ(tandem({"sweep", "s.xml", "--slurm"}), 1);
  EXPECT_THAT(errors_, HasSubstr("there is no sbatch here"));
  folder_.write("sbatch", "#!/bin/sh\necho 'sbatch: error: invalid partition specified' >&2\nexit 1\n");
  std::filesystem::permissions(folder_.path() / "sbatch", std::filesystem::perms::owner_all);
  EXPECT_EQ(tandem({"sweep", "s.xml", "--slurm"}), 3);
  setenv("PATH", path.c_str(), 1);
  EXPECT_THAT(errors_, HasSubstr("sbatch refused the job: sbatch: error: invalid partition specified"));

  // A job of a program that has changed since.
  ASSERT_TRUE(write_plan(folder_.path().string(), {{"another program", {}}, {{0, 1}}}).ok());
  EXPECT_EQ(tandem({"sweep", "s.xml", "--batch-folder", ".", "--batch-number", "0"}), 1);
  EXPECT_THAT(errors_, HasSubstr("this job is to make runs of another program or files"));
  EXPECT_EQ(tandem({"sweep", "s.xml", "--batch-folder", ".", "--batch-number", "1"}), 1);
  EXPECT_THAT(errors_, HasSubstr("there is no batch 1"));
}

}  // namespace
}  // namespace tandem::study
