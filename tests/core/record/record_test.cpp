#include "core/record/record.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <gmock/gmock.h>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "core/record/record_moments.hpp"
#include "core/record/record_reader.hpp"
#include "core/record/record_streams.hpp"
#include "core/record/scene_json.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::core {
namespace {

class Record : public testing::Test {
 protected:
  void SetUp() override {
    using hal::port_type;
    ep0_ =
        add_robot(space_, hal::epuck::kind(), "ep0", 1.0, -2.5, 3.0,
                  {&port_type<hal::Proximity>(), &port_type<hal::WheelSpeeds>(), &port_type<hal::RangeAndBearing>()});
    ep1_ = add_robot(space_, hal::epuck::kind(), "ep1", 0.1234567, 1e-9, -0.5, {&port_type<hal::WheelSpeeds>()});
    scout_ = add_robot(space_, hal::epuck::kind(), "scout", 0.0, 0.0, 0.0);
    path_ = testing::TempDir() + "record_test_" + testing::UnitTest::GetInstance()->current_test_info()->name();
  }
  void TearDown() override {
    std::remove(path_.c_str());
    std::remove((path_ + ".part").c_str());
  }

  RecordConfig config(std::vector<std::string> entities = {"*"}, std::vector<std::string> ports = {}) const {
    RecordConfig c;
    c.path = path_;
    c.entities = std::move(entities);
    c.ports = std::move(ports);
    return c;
  }
  std::unique_ptr<Recorder> open(const RecordConfig& c) {
    auto opened = Recorder::open(c, space_, {{"program", "test"}});
    EXPECT_TRUE(opened.ok()) << (opened.ok() ? "" : opened.error().message);
    return opened.ok() ? std::move(opened).value() : nullptr;
  }
  std::string error_of(const RecordConfig& c) {
    const auto opened = Recorder::open(c, space_, {{"program", "test"}});
    return opened.ok() ? "" : opened.error().message;
  }
  std::string bytes() const {
    std::stringstream text;
    text << std::ifstream(path_, std::ios::binary).rdbuf();
    return text.str();
  }
  void write(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }

  /// Ten ticks in which ep1 moves, all ports recorded.
  void record_ten_ticks() {
    auto recorder = open(config({"*"}, {"*"}));
    for (hal::Tick tick = 0; tick < 10; ++tick) {
      space_.set_pose(ep1_, {0.25 * static_cast<double>(tick), 0.0, 0.0, 1.0, 0.0});
      auto& heard = *space_.port<hal::RangeAndBearing>(ep0_);
      heard.count = static_cast<std::uint32_t>(tick % 3);
      for (std::size_t i = 0; i < heard.count; ++i)
        heard.range_m[i] = static_cast<float>(tick) + 0.5F * static_cast<float>(i);
      ASSERT_TRUE(recorder->tick_done(space_, tick).ok());
    }
    ASSERT_TRUE(recorder->close(9, {{"finished", true}}).ok());
  }

