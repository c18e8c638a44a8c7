// Faults: how they are written, and what they do to messages.
#include "bridges/eyebot_emulator/faults.hpp"

#include "tests/bridges/eyebot_emulator/bench.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

using testing::HasSubstr;
constexpr hal::TimeNs kSecond = hal::kNsPerSecond;

FaultPlan plan(const std::vector<std::string>& texts) {
  std::vector<Fault> faults;
  for (const std::string& text : texts) {
    auto fault = kFaults.parse(text);
    EXPECT_TRUE(fault.ok()) << fault.error().message;
    faults.push_back(fault.value());
  }
  FaultPlan made(faults, 1);
  return made;
}

Datagram report(int number, hal::TimeNs at, const std::string& topic = "state") {
  Bytes data(20, std::byte{0});
  data[8] = static_cast<std::byte>(number & 0xFF);
  return {"eyebot/eb0/" + topic, data, at};
}

std::vector<int> numbers(const std::vector<Datagram>& all) {
  std::vector<int> n;
  for (const Datagram& d : all) n.push_back(std::to_integer<int>(d.data.at(8)));
  return n;
}

/// What arrives of `count` reports, a millisecond apart.
std::vector<Datagram> after(const std::string& fault, int count, const std::string& topic = "state") {
  FaultPlan p = plan({fault});
  p.begin(0);
  std::vector<Datagram> out;
  for (int i = 0; i < count; ++i) p.to_hub(report(i, i * kMs, topic), out);
  return out;
}

TEST(Faults, AreRead) {
  const auto silent = kFaults.parse("silent=state@5s+2s");
  ASSERT_TRUE(silent.ok());
  EXPECT_EQ(silent.value().word, "state");
  EXPECT_EQ(silent.value().from, 5 * kSecond);
  EXPECT_EQ(silent.value().until, 7 * kSecond);
  EXPECT_EQ(kFaults.parse("clock=1h@3s").value().time_ns, 3600 * kSecond);
  EXPECT_EQ(kFaults.parse("clock=-250ms@3s").value().time_ns, -250 * kMs);
  EXPECT_EQ(kFaults.parse("battery=0.05@3s").value().number, 0.05);
  EXPECT_EQ(kFaults.parse("flood=2000@1s").value().number, 2000);
  EXPECT_EQ(kFaults.parse("lag=300ms").value().time_ns, 300 * kMs);
}

TEST(Faults, AreRefusedWithTheManual) {
  for (const std::string text :
       {"explode@3s", "drop", "drop=2", "restart", "restart=1@3s", "battery=7@3s", "clock=x@3s", "flood=50@1s",
        "flood=1e9@1s", "delay=-1s", "no-position=1", "clock=1e12h@1s", ""}) {
    const auto fault = kFaults.parse(text);
    ASSERT_FALSE(fault.ok()) << text;
    EXPECT_THAT(fault.error().message, HasSubstr("no-position@5s+3s")) << text;
  }
}

TEST(Faults, OfTheManualAreAllGood) {
  std::istringstream manual(kFaults.manual());
  int count = 0;
  for (std::string line; std::getline(manual, line) && line.starts_with("  ");) {
    const std::string example = line.substr(2, line.find(' ', 2) - 2);
    EXPECT_TRUE(kFaults.parse(example).ok()) << example;
    ++count;
  }
  EXPECT_EQ(count, 23);
}

TEST(Reports, PassWithoutFaults) {
  FaultPlan p({}, 1);
  p.begin(0);
  std::vector<Datagram> out;
  p.to_hub(report(3, 7), out);
  ASSERT_EQ(out.size(), 1U);
  EXPECT_EQ(out[0].at, 7);
  EXPECT_EQ(out[0].data, report(3, 7).data);
}

TEST(Reports, OfASilentChannelAreMissing) {
  EXPECT_EQ(numbers(after("silent=state@2ms+3ms", 8)), (std::vector{0, 1, 5, 6, 7}));
  EXPECT_EQ(after("silent=state", 8, "status").size(), 8U);
  EXPECT_EQ(after("silent", 8, "status").size(), 0U);
}

TEST(Reports, AreLostDoubledAndSwapped) {
  const std::size_t left = after("drop=0.5", 200).size();
  EXPECT_GT(left, 60U);
  EXPECT_LT(left, 140U);
  EXPECT_EQ(numbers(after("double=1", 3)), (std::vector{0, 0, 1, 1, 2, 2}));
  EXPECT_EQ(numbers(after("swap=1", 6)), (std::vector{1, 0, 3, 2, 5, 4}));
}

TEST(Reports, AreLate) {
  const auto late = after("delay=50ms@0s+2ms", 4);
  ASSERT_EQ(late.size(), 4U);
  EXPECT_EQ(late[0].at, 50 * kMs);
  EXPECT_EQ(late[1].at, 51 * kMs);
  EXPECT_EQ(late[2].at, 51 * kMs) << "none overtakes another";
}

