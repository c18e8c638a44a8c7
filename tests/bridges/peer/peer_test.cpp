// The lock-step protocol by its bytes, as bridges/peer/README.md has them.
#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bridges/peer/peer_side.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/robot/epuck.hpp"
#include "tests/bridges/link/memory_link.hpp"

namespace tandem::bridges::peer {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

Bytes bytes(std::string_view text) {
  return {text.begin(), text.end()};
}

TEST(Frame, HasTheChecksumOfZip) {
  EXPECT_EQ(crc32(bytes("123456789")), 0xCBF43926U);
}

TEST(Frame, LiesOnTheWireAsDocumented) {
  EXPECT_THAT(frame_of(MessageType::Bye, bytes("{}")),
              ElementsAre('T', 'L', 7, 0xF6, 2, 0, 0, 0, '{', '}', 0x24, 0xD5, 0xFE, 0xC7));
}

TEST(FrameReader, FindsFramesWhateverIsBetweenThem) {
  FrameReader reader;
  Bytes stream = bytes("TLTTnoise");
  const Bytes good = frame_of(MessageType::Hello, bytes("TL"));
  Bytes garbled = frame_of(MessageType::Tick, bytes("lost"));
  garbled[9] ^= 0x40;
  Bytes long_one = frame_of(MessageType::Tick, bytes("x"));
  long_one[6] = 9;  // a length that is not that of its check
  for (const Bytes* part : std::initializer_list<const Bytes*>{&good, &garbled, &long_one, &good})
    stream.insert(stream.end(), part->begin(), part->end());
  int found = 0;
  for (const std::uint8_t byte : stream) {
    reader.push(std::span(&byte, 1));
    while (const auto frame = reader.next()) {
      ++found;
      EXPECT_EQ(frame->type, MessageType::Hello);
      EXPECT_EQ(Bytes(frame->payload.begin(), frame->payload.end()), bytes("TL"));
    }
  }
  EXPECT_EQ(found, 2);
  EXPECT_EQ(reader.garbled(), 1U);
  EXPECT_GT(reader.skipped_bytes(), 20U);
}

TEST(RowForm, LeavesOutWhatIsNotInUse) {
  const RowForm form(hal::port_type<hal::WheelSpeeds>());
  hal::WheelSpeeds wheels;
  wheels.set(1.0, -2.0);
  Bytes packed;
  form.pack(&wheels, packed);
  EXPECT_THAT(packed, ElementsAre(0, 0, 0, 0, 0, 0, 0xF0, 0x3F, 0, 0, 0, 0, 0, 0, 0, 0xC0));
  EXPECT_EQ(hal::to_text(form.fields()), R"([["left","f64",1,"",1],["right","f64",1,"",1]])");

  const RowForm ring(hal::port_type<hal::Proximity>());
  hal::Proximity reading;
  reading.count = 2;
  reading.distance_m[0] = 0.5F;
  packed.clear();
  ring.pack(&reading, packed);
  const std::size_t of_two = packed.size();
  reading.count = 0;
  packed.clear();
  ring.pack(&reading, packed);
  EXPECT_EQ(of_two - packed.size(), 2 * sizeof(float));
}

TEST(RowForm, BringsEveryPortBack) {
  const RowForm form(hal::port_type<hal::RangeAndBearingSend>());
  hal::RangeAndBearingSend sent, got;
  sent.sending = true;
  sent.size = 3;
  sent.payload = {7, 8, 9};
  Bytes packed;
  form.pack(&sent, packed);
  std::span<const std::uint8_t> in = packed;
  ASSERT_TRUE(form.unpack(in, &got));
  EXPECT_TRUE(in.empty());
  EXPECT_TRUE(got.sending);
  EXPECT_EQ(got.size, 3);
  EXPECT_EQ(got.payload[2], 9);
}

TEST(RowForm, RefusesMoreEntriesThanThereCanBe) {
  const RowForm form(hal::port_type<hal::RangeAndBearingSend>());
  hal::RangeAndBearingSend sent, got;
  sent.size = 3;
  Bytes packed;
  form.pack(&sent, packed);
  packed.resize(packed.size() + 300);
  for (std::size_t at = 0; at < 2; ++at) {
    Bytes bad = packed;
    std::replace(bad.begin(), bad.begin() + 8, std::uint8_t{3}, std::uint8_t{200});
    std::span<const std::uint8_t> in = bad;
    EXPECT_FALSE(form.unpack(in, &got));
  }
  std::span<const std::uint8_t> nothing;
  EXPECT_FALSE(form.unpack(nothing, &got));
}

/// Drives with the number of the tick.
class Counting final : public PeerController {
 public:
  explicit Counting(const RobotMessage& robot)
      : robot_(robot, hal::epuck::kind(), kTypes),
        proximity_(robot_.sensor<hal::Proximity>()),
        wheels_(robot_.actuator<hal::WheelSpeeds>()) {}
  PeerRobot& robot() noexcept override { return robot_; }
  bool step(hal::Tick tick, std::string& why) override {
    ++steps;
    wheels_.set(static_cast<double>(tick), static_cast<double>(proximity_.count));
    why = "too far";
    return tick < 5;
  }
  static inline int steps = 0;