  Space space_;
  RobotId ep0_, ep1_, scout_;
  std::string path_;
};

/// All rows of a stream, by tick.
std::vector<RecordEntry> rows_of(RecordReader& reader, const std::string& title) {
  std::vector<RecordEntry> found;
  while (auto entry = reader.next()) {
    if (entry->rows && entry->rows->stream().title() == title) found.push_back(std::move(*entry));
  }
  return found;
}

std::size_t field_named(const RecordRows& rows, const std::string& name) {
  for (std::size_t f = 0; f < rows.stream().fields.size(); ++f) {
    if (rows.stream().fields[f].name == name) return f;
  }
  ADD_FAILURE() << "no field " << name;
  return 0;
}

TEST_F(Record, HoldsPosesToAMicrometre) {
  auto recorder = open(config());
  ASSERT_TRUE(recorder->tick_done(space_, 0).ok());
  space_.set_pose(ep1_, {-31.4159264, 0.25, 0.0, std::cos(2.5), std::sin(2.5)});
  ASSERT_TRUE(recorder->tick_done(space_, 1).ok());
  ASSERT_TRUE(recorder->close(1, {{"finished", true}}).ok());

  auto reader = RecordReader::open(path_);
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(reader.value().start()["program"], "test");
  const auto poses = rows_of(reader.value(), "pose");
  ASSERT_EQ(poses.size(), 3U);  // before the first tick, and after both
  EXPECT_EQ(poses[0].tick, -1);
  EXPECT_EQ(poses[2].tick, 1);
  const RecordRows& rows = *poses[2].rows;
  ASSERT_EQ(rows.members().ids, (std::vector<std::string>{"ep0", "ep1", "scout"}));
  EXPECT_EQ(rows.members().kinds[1], "e-puck");
  EXPECT_NEAR(rows.value(field_named(rows, "x"), 1), -31.4159264, 0.5e-6);
  EXPECT_NEAR(rows.value(field_named(rows, "y"), 1), 0.25, 0.5e-6);
  EXPECT_NEAR(rows.value(field_named(rows, "heading"), 1), 2.5, 1e-9);
  EXPECT_FALSE(reader.value().cut());
  EXPECT_THAT(reader.value().damage(), testing::IsEmpty());
}

TEST_F(Record, HasSixteenBytesARobotAndTick) {
  auto recorder = open(config());
  for (hal::Tick tick = 0; tick < 100; ++tick) ASSERT_TRUE(recorder->tick_done(space_, tick).ok());
  ASSERT_TRUE(recorder->close(99, {}).ok());
  const std::string with_hundred = bytes();
  auto longer = open(config());
  for (hal::Tick tick = 0; tick < 101; ++tick) ASSERT_TRUE(longer->tick_done(space_, tick).ok());
  ASSERT_TRUE(longer->close(99, {}).ok());
  EXPECT_EQ(bytes().size() - with_hundred.size(), kBlockHeaderBytes + 16 + 3 * 16);
}

TEST_F(Record, HoldsEveryFieldOfChosenPorts) {
  record_ten_ticks();
  auto reader = RecordReader::open(path_);
  ASSERT_TRUE(reader.ok());
  const auto heard = rows_of(reader.value(), "sensor range_and_bearing");
  ASSERT_EQ(heard.size(), 11U);
  const RecordRows& rows = *heard[9].rows;  // tick 8: two messages
  ASSERT_EQ(heard[9].tick, 8);
  EXPECT_EQ(rows.members().ids, std::vector<std::string>{"ep0"});
  const std::size_t range = field_named(rows, "range");
  ASSERT_EQ(rows.used(range, 0), 2U);
  EXPECT_EQ(rows.value(range, 0, 0), 8.0);
  EXPECT_EQ(rows.value(range, 0, 1), 8.5);
  EXPECT_EQ(rows.stream().fields[range].unit, "m");
}

TEST_F(Record, HoldsOfARobotsRowsOnlyThoseThatWereChosen) {
  auto recorder = open(config({"ep*"}));
  ASSERT_TRUE(recorder->tick_done(space_, 0).ok());
  ASSERT_TRUE(recorder->close(0, {}).ok());
  auto reader = RecordReader::open(path_);
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(rows_of(reader.value(), "pose")[0].rows->members().ids, (std::vector<std::string>{"ep0", "ep1"}));
}

TEST_F(Record, SaysWhoCameAndWent) {
  auto recorder = open(config());
  ASSERT_TRUE(recorder->tick_done(space_, 0).ok());
  space_.remove_robot(ep0_);
  ASSERT_TRUE(recorder->tick_done(space_, 1).ok());
  ASSERT_TRUE(recorder->close(1, {}).ok());
  auto reader = RecordReader::open(path_);
  ASSERT_TRUE(reader.ok());
  const auto poses = rows_of(reader.value(), "pose");
  EXPECT_EQ(poses[1].rows->members().ids.size(), 3U);
  EXPECT_EQ(poses[2].rows->members().ids, (std::vector<std::string>{"ep1", "scout"}));
}

TEST_F(Record, RefusesRobotsAndPortsThatAreNotThere) {
  EXPECT_EQ(error_of(config({"eq0"})),
            "record '" + path_ + "': no robot fits 'eq0'; did you mean 'ep0'?; there are: ep0, ep1, scout");
  EXPECT_EQ(error_of(config({"*"}, {"proximty"})),
            "record '" + path_ +
                "': no robot's controller uses a port 'proximty'; did you mean 'proximity'?; "
                "they use: proximity, differential_steering, range_and_bearing");
  RecordConfig nowhere = config();
  nowhere.path = "/no/such/folder/record";
  EXPECT_NE(error_of(nowhere).find("/no/such/folder"), std::string::npos);
}

TEST_F(Record, IsReadableUpToTheLastWholeTickWhereverItWasCut) {
  record_ten_ticks();
  const std::string whole = bytes();
  hal::Tick last_seen = -2;
  for (std::size_t size = 0; size < whole.size(); size += 61) {
    write(whole.substr(0, size));
    auto reader = RecordReader::open(path_);
    if (!reader.ok()) continue;  // not even the beginning
    hal::Tick last = -2;
    while (const auto entry = reader.value().next()) {
      EXPECT_GE(entry->tick, last);
      last = entry->tick;
    }
    EXPECT_TRUE(reader.value().cut()) << size;
    EXPECT_TRUE(reader.value().damage().empty()) << size;
    EXPECT_GE(last, last_seen);
    last_seen = last;
  }
  EXPECT_EQ(last_seen, 9);
}

TEST_F(Record, LeavesOutABlockWithAFlippedBitAndTellsWhere) {
  record_ten_ticks();
  const std::string whole = bytes();
  std::size_t blocks_whole = 0;
  auto sound = RecordReader::open(path_);
  ASSERT_TRUE(sound.ok());
  while (sound.value().next()) ++blocks_whole;
  for (std::size_t bit = 8 * kBlockFileStart.size(); bit < 8 * whole.size(); bit += 1009) {
    std::string flipped = whole;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << (bit % 8)));
    write(flipped);
    auto reader = RecordReader::open(path_);
    if (!reader.ok()) {
      EXPECT_NE(reader.error().message.find("beginning"), std::string::npos);
      continue;
    }
    std::size_t blocks = 0;
    while (reader.value().next()) ++blocks;
    EXPECT_LE(blocks, blocks_whole);
    EXPECT_TRUE(!reader.value().damage().empty() || reader.value().cut()) << bit;
  }
}

