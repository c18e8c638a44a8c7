// Golden reports, records, pictures and frames of all experiments of configs/, real robots being simulated.
#include <array>
#include <cstring>

#include "app/catalog.hpp"
#include "core/config/reader.hpp"
#include "hal/json/json.hpp"
#include "tests/controllers/experiment.hpp"
#include "tests/golden/golden.hpp"
#include "tests/scenarios/process.hpp"
#include "window/frame_encoder.hpp"
#include "window/space_frame.hpp"

namespace tandem {
namespace {

using golden::Digest;
using scenarios::Folder;
using scenarios::text_of;

constexpr const char* kFile = "runs.txt";
constexpr int kTicks = 100;

/// Real robots, which these runs simulate.
std::vector<std::string> real_robots(const std::string& experiment) {
  core::Problems problems;
  const auto scenario =
      core::read_experiment(std::string(test::kSourceDir) + "/configs/" + experiment, {}, app::catalog(), problems);
  std::vector<std::string> ids;
  if (!scenario) throw std::runtime_error(experiment + " does not load");
  for (const core::RobotItem& robot : scenario->robots) {
    if (robot.bridge) ids.push_back(robot.id);
  }
  return ids;
}

/// What a report says of the run, and not of the machine, the program or the time that it took.
std::string report_digest(const std::string& text) {
  auto report = hal::parse_json_object(text);
  EXPECT_TRUE(report.ok()) << text;
  if (!report.ok()) return "none";
  hal::Json json = report.value();
  for (const char* of_the_machine : {"threads", "wall_s", "cpu_s", "init_s", "ns_per_robot_step", "realtime_factor",
                                     "peak_rss_mb", "deadline_misses", "file", "controllers", "hooks", "plugins",
                                     "other_files", "inputs", "program", "settings", "peers"})
    json.erase(of_the_machine);
  Digest digest;
  digest.add(hal::to_text(json));
  return digest.text();
}

std::uint64_t little_endian(const std::string& bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  std::memcpy(&value, bytes.data() + at, size);
  return value;
}

/// Blocks as core/record/README.md has them, but for Start and End, which tell of machine and program.
std::string record_digest(const std::string& bytes) {
  constexpr std::size_t kHeader = 32;
  constexpr std::uint64_t kStart = 1, kEnd = 8;
  Digest digest;
  std::size_t at = 16;
  int blocks = 0;
  for (; at + kHeader <= bytes.size(); ++blocks) {
    EXPECT_EQ(bytes.compare(at, 4, "TdmB"), 0) << at;
    const std::uint64_t type = little_endian(bytes, at + 4, 2), size = little_endian(bytes, at + 16, 4);
    if (type != kStart && type != kEnd) {
      digest.add(bytes.substr(at + 4, 12));
      digest.add(bytes.substr(at + kHeader, size));
    }
    at += kHeader + size;
  }
  EXPECT_EQ(at, bytes.size());
  EXPECT_GT(blocks, 3);
  return digest.text();
}

/// What a viewer of the window gets who sees every tenth tick.
std::string frames_digest(const std::string& experiment) {
  const test::Experiment run(experiment, {}, test::seeded(7), "", app::catalog());
  window::SpaceFrames frames;
  window::FrameEncoder encoder("");
  window::ViewerState viewer;
  Digest digest;
  run->start();
  for (int tick = 0; tick <= kTicks; ++tick) {
    if (tick % 10 == 0) {
      window::Frame frame;
      frames.fill(run->space(), tick, run->ticks_per_second(), true, frame);
      (void)encoder.take(std::move(frame));
      std::vector<window::Message> messages;
      encoder.update(viewer, {}, messages);
      for (const window::Message& message : messages) digest.add(*message.bytes);
    }
    run->step();
  }
  return digest.text();
}

class GoldenRun : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Of, GoldenRun, testing::ValuesIn(test::experiments()),
                         [](const auto& name) { return std::filesystem::path(name.param).stem().string(); });

TEST_P(GoldenRun, KeepsItsReportRecordPictureAndFrames) {
  const std::string& file = GetParam();
  if (file == "footbot_manual.xml") GTEST_SKIP() << "it listens on ports, and waits for a hand";
  std::filesystem::current_path(test::kSourceDir);
  Folder folder;
  std::vector<std::string> words = {"run",
                                    std::string(test::kSourceDir) + "/configs/" + file,
                                    "--quiet",
                                    "--seed",
                                    "7",
                                    "--threads",
                                    "2",
                                    "--steps",
                                    "100",
                                    "--set",
                                    "framework.time.mode=fast",
                                    "--report",
                                    "report",
                                    "--record",
                                    "record",
                                    "--set",
                                    "record.ports=*",
                                    "--set",
                                    "record.fingerprint_every=10",
                                    "--picture",
                                    "last.svg"};
  for (const std::string& id : real_robots(file)) words.insert(words.end(), {"--without", id});
  scenarios::Tandem run(words, folder.path());
  ASSERT_EQ(run.wait(), 0) << run.errors();
  const std::string stem = std::filesystem::path(file).stem().string();
  golden::expect(kFile, stem + ".report", report_digest(text_of(folder.path() / "report")));
  golden::expect(kFile, stem + ".record", record_digest(text_of(folder.path() / "record")));
  Digest picture;
  picture.add(text_of(folder.path() / "last.svg"));
  golden::expect(kFile, stem + ".picture", picture.text());
  golden::expect(kFile, stem + ".frames", frames_digest(file));
}

}  // namespace
}  // namespace tandem
