// Plans of batches and their results, as files.
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/batches/plan.hpp"
#include "study/batches/results.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::study {
namespace {

using scenarios::Folder;

FinishedRun finished(std::int64_t number, double items) {
  FinishedRun run;
  run.plan.number = number;
  run.outcome.done = true;
  run.outcome.ended = "length";
  run.outcome.measures = {{"items", items}};
  return run;
}

TEST(BatchPlan, SharesAllRunsOutOnceAndByConfiguration) {
  std::vector<std::int64_t> runs;
  for (std::int64_t run = 3; run < 103; ++run) runs.push_back(run);
  const auto batches = share_out(runs, 4, 8, 10);
  ASSERT_EQ(batches.size(), 10U);
  std::vector<std::int64_t> all;
  for (const auto& batch : batches) {
    EXPECT_EQ(batch.size(), 10U);
    all.insert(all.end(), batch.begin(), batch.end());
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(all, runs);
  EXPECT_EQ(batches[0][0] % 4, batches[0][9] % 4) << "a world is kept through a batch";
  EXPECT_EQ(share_out(runs, 4, 40, 10).size(), 3U);
  EXPECT_TRUE(share_out({}, 4, 8, 10).empty());
}

TEST(BatchPlan, IsReadAsItWasWritten) {
  const Folder folder;
  const BatchPlan plan{{"tandem 1", {{"e.xml", "abc"}}}, {{1, 2}, {3}}};
  ASSERT_TRUE(write_plan(folder.path().string(), plan).ok());
  auto read = read_plan(folder.path().string());
  ASSERT_TRUE(read.ok());
  EXPECT_EQ(read->version, plan.version);
  EXPECT_EQ(read->batches, plan.batches);
  for (const char* text : {"", "{", "{}", R"({"format":2})", R"({"format":1,"program":1,"files":[],"batches":[]})"}) {
    folder.write("plan.json", text);
    EXPECT_FALSE(read_plan(folder.path().string()).ok()) << text;
  }
  EXPECT_FALSE(read_plan("/nowhere").ok());
}

TEST(BatchResults, AreReadWhileTheyAreWrittenAndWithoutWhatIsDamaged) {
  const Folder folder;
  const std::string path = folder.path().string();
  ResultsReader reader(path);
  EXPECT_TRUE(reader.look().empty());
  auto first = ResultsWriter::open(path, 0), second = ResultsWriter::open(path, 0);
  ASSERT_TRUE(first.ok() && second.ok());
  const std::vector<FinishedRun> one = {finished(7, 1.5)}, two = {finished(8, 2.5), finished(7, 1.5)};
  ASSERT_TRUE(first->add(one).ok());
  auto told = reader.look();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].run, 7);
  EXPECT_EQ(told[0].outcome.measures, one[0].outcome.measures);
  ASSERT_TRUE(second->add(two).ok());
  EXPECT_EQ(reader.look().size(), 2U);
  EXPECT_TRUE(reader.look().empty());

  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    if (entry.path().extension() != ".results") continue;
    const std::string whole = scenarios::text_of(entry.path());
    for (std::size_t cut = 0; cut <= whole.size(); cut += 3) {
      std::ofstream(entry.path(), std::ios::binary) << whole.substr(0, cut);
      EXPECT_LE(ResultsReader(path).look().size(), 3U);
    }
    std::string damaged = whole;
    damaged[damaged.size() - 3] ^= 1;
    std::ofstream(entry.path(), std::ios::binary) << damaged;
    EXPECT_EQ(ResultsReader(path).look().size(), 2U) << "all but the block that is damaged";
    std::ofstream(entry.path(), std::ios::binary) << whole;
  }
}

}  // namespace
}  // namespace tandem::study
