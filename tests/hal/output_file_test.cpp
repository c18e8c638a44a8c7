#include "hal/output_file.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <sstream>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tandem::hal {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class Output : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "output_file_XXXXXX";
    folder_ = mkdtemp(pattern.data());
    path_ = (folder_ / "r.json").string();
  }
  void TearDown() override { fs::remove_all(folder_); }

  OutputFile open() {
    auto opened = OutputFile::open(path_, "report");
    EXPECT_TRUE(opened.ok()) << (opened.ok() ? "" : opened.error().message);
    return std::move(opened).value();
  }
  std::string open_error(const std::string& path) {
    const auto opened = OutputFile::open(path, "report");
    return opened.ok() ? "" : opened.error().message;
  }
  void old_file(const std::string& text) { std::ofstream(path_) << text; }
  static std::string text_of(const fs::path& file) {
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
  std::string path_;
};

TEST_F(Output, ReplacesTheOldFileOnlyWhenItIsCommitted) {
  old_file("old");
  OutputFile file = open();
  ASSERT_TRUE(file.write("new").ok());
  EXPECT_EQ(text_of(path_), "old");
  EXPECT_EQ(text_of(path_ + ".part"), "new") << "what is written is there, even if this process is killed now";
  ASSERT_TRUE(file.commit().ok());
  EXPECT_EQ(text_of(path_), "new");
  EXPECT_EQ(files(), 1U);
}

TEST_F(Output, LeavesNothingBehindWhenItIsNotCommitted) {
  old_file("old");
  { ASSERT_TRUE(open().write("new").ok()); }
  EXPECT_EQ(text_of(path_), "old");
  EXPECT_EQ(files(), 1U);
}

TEST_F(Output, KeepsThePartWhenAskedTo) {
  {
    OutputFile file = open();
    ASSERT_TRUE(file.write("new").ok());
    file.keep_part();
  }
  EXPECT_EQ(text_of(path_ + ".part"), "new");
}

TEST_F(Output, StartsAnewOverAPartThatAKilledProcessLeft) {
  std::ofstream(path_ + ".part") << "what is left of a long run";
  OutputFile file = open();
  ASSERT_TRUE(file.write("new").ok());
  ASSERT_TRUE(file.commit().ok());
  EXPECT_EQ(text_of(path_), "new");
}

TEST_F(Output, NamesPathAndReasonBeforeAnythingIsWritten) {
  EXPECT_THAT(open_error("/no/such/folder/r.json"),
              AllOf(HasSubstr("report '/no/such/folder/r.json'"), HasSubstr("No such file or directory")));
  EXPECT_THAT(open_error(folder_.string()), HasSubstr("it is a folder"));
  EXPECT_THAT(open_error("/proc/r.json"), HasSubstr("/proc/r.json"));
}

TEST_F(Output, OneWriterAFile) {
  const OutputFile first = open();
  EXPECT_THAT(open_error(path_), HasSubstr("another process is writing it"));
}

TEST_F(Output, AFullDiskLeavesTheOldFileAndWholeLines) {
  old_file("old");
  OutputFile file = open();
  file.keep_part();
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto was = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{10, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const Status first = file.write("line 1\n");
  const Status second = file.write("line 2\nline 3\n");
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, was);
  EXPECT_TRUE(first.ok());
  ASSERT_FALSE(second.ok());
  EXPECT_THAT(second.error().message, AllOf(HasSubstr("report"), HasSubstr("File too large")));
  EXPECT_EQ(text_of(path_ + ".part"), "line 1\n");
  EXPECT_EQ(text_of(path_), "old");
}

TEST_F(Output, ADeviceIsWrittenDirectly) {
  auto full = OutputFile::open("/dev/full", "report");
  ASSERT_TRUE(full.ok());
  EXPECT_TRUE(full->part().empty());
  const Status written = full->write("x");
  ASSERT_FALSE(written.ok());
  EXPECT_THAT(written.error().message, HasSubstr("No space left"));
  EXPECT_FALSE(fs::exists("/dev/full.part"));
}

TEST_F(Output, GoesWhereALinkLeadsAndKeepsTheModeOfTheOldFile) {
  old_file("old");
  fs::permissions(path_, fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("r.json", folder_ / "link.json");
  ASSERT_TRUE(write_whole_file((folder_ / "link.json").string(), "report", "new").ok());
  EXPECT_EQ(text_of(path_), "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.json"));
  EXPECT_EQ(fs::status(path_).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

}  // namespace
}  // namespace tandem::hal