TEST_F(Record, IsRefusedWhereItIsOfAnotherVersionOrNone) {
  write("TANDEM RECORD 7\n");
  EXPECT_NE(RecordReader::open(path_).error().message.find("version"), std::string::npos);
  write("tick,time_s,id,x_m,y_m,heading_rad\n");
  EXPECT_NE(RecordReader::open(path_).error().message.find("is no record"), std::string::npos);
  write("");
  EXPECT_NE(RecordReader::open(path_).error().message.find("is no record"), std::string::npos);
  EXPECT_NE(RecordReader::open(path_ + "nowhere").error().message.find("there is no such file"), std::string::npos);
}

TEST_F(Record, LosesAtMostOneTickWhenItsProcessIsKilled) {
  for (const int pause_ms : {0, 3}) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      auto recorder = Recorder::open(config(), space_, {{"program", "test"}});
      if (!recorder.ok()) ::_exit(1);
      auto when = std::chrono::steady_clock::now();
      for (hal::Tick tick = 0; tick < 100; ++tick) {
        std::this_thread::sleep_until(when += std::chrono::milliseconds(pause_ms));
        (void)recorder.value()->tick_done(space_, tick);
      }
      ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    auto reader = RecordReader::open(path_ + ".part");
    ASSERT_TRUE(reader.ok());
    const auto poses = rows_of(reader.value(), "pose");
    ASSERT_FALSE(poses.empty());
    EXPECT_GE(poses.back().tick, 98) << pause_ms;
    EXPECT_TRUE(reader.value().cut());
  }
}

TEST_F(Record, PutsEveryTickInItsPlaceWhateverTheirPace) {
  auto recorder = open(config());
  auto when = std::chrono::steady_clock::now();
  hal::Tick tick = 0;
  for (const int pause_us : {0, 1500, 0, 3000, 100, 25000, 2000, 0}) {
    for (int i = 0; i < 10; ++i) {
      std::this_thread::sleep_until(when += std::chrono::microseconds(pause_us));
      ASSERT_TRUE(recorder->tick_done(space_, tick++).ok());
    }
  }
  ASSERT_TRUE(recorder->close(tick, {}).ok());
  auto reader = RecordReader::open(path_);
  ASSERT_TRUE(reader.ok());
  const auto poses = rows_of(reader.value(), "pose");
  ASSERT_EQ(poses.size(), static_cast<std::size_t>(tick) + 1);
  for (std::size_t i = 0; i < poses.size(); ++i) ASSERT_EQ(poses[i].tick, static_cast<hal::Tick>(i) - 1);
}

