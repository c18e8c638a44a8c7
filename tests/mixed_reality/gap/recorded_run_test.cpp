// A record that another program writes, block by block as core/record/README.md says, is what the fit reads.
#include "mixed_reality/gap/recorded_run.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <limits>
#include <unistd.h>

#include "core/record/block_file.hpp"
#include "mixed_reality/gap/wheel_series.hpp"

namespace tandem::mixed_reality {
namespace {

template <class T>
void put(std::string& out, T value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

class Written {
 public:
  void block(std::uint16_t type, std::int64_t tick, const std::string& payload) {
    core::append_block(text_, type, tick, payload);
  }
  /// Rows of one row: u32 stream, members, rows, 0, and its values.
  void row(std::uint32_t stream, std::uint32_t members, std::int64_t tick, const std::string& values) {
    std::string payload;
    for (const std::uint32_t number : {stream, members, std::uint32_t{1}, std::uint32_t{0}}) put(payload, number);
    block(4, tick, payload + values);
  }
  std::string save() const {
    const std::string path = testing::TempDir() + "tandem_" + std::to_string(getpid()) + "_foreign.record";
    std::ofstream(path, std::ios::binary) << "TANDEM RECORD 1\n" << text_;
    return path;
  }

 private:
  std::string text_;
};

TEST(RecordedRun, ReadsStampsPlacesAndCommandsThatAnotherProgramWrote) {
  Written w;
  w.block(1, -1, R"({"program": "other", "experiment": "e", "seed": 1, "ticks_per_second": 10, "settings": ""})");
  w.block(3, -1, R"({"members": 1, "ids": ["r0"], "kinds": ["e-puck"], "kind": [0], "real": [0]})");
  w.block(3, -1, R"({"members": 2, "ids": ["run"]})");
  w.block(2, -1, R"({"stream": 1, "of": "run", "set": "time", "name": "clock", "fields": [
      {"name": "monotonic_ns", "type": "i64"}, {"name": "run_ns", "type": "i64"}]})");
  w.block(2, -1, R"({"stream": 2, "of": "robot", "set": "sent", "name": "differential_steering", "fields": [
      {"name": "left", "type": "f64"}, {"name": "right", "type": "f64"}]})");
  w.block(2, -1, R"({"stream": 3, "of": "robot", "set": "seen", "name": "track", "fields": [
      {"name": "sent_ns", "type": "i64"}]})");
  w.block(2, -1, R"({"stream": 4, "of": "robot", "set": "input", "name": "wheel_encoders", "fields": [
      {"name": "taken_ns", "type": "i64"}, {"name": "validity", "type": "u8"},
      {"name": "left", "type": "f64"}, {"name": "right", "type": "f64"}]})");
  w.block(2, -1, R"({"stream": 5, "of": "robot", "set": "seen", "name": "sightings", "fields": [
      {"name": "count", "type": "u8"}, {"name": "taken_ns", "type": "i64", "count": 16, "used_by": "count"},
      {"name": "x", "type": "f64", "count": 16, "used_by": "count"},
      {"name": "y", "type": "f64", "count": 16, "used_by": "count"},
      {"name": "heading", "type": "f64", "count": 16, "used_by": "count"},
      {"name": "true_clock", "type": "u8", "count": 16, "used_by": "count"}]})");
  w.block(2, -1, R"({"stream": 6, "of": "robot", "set": "time", "name": "ledger", "fields": [
      {"name": "round_trip_median_ms", "type": "f32"}, {"name": "jitter_ms", "type": "f32"}]})");
  // Three ticks; before the last one two slots were left out.
  constexpr std::array<std::int64_t, 3> kMonotonic = {5'000'000'000, 5'100'000'000, 5'400'000'000};
  for (std::int64_t t = 0; t < 3; ++t) {
    const std::int64_t run_ns = t * 100'000'000;
    std::string clock, told, track, counts, seen, ledger;
    put(clock, kMonotonic[static_cast<std::size_t>(t)]);
    put(clock, run_ns);
    w.row(1, 2, t, clock);
    put(told, 0.1 * static_cast<double>(t));
    put(told, -0.1);
    w.row(2, 1, t, told);
    put(track, run_ns + 2'000'000);
    w.row(3, 1, t, track);
    put(counts, run_ns - 30'000'000);
    put(counts, std::uint8_t{2});
    put(counts, 0.5);
    put(counts, 0.25);
    w.row(4, 1, t, counts);
    put(seen, std::uint8_t{2});
    for (const std::int64_t ago : {60'000'000, 20'000'000}) put(seen, run_ns - ago);
    for (const double value : {1.0, 1.5, -2.0, -2.5, 0.7, std::numeric_limits<double>::quiet_NaN()}) put(seen, value);
    for (int i = 0; i < 2; ++i) put(seen, std::uint8_t{1});
    w.row(5, 1, t, seen);
    put(ledger, 41.0F);
    put(ledger, 1.5F);
    w.row(6, 1, t, ledger);
  }
  w.block(8, 2, R"({"ended": "length"})");
  const std::string path = w.save();
  const auto read = read_recorded_run(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(read.ok()) << read.error().message;
  const RecordedRun& run = read.value();
  EXPECT_TRUE(run.damage.empty());
  const RecordedRobot* const robot = run.find("r0");
  ASSERT_NE(robot, nullptr);
  EXPECT_TRUE(robot->real);
  EXPECT_EQ(robot->kind, "e-puck");
  EXPECT_NEAR(robot->round_trip_s, 0.041, 1e-7);
  EXPECT_NEAR(robot->round_trip_jitter_s, 0.0015, 1e-7);

  const WheelSeries series = wheel_series(run, *robot);
  ASSERT_EQ(series.commands.size(), 3U);
  EXPECT_NEAR(series.commands[1].at_s, 0.102, 1e-9);
  EXPECT_NEAR(series.commands[2].at_s, 0.402, 1e-9) << "two slots were left out";
  EXPECT_DOUBLE_EQ(series.commands[2].left_m_s, 0.2);
  ASSERT_EQ(series.counts.size(), 3U);
  EXPECT_NEAR(series.counts[2].at_s, 0.37, 1e-9);
  EXPECT_DOUBLE_EQ(series.counts[2].right_m, 0.25);
  ASSERT_EQ(series.places.size(), 6U);
  EXPECT_NEAR(series.places[4].at_s, 0.34, 1e-9);
  EXPECT_NEAR(series.places[5].at_s, 0.38, 1e-9);
  EXPECT_DOUBLE_EQ(series.places[5].x_m, 1.5);
  EXPECT_DOUBLE_EQ(series.places[4].heading_rad, 0.7);
  EXPECT_TRUE(std::isnan(series.places[5].heading_rad));
  EXPECT_TRUE(series.stamps_are_right);
}

}  // namespace
}  // namespace tandem::mixed_reality