TEST(Reports, OfOneChannelAreDamagedFromTheStart) {
  for (const Datagram& d : after("damage=state", 3)) EXPECT_EQ(d.data[0], std::byte{0xFF});
  for (const Datagram& d : after("damage=state", 3, "status")) EXPECT_EQ(d.data[0], std::byte{0});
}

TEST(Reports, AreStampedAnHourAhead) {
  const auto ahead = after("future=1", 1);
  ASSERT_EQ(ahead.size(), 1U);
  std::uint64_t stamp_us = 0;
  for (std::size_t i = 8; i < 16; ++i) stamp_us = stamp_us << 8U | std::to_integer<std::uint64_t>(ahead[0].data[i]);
  EXPECT_EQ(stamp_us, 3'600'000'000U);
}

TEST(Reports, AreDamaged) {
  const auto foreign = after("fingerprint=1", 1);
  EXPECT_EQ(foreign[0].data[0], std::byte{0xFF});
  EXPECT_EQ(foreign[0].data.size(), 20U);
  for (const Datagram& d : after("truncate=1", 50)) EXPECT_LT(d.data.size(), 20U);
}

TEST(Commands, AreLostRepeatedOvertakenAndLate) {
  const auto arriving = [](const std::string& fault) {
    FaultPlan p = plan({fault});
    p.begin(0);
    std::vector<Datagram> out;
    for (int i = 0; i < 4; ++i) p.to_robot(report(i, i * kMs, "cmd/velocity"), out);
    return out;
  };
  EXPECT_TRUE(arriving("lose=1").empty());
  EXPECT_EQ(numbers(arriving("repeat=1")), (std::vector{0, 0, 1, 1, 2, 2, 3, 3}));
  EXPECT_EQ(numbers(arriving("overtake=1")), (std::vector{1, 0, 3, 2}));
  EXPECT_EQ(arriving("lag=300ms")[0].at, 300 * kMs);
  EXPECT_TRUE(arriving("deaf=cmd/velocity").empty());
  EXPECT_EQ(arriving("deaf=cmd/mode").size(), 4U);
  EXPECT_EQ(numbers(arriving("silent")).size(), 4U) << "a mute robot hears";
}

TEST(Faults, ComeAndGoInOrder) {
  FaultPlan p = plan({"no-position@3s+1s", "restart@2s", "battery=0.5@3s"});
  p.begin(10 * kSecond);
  EXPECT_EQ(p.next_change_at(), 12 * kSecond);
  EXPECT_FALSE(p.next_change(11 * kSecond));
  std::vector<std::string> order;
  while (const auto change = p.next_change(20 * kSecond)) {
    order.push_back(change->fault->text + (change->begins ? " begins" : " ends"));
  }
  EXPECT_EQ(order, (std::vector<std::string>{"restart@2s begins", "no-position@3s+1s begins", "battery=0.5@3s begins",
                                             "no-position@3s+1s ends"}));
  EXPECT_FALSE(p.next_change_at());
}

/// A robot in the air, and the changes of one fault.
struct Flight {
  explicit Flight(const std::string& fault) : faults(plan({fault})) {
    bench.take_off();
    faults.begin(bench.now);
  }
  void next() {
    const auto change = faults.next_change(bench.now);
    ASSERT_TRUE(change);
    apply(*change, bench.robot, 77);
    bench.pass(kSecond);
  }
  Bench bench;
  FaultPlan faults;
};

TEST(Faults, ReachTheRobot) {
  Flight position("no-position@0s+1s");
  position.next();
  EXPECT_EQ(position.bench.failsafe(), Failsafe::NoPosition);
  position.next();
  EXPECT_EQ(position.bench.failsafe(), Failsafe::None);

  Flight hardware("hardware@0s+1s");
  hardware.next();
  hardware.next();
  EXPECT_EQ(hardware.bench.failsafe(), Failsafe::Hardware) << "latched";

  Flight battery("battery=0.01@0s");
  battery.next();
  EXPECT_EQ(battery.bench.failsafe(), Failsafe::LowBattery);

  Flight restart("restart@0s");
  restart.next();
  EXPECT_EQ(restart.bench.mode(), Mode::Idle);
  EXPECT_EQ(restart.bench.status().head.session, 77);

  Flight clock("clock=-1h@0s");
  const std::int64_t before = clock.bench.robot.utime(0);
  clock.next();
  EXPECT_EQ(clock.bench.robot.utime(0), before - 3'600'000'000);

  Flight flood("flood=1000@0s+1s");
  flood.bench.sent("");
  flood.next();
  EXPECT_EQ(flood.bench.sent("state").size(), 1000U);
  flood.next();
  EXPECT_EQ(flood.bench.sent("state").size(), 50U);
}

}  // namespace
}  // namespace tandem::bridges::eyebot_emulator