TEST_F(Record, KeepsTheTickOfRowsThatSomethingHappenedAfter) {
  for (int round = 0; round < 50; ++round) {
    auto recorder = open(config());
    ASSERT_TRUE(recorder->tick_done(space_, 0).ok());
    ASSERT_TRUE(recorder->event(7, {{"kind", "incident"}, {"text", "before the rows were written, perhaps"}}).ok());
    ASSERT_TRUE(recorder->close(9, {}).ok());
    auto reader = RecordReader::open(path_);
    ASSERT_TRUE(reader.ok());
    const auto poses = rows_of(reader.value(), "pose");
    ASSERT_EQ(poses.size(), 2U);
    ASSERT_EQ(poses[1].tick, 0);
  }
}

TEST_F(Record, KeepsEventsAndFingerprintsInTheirOrder) {
  auto recorder = open(config());
  ASSERT_TRUE(recorder->tick_done(space_, 0).ok());
  ASSERT_TRUE(recorder->event(0, {{"kind", "incident"}, {"text", "ep0 left the arena"}}).ok());
  ASSERT_TRUE(recorder->fingerprint(0, 0x0123456789abcdefU).ok());
  ASSERT_TRUE(recorder->close(0, {{"finished", false}}).ok());
  auto reader = RecordReader::open(path_);
  ASSERT_TRUE(reader.ok());
  bool event = false, fingerprint = false, end = false;
  while (const auto entry = reader.value().next()) {
    if (entry->type == RecordBlock::Event) event = entry->json["text"] == "ep0 left the arena";
    if (entry->type == RecordBlock::Fingerprint) fingerprint = entry->fingerprint == 0x0123456789abcdefU && event;
    if (entry->type == RecordBlock::End) end = fingerprint && entry->json["finished"] == false;
  }
  EXPECT_TRUE(end);
}

TEST_F(Record, GoesToAnyTickAtOnce) {
  record_ten_ticks();
  auto opened = RecordMoments::open(path_);
  ASSERT_TRUE(opened.ok());
  RecordMoments& moments = opened.value();
  EXPECT_EQ(moments.tick(), -1);
  ASSERT_EQ(moments.ticks().size(), 11U);
  for (const hal::Tick tick : {7, 3, 9, 0, 0, 5}) {
    moments.go_to(tick);
    ASSERT_EQ(moments.tick(), tick);
    EXPECT_NEAR(moments.poses().value(0, 1), 0.25 * static_cast<double>(tick), 1e-6);
    ASSERT_NE(moments.rows("sensor range_and_bearing"), nullptr);
  }
  EXPECT_TRUE(moments.next());
  EXPECT_EQ(moments.tick(), 6);
  moments.go_to(1000);
  EXPECT_EQ(moments.tick(), 9);
  EXPECT_FALSE(moments.next());
  EXPECT_EQ(moments.tick(), 9);
  moments.go_to(-100);
  EXPECT_EQ(moments.tick(), -1);
}

TEST_F(Record, PassesOverABranchThatWasLeft) {
  auto recorder = open(config());
  const auto step = [&](hal::Tick tick, double x_m) {
    space_.set_pose(ep1_, {x_m, 0.0, 0.0, 1.0, 0.0});
    ASSERT_TRUE(recorder->tick_done(space_, tick).ok());
  };
  for (hal::Tick tick = 0; tick < 6; ++tick) step(tick, 1.0);
  ASSERT_TRUE(recorder->event(4, {{"kind", "incident"}, {"text", "left behind"}}).ok());
  ASSERT_TRUE(recorder->event(3, {{"kind", "back"}, {"to", 3}}).ok());
  ASSERT_TRUE(recorder->event(3, {{"kind", "action"}, {"action", {{"do", "move"}}}}).ok());
  for (hal::Tick tick = 3; tick < 5; ++tick) step(tick, 2.0);
  step(4, 3.0);  // once more, and nobody said so
  ASSERT_TRUE(recorder->close(4, {}).ok());

  auto reader = RecordReader::open(path_);
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(reader.value().ticks(), (std::vector<hal::Tick>{-1, 0, 1, 2, 3, 4}));
  ASSERT_EQ(reader.value().events().size(), 3U) << "what happened did happen";
  EXPECT_EQ(reader.value().events()[1].json["kind"], "back");
  std::vector<double> x;
  for (const RecordEntry& entry : rows_of(reader.value(), "pose")) x.push_back(entry.rows->value(0, 1));
  EXPECT_EQ(x.size(), 6U);
  EXPECT_NEAR(x[3], 1.0, 1e-6);
  EXPECT_NEAR(x[4], 2.0, 1e-6);
  EXPECT_NEAR(x[5], 3.0, 1e-6);
  auto moments = RecordMoments::open(path_);
  ASSERT_TRUE(moments.ok());
  moments.value().go_to(3);
  EXPECT_NEAR(moments.value().poses().value(0, 1), 2.0, 1e-6);
}

