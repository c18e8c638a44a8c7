// The program for a robot's board, run as the board runs it: by an emulated processor, against an emulated robot.
#include <future>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bridges/epuck_emulator/emulator.hpp"
#include "bridges/footbot_emulator/emulator.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem {
namespace {

using scenarios::Folder;
using scenarios::json_value;
using scenarios::Tandem;
using scenarios::text_of;
using testing::HasSubstr;

const std::string kConfigs = std::string(test::kSourceDir) + "/configs/";
constexpr double kPatience_s = 60.0;  // an emulated processor is slow

/// A robot's firmware on a thread of its own.
template <class Options>
class Emulated {
 public:
  explicit Emulated(Options options) {
    std::promise<std::string> ready;
    options.ready = [&ready](const std::string& path) { ready.set_value(path); };
    thread_ = std::thread([this, options] { ended_ = run(options, stop_); });
    link_ = ready.get_future().get();
  }
  ~Emulated() {
    stop_ = true;
    thread_.join();
    EXPECT_TRUE(ended_.ok());
  }
  const std::string& link() const { return link_; }

 private:
  std::atomic<bool> stop_{false};
  hal::Status ended_;
  std::string link_;
  std::thread thread_;
};

TEST(Board, ChecksWhatItIsGiven) {
  Folder folder;
  for (const char* file : {"epuck_robot.xml", "footbot_robot.xml", "footbot_map.xml", "epuck_mixed.xml"}) {
    Tandem check({"check", kConfigs + file}, folder.path());
    EXPECT_EQ(check.wait(kPatience_s), 0) << check.errors();
    EXPECT_THAT(check.output(), HasSubstr("good"));
  }
  std::string wrong = text_of(kConfigs + "epuck_robot.xml");
  wrong.replace(wrong.find("velocity="), 9, "velocitty=");
  folder.write("wrong.xml", wrong);
  Tandem check({"check", "wrong.xml"}, folder.path());
  EXPECT_EQ(check.wait(kPatience_s), 1);
  EXPECT_THAT(check.errors(), HasSubstr("velocitty"));
}

TEST(Board, DrivesAnEpuck) {
  Folder folder;
  bridges::epuck_emulator::Options options;
  options.link = "pty:" + (folder.path() / "ep0").string();
  const Emulated epuck(options);
  Tandem robot({"robot", kConfigs + "epuck_robot.xml", "--link", "serial:" + (folder.path() / "ep0").string(),
                "--seconds", "2", "--report", "r.json"},
               folder.path());
  ASSERT_EQ(robot.wait(kPatience_s), 0) << robot.errors();
  const std::string report = text_of(folder.path() / "r.json");
  EXPECT_EQ(json_value(report, "steps"), "20");
  EXPECT_GT(std::stoi(json_value(report, "answers")), 10);
  Tandem inspect({"inspect", "serial:" + (folder.path() / "ep0").string()}, folder.path());
  EXPECT_EQ(inspect.wait(kPatience_s), 0) << inspect.errors();
  EXPECT_THAT(inspect.output(), HasSubstr("proximity:"));
}

TEST(Board, DrivesAFootbotBehindItsSwitch) {
  Folder folder;
  bridges::footbot_emulator::Options options;
  options.link = "tcp-listen:0";
  const Emulated footbot(options);
  Tandem robot(
      {"robot", kConfigs + "footbot_robot.xml", "--link", footbot.link(), "--seconds", "2", "--report", "r.json"},
      folder.path());
  ASSERT_EQ(robot.wait(kPatience_s), 0) << robot.errors();
  const std::string report = text_of(folder.path() / "r.json");
  EXPECT_EQ(json_value(report, "steps"), "20");
  EXPECT_GT(std::stoi(json_value(report, "messages_in")), 10);
}

}  // namespace
}  // namespace tandem
