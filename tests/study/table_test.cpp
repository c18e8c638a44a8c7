// Tables: what is put in is there, once, whatever went wrong between.
#include "study/table/table.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <iterator>
#include <sys/resource.h>
#include <unistd.h>

namespace tandem::study {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

class TableFile : public testing::Test {
 protected:
  TableFile() {
    std::string pattern = (fs::temp_directory_path() / "tandem_XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  ~TableFile() override { fs::remove_all(folder_); }
  std::string path() const { return folder_ / "t.sqlite"; }
  std::string text(const std::string& name) const {
    std::ifstream in(folder_ / name);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }
  static TableHead head() { return {"<study/>", "s.xml", {"carry", "way"}, 3}; }
  static RunRow row(std::int64_t run, bool done = true) {
    RunRow r{run, "noise, it's \"odd\"", static_cast<std::uint64_t>(run + 1), {"2.50", "0,1"}, 1, 0.1, {}};
    r.outcome.done = done;
    r.outcome.ended = done ? "length" : "failed";
    r.outcome.failure = done ? "" : "hook 'x' threw";
    r.outcome.ticks = 20;
    r.outcome.virtual_s = 2.0;
    r.outcome.fingerprint = 0xAB;
    r.outcome.measures = {{"items", 1.0 / 3.0}, {"ticks", 7.0}};
    r.outcome.sample_ticks = {10, 20};
    r.outcome.samples = {{"items", {0.1, 0.2}}};
    return r;
  }
  fs::path folder_;
};

TEST_F(TableFile, HoldsWhatWasPutInAndGivesItAsCsv) {
  {
    auto table = Table::open(path());
    ASSERT_TRUE(table.ok()) << table.error().message;
    EXPECT_FALSE((*table)->head());
    ASSERT_TRUE((*table)->begin(head()).ok());
    ASSERT_TRUE((*table)->add(std::vector<RunRow>{row(1), row(0, false)}).ok());
    ASSERT_TRUE((*table)->add(std::vector<RunRow>{row(0)}).ok());  // made again
    ASSERT_TRUE((*table)->finish().ok());
  }
  auto files = export_csv(path(), folder_ / "t.csv");
  ASSERT_TRUE(files.ok()) << files.error().message;
  EXPECT_EQ(
      text("t.csv"),
      "run,experiment,seed,carry,way,state,ended,failure,ticks,virtual_s,fingerprint,version,items,ticks_,wall_s,"
      "cpu_s\n"
      "0,\"noise, it's \"\"odd\"\"\",1,2.5,\"0,1\",done,length,,20,2,0x00000000000000ab,1,0.3333333333333333,7,0,0\n"
      "1,\"noise, it's \"\"odd\"\"\",2,2.5,\"0,1\",done,length,,20,2,0x00000000000000ab,1,0.3333333333333333,7,0,0\n");
  EXPECT_EQ(text("t.samples.csv"),
            "run,measure,tick,time_s,value\n0,items,10,1,0.1\n0,items,20,2,0.2\n1,items,10,1,0.1\n1,items,20,2,0.2\n");
  EXPECT_FALSE(fs::exists(path() + "-wal")) << "one file is left";
}

TEST_F(TableFile, HasUnitsInTheHeadsOfItsCsvAndNumbersInTheCells) {
  auto table = Table::open(path());
  ASSERT_TRUE((*table)->begin({"<study/>", "s.xml", {"velocity", "way", "mixed"}, 2}).ok());
  RunRow slow = row(0), fast = row(1);
  slow.settings = {"2.5 cm/s", "1 m", "1 m"};
  fast.settings = {"10cm/s", "north", "2 cm"};
  ASSERT_TRUE((*table)->add(std::vector<RunRow>{slow, fast}).ok());
  ASSERT_TRUE((*table)->finish().ok());
  ASSERT_TRUE(export_csv(path(), folder_ / "t.csv").ok());
  EXPECT_THAT(text("t.csv"), testing::StartsWith("run,experiment,seed,velocity_cm_s,way,mixed,state,"));
  EXPECT_THAT(text("t.csv"), HasSubstr(",1,2.5,1 m,1 m,done,"));
  EXPECT_THAT(text("t.csv"), HasSubstr(",2,10,north,2 cm,done,"));
}

TEST_F(TableFile, KnowsItsRunsWhenItIsOpenedAgain) {
  {
    auto table = Table::open(path());
    ASSERT_TRUE((*table)->begin(head()).ok());
    ASSERT_TRUE((*table)->add(std::vector<RunRow>{row(0), row(2, false)}).ok());
    EXPECT_EQ((*table)->add_version({"p1", {{"f", "1"}}}).value(), 1);
    EXPECT_EQ((*table)->add_version({"p1", {{"f", "1"}}}).value(), 1);
    EXPECT_EQ((*table)->add_version({"p1", {{"f", "2"}}}).value(), 2);
  }
  auto table = Table::open(path());
  ASSERT_TRUE(table.ok());
  const auto found = (*table)->head();
  ASSERT_TRUE(found);
  EXPECT_THAT(found->settings, ElementsAre("carry", "way"));
  EXPECT_EQ(found->runs, 3);
  const auto known = (*table)->known();
  ASSERT_EQ(known.size(), 2U);
  EXPECT_TRUE(same_setting(known[0].settings[0], "2.50"));
  EXPECT_FALSE(same_setting(known[0].settings[0], "2.51"));
  EXPECT_TRUE(known[0].done);
  EXPECT_FALSE(known[1].done);
  EXPECT_EQ((*table)->version(), (Version{"p1", {{"f", "2"}}}));
}

TEST_F(TableFile, IsWrittenByOneSweepAlone) {
  auto first = Table::open(path());
  ASSERT_TRUE(first.ok());
  auto second = Table::open(path());
  ASSERT_FALSE(second.ok());
  EXPECT_THAT(second.error().message, HasSubstr("another sweep is writing it"));
}

TEST_F(TableFile, RefusesWhatIsNoTable) {
  std::ofstream(path()) << std::string(5000, 'x');
  auto table = Table::open(path());
  ASSERT_FALSE(table.ok());
  EXPECT_THAT(table.error().message, HasSubstr("no table of a study"));
  EXPECT_FALSE(Table::open("/nowhere/t.sqlite").ok());
}

TEST_F(TableFile, KeepsWhatItHasWhenTheDiskIsFull) {
  auto table = Table::open(path());
  ASSERT_TRUE((*table)->begin(head()).ok());
  ASSERT_TRUE((*table)->add(std::vector<RunRow>{row(0)}).ok());
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  rlimit small = before;
  small.rlim_cur = fs::file_size(path() + "-wal") + 20'000;  // as a full disk would
  setrlimit(RLIMIT_FSIZE, &small);
  RunRow large = row(1);
  large.outcome.failure.assign(200'000, 'x');
  const hal::Status full = (*table)->add(std::vector<RunRow>{large});
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_FALSE(full.ok());
  EXPECT_THAT(full.error().message, HasSubstr("t.sqlite"));
  EXPECT_EQ((*table)->known().size(), 1U);
  EXPECT_TRUE((*table)->add(std::vector<RunRow>{large}).ok()) << "there is room again";
  EXPECT_EQ((*table)->known().size(), 2U);
}

}  // namespace
}  // namespace tandem::study