TEST_F(Record, HoldsWhoIsHaltedUntilThatChanges) {
  auto recorder = open(config());
  for (hal::Tick tick = 0; tick < 10; ++tick) {
    space_.set_halted(ep1_, tick >= 3 && tick < 6);
    ASSERT_TRUE(recorder->tick_done(space_, tick).ok());
  }
  ASSERT_TRUE(recorder->close(9, {}).ok());
  auto reader = RecordReader::open(path_);
  ASSERT_TRUE(reader.ok());
  EXPECT_EQ(rows_of(reader.value(), "look halted").size(), 3U);  // at the start, and twice
  auto moments = RecordMoments::open(path_);
  ASSERT_TRUE(moments.ok());
  for (const hal::Tick tick : {8, 5, 4, 2, 3, 6}) {
    moments.value().go_to(tick);
    ASSERT_NE(moments.value().rows("look halted"), nullptr);
    EXPECT_EQ(moments.value().rows("look halted")->value(0, 1) != 0.0, tick >= 3 && tick < 6) << tick;
  }
}

TEST_F(Record, HoldsWhatHooksDrewUntilTheyDrawSomethingElse) {
  auto recorder = open(config());
  for (hal::Tick tick = 0; tick < 6; ++tick) {
    space_.sketch().clear();
    if (tick >= 2 && tick < 4) space_.sketch().circle({1.0, 2.0}, 0.5);
    ASSERT_TRUE(recorder->tick_done(space_, tick).ok());
  }
  ASSERT_TRUE(recorder->close(5, {}).ok());
  auto moments = RecordMoments::open(path_);
  ASSERT_TRUE(moments.ok());
  for (const hal::Tick tick : {5, 3, 1, 2}) {
    moments.value().go_to(tick);
    const Sketch drawn = sketch_of_json(moments.value().sketch());
    ASSERT_EQ(drawn.shapes().size(), tick == 2 || tick == 3 ? 1U : 0U) << tick;
    if (!drawn.shapes().empty()) {
      EXPECT_EQ(drawn.shapes()[0].radius_m, 0.5);
      EXPECT_EQ(drawn.shapes()[0].points[0].y_m, 2.0);
    }
  }
}

struct Purse {
  static constexpr std::string_view kName = "purse";
  static constexpr std::string_view kDoc = "Coins.";
  std::uint32_t coins = 0;
  double weight = 0.0;
  void describe(hal::FieldList& f) const {
    f.add("coins", coins, hal::unit::none, hal::Frame::None, hal::Fusion::Real, "");
    f.add("weight", weight, hal::unit::none, hal::Frame::None, hal::Fusion::Real, "");
  }
};

TEST_F(Record, HoldsRowsThatSomebodyElseKeepsWhereTheyChange) {
  std::vector<Purse> purses(2);
  auto recorder = open(config());
  ASSERT_TRUE(recorder->add({&hal::row_type<Purse>(), "bank", {scout_, ep1_}, purses.data()}).ok());
  for (hal::Tick tick = 0; tick < 9; ++tick) {
    if (tick % 3 == 0) purses[1] = {static_cast<std::uint32_t>(tick), 0.5};
    ASSERT_TRUE(recorder->tick_done(space_, tick).ok());
  }
  ASSERT_TRUE(recorder->close(8, {{"finished", true}}).ok());
  auto reader = RecordReader::open(path_);
  ASSERT_TRUE(reader.ok());
  const auto rows = rows_of(reader.value(), "bank purse");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[2].tick, 6);
  EXPECT_EQ(rows[2].rows->members().ids, (std::vector<std::string>{"scout", "ep1"}));
  EXPECT_EQ(rows[2].rows->value(field_named(*rows[2].rows, "coins"), 1), 6.0);
  EXPECT_EQ(rows[2].rows->value(field_named(*rows[2].rows, "weight"), 0), 0.0);
}