 private:
  static inline const std::vector<const hal::PortType*> kTypes = {&hal::port_type<hal::Proximity>(),
                                                                  &hal::port_type<hal::WheelSpeeds>()};
  PeerRobot robot_;
  const hal::Proximity& proximity_;
  hal::WheelSpeeds& wheels_;
};

class PeerSideOnAWire : public testing::Test {
 protected:
  PeerSideOnAWire() {
    auto ends = MemoryLink::make_pair();
    hub_ = std::move(ends.first);
    wire_ = std::move(ends.second);
    Counting::steps = 0;
    side_.link_opened();
  }
  void say(MessageType type, const Bytes& payload) { (void)hub_->write(frame_of(type, payload), 0); }
  /// What the peer says once it has heard all.
  std::vector<std::pair<MessageType, Bytes>> hear(hal::TimeNs now = 1) {
    side_.pump(*wire_, now);
    std::array<std::uint8_t, 4096> buffer;
    for (auto got = hub_->read(buffer); got.size > 0; got = hub_->read(buffer))
      reader_.push(std::span(buffer).first(got.size));
    std::vector<std::pair<MessageType, Bytes>> all;
    while (const auto frame = reader_.next())
      all.push_back({frame->type, Bytes(frame->payload.begin(), frame->payload.end())});
    return all;
  }
  static RobotMessage robot() {
    RobotMessage m{"s1", "ep0", "e-puck", "test", 10, 7, 0, {}, {}, {}, kVersion};
    for (const hal::PortType* type : {&hal::port_type<hal::Proximity>(), &hal::port_type<hal::WheelSpeeds>()}) {
      const RowForm form(*type);
      m.ports.push_back({type->role, std::string(type->name), form.digest()});
      m.fields.push_back(form.fields());
    }
    return m;
  }
  static Bytes tick(hal::Tick number) {
    Bytes payload;
    append_tick(payload, number, 0);
    const hal::Proximity reading;
    RowForm(hal::port_type<hal::Proximity>()).pack(&reading, payload);
    return payload;
  }

  std::unique_ptr<MemoryLink> hub_, wire_;
  FrameReader reader_;
  PeerSide side_{"ep0", [](const RobotMessage& robot) -> hal::Result<std::unique_ptr<PeerController>> {
                   try {
                     return std::unique_ptr<PeerController>(std::make_unique<Counting>(robot));
                   } catch (const std::exception& e) {
                     return hal::Error{e.what()};
                   }
                 }};
};

TEST_F(PeerSideOnAWire, SaysHelloUntilItIsHeard) {
  EXPECT_EQ(hear(1).size(), 1U);
  EXPECT_EQ(hear(2).size(), 0U);
  const auto again = hear(1 + PeerSide::kHelloEvery_ns);
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(std::string(again[0].second.begin(), again[0].second.end()),
            R"({"protocol":"tandem lockstep","version":1,"robot":"ep0"})");
}

TEST_F(PeerSideOnAWire, AnswersATickOnceHoweverOftenItComes) {
  (void)hear();
  say(MessageType::Robot, bytes_of(robot()));
  const auto ready = hear();
  ASSERT_EQ(ready.size(), 1U);
  EXPECT_EQ(ready[0].first, MessageType::Ready);
  say(MessageType::Tick, tick(0));
  say(MessageType::Tick, tick(3));
  say(MessageType::Tick, tick(3));
  say(MessageType::Tick, tick(0));  // of long ago
  const auto answers = hear();
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_EQ(answers[1], answers[2]);
  EXPECT_THAT(answers[1].second,
              ElementsAre(3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 8, 0x40, 0, 0, 0, 0, 0, 0, 0, 0));
  EXPECT_EQ(Counting::steps, 2);
  EXPECT_EQ(side_.counts().asked_again, 1U);
  EXPECT_EQ(side_.counts().not_understood, 1U);
}

TEST_F(PeerSideOnAWire, TellsThatItsControllerThrew) {
  say(MessageType::Robot, bytes_of(robot()));
  say(MessageType::Tick, tick(5));
  const auto answers = hear();
  ASSERT_GE(answers.size(), 2U);
  EXPECT_EQ(answers[1].second[8], kThrew);
  EXPECT_EQ(std::string(answers[1].second.begin() + 9, answers[1].second.end()), "too far");
}

TEST_F(PeerSideOnAWire, GoesOnWithItsOwnControllerOnAnotherLink) {
  say(MessageType::Robot, bytes_of(robot()));
  say(MessageType::Tick, tick(2));
  (void)hear();
  side_.link_opened();
  const auto hello = hear(5);
  ASSERT_EQ(hello.size(), 1U);
  EXPECT_EQ(std::string(hello[0].second.begin(), hello[0].second.end()),
            R"({"protocol":"tandem lockstep","version":1,"robot":"ep0","session":"s1","answered":2})");
  RobotMessage other = robot();
  other.session = "s2";
  say(MessageType::Robot, bytes_of(other));
  (void)hear();
  ASSERT_TRUE(side_.ended());
  EXPECT_THAT(side_.ended()->text, HasSubstr("another run"));
}

TEST_F(PeerSideOnAWire, EndsWhenTheHubsRobotIsOfAnotherForm) {
  RobotMessage other = robot();
  other.ports[0].digest = "0";
  say(MessageType::Robot, bytes_of(other));
  const auto said = hear();
  ASSERT_TRUE(side_.ended());
  EXPECT_THAT(side_.ended()->text, HasSubstr("sensor 'proximity' has another form here than in the hub"));
  EXPECT_EQ(said.back().first, MessageType::Bye);
}

}  // namespace
}  // namespace tandem::bridges::peer