TEST_F(Record, HoldsInEveryTickWhatReachesTheSpaceFromOutside) {
  hal::Proximity reading;
  reading.count = 8;
  reading.validity = hal::Validity::Fresh;
  SpaceInputs inputs{{{ep0_, &hal::port_type<hal::Proximity>(), &reading}}};
  RecordConfig rarely = config({"scout"});
  rarely.every = 5;
  auto recorder = open(rarely);
  ASSERT_TRUE(recorder->set_inputs(space_, inputs).ok());
  for (hal::Tick tick = 0; tick < 300; ++tick) {
    reading.taken_ns = 1000 + tick;
    reading.count = tick % 40 < 30 ? 8 : 3;  // rows change their length
    reading.distance_m[static_cast<std::size_t>(tick % 3)] = static_cast<float>(tick);
    ASSERT_TRUE(recorder->tick_done(space_, tick).ok());
  }
  ASSERT_TRUE(recorder->close(299, hal::Json::object()).ok());
  auto reader = RecordReader::open(path_);
  ASSERT_TRUE(reader.ok());
  const auto rows = rows_of(reader.value(), "input proximity");
  ASSERT_EQ(rows.size(), 301U);  // the first is of before the run
  EXPECT_EQ(rows[0].tick, -1);
  EXPECT_EQ(rows[7].rows->members().ids, (std::vector<std::string>{"ep0"}));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const RecordRows& row = *rows[i].rows;
    ASSERT_EQ(row.value(field_named(row, "taken_ns"), 0), 999.0 + static_cast<double>(i));
    const std::size_t distance = field_named(row, "distance");
    ASSERT_EQ(row.used(distance, 0), (i - 1) % 40 < 30 ? 8U : 3U);
    ASSERT_EQ(row.value(distance, 0, (i - 1) % 3), static_cast<double>(i - 1));
  }
  EXPECT_THAT(reader.value().damage(), testing::IsEmpty());
}

TEST_F(Record, InputsAfterALostBlockAreLeftOutUntilABlockStandsForItself) {
  hal::Proximity reading;
  SpaceInputs inputs{{{ep0_, &hal::port_type<hal::Proximity>(), &reading}}};
  auto recorder = open(config({"scout"}));
  ASSERT_TRUE(recorder->set_inputs(space_, inputs).ok());
  for (hal::Tick tick = 0; tick < 300; ++tick) {
    reading.taken_ns = 1000 + tick;
    ASSERT_TRUE(recorder->tick_done(space_, tick).ok());
  }
  ASSERT_TRUE(recorder->close(299, hal::Json::object()).ok());
  std::size_t at = 0;
  {
    auto file = BlockFileReader::open(path_);
    ASSERT_TRUE(file.ok());
    while (const auto block = file.value().next()) {
      if (block->type == static_cast<std::uint16_t>(RecordBlock::Inputs) && block->tick == 20) at = block->at;
    }
  }
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(at + kBlockHeaderBytes + 3));
  file.put('\x55');
  file.close();
  auto reader = RecordReader::open(path_);
  ASSERT_TRUE(reader.ok());
  const auto rows = rows_of(reader.value(), "input proximity");
  ASSERT_FALSE(rows.empty());
  EXPECT_THAT(reader.value().damage(), testing::SizeIs(2));  // the block, and the one that builds on it
  for (const auto& entry : rows) EXPECT_TRUE(entry.tick < 20 || entry.tick >= 127) << entry.tick;
  EXPECT_EQ(rows.back().tick, 299);
  EXPECT_EQ(rows.back().rows->value(field_named(*rows.back().rows, "taken_ns"), 0), 1299.0);
}

}  // namespace
}  // namespace tandem::core
