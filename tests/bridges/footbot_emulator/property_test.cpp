// Whatever a host sends, the robot stays what it is.
#include <rapidcheck.h>

#include "bridges/aseba_emulation/stream.hpp"
#include "bridges/footbot_emulator/slcan_adapter.hpp"
#include "tests/bridges/footbot_emulator/bench.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using aseba_emulation::StreamReader;
using aseba_emulation::to_bytes;

/// Frames that are often nearly sensible.
rc::Gen<Frame> any_frame() {
  return rc::gen::apply(
      [](int part, int source, std::vector<std::uint8_t> bytes, int type) {
        Frame f;
        f.id = static_cast<std::uint16_t>(part << 8 | source);
        f.size = static_cast<std::uint8_t>(std::min<std::size_t>(bytes.size(), 8));
        std::copy_n(bytes.begin(), f.size, f.data.begin());
        if (f.size >= 4 && type < 18) {
          f.data[0] = static_cast<std::uint8_t>(type);
          f.data[1] = 0xA0;
          f.data[2] = static_cast<std::uint8_t>(f.data[2] % 11);
          f.data[3] = 0;
        }
        return f;
      },
      rc::gen::inRange(0, 8), rc::gen::weightedOneOf<int>({{4, rc::gen::just(0)}, {1, rc::gen::inRange(0, 256)}}),
      rc::gen::container<std::vector<std::uint8_t>>(8, rc::gen::arbitrary<std::uint8_t>()), rc::gen::inRange(0, 24));
}

TEST(AnyHost, FindsARobotThatAnswersAfterwards) {
  EXPECT_TRUE(rc::check([] {
    Bench bench({.protocol = Protocol::V5});
    for (const Frame& f : *rc::gen::container<std::vector<Frame>>(any_frame())) {
      bench.robot.receive(f, bench.now);
      bench.pass(*rc::gen::inRange<hal::TimeNs>(0, 30 * kMs));
      RC_ASSERT(std::abs(bench.robot.command().left_m_s) <= 0.3);
      RC_ASSERT(std::abs(bench.robot.command().right_m_s) <= 0.3);
    }
    bench.pass(2000 * kMs);
    RC_ASSERT(bench.ask("300#11A00500").size() == 9U);
  }));
}

TEST(AnyHost, GetsTheSameFromTheSame) {
  EXPECT_TRUE(rc::check([] {
    const auto frames = *rc::gen::container<std::vector<Frame>>(any_frame());
    Bench one;
    Bench other;
    for (const Frame& f : frames) {
      one.robot.receive(f, one.now);
      other.robot.receive(f, other.now);
      one.pass(7 * kMs);
      other.pass(3 * kMs);  // looked at more often
      other.pass(4 * kMs);
    }
    one.pass(1000 * kMs);
    other.pass(1000 * kMs);
    RC_ASSERT(one.log == other.log);
    RC_ASSERT(one.heard() == other.heard());
  }));
}

TEST(AnyHost, CannotConfuseTheAdapter) {
  EXPECT_TRUE(rc::check([](const std::vector<std::uint8_t>& bytes) {
    SlcanAdapter adapter([](hal::TimeNs, std::string_view, const EventFields&) {});
    std::vector<Frame> to_bus;
    adapter.receive(bytes, 0, to_bus);
    for (const Frame& f : to_bus) RC_ASSERT(f.id <= 0x7FF && f.size <= 8);
    const std::string again = "\rC\rS8\rO\rt300411A00500\r";
    to_bus.clear();
    adapter.receive({reinterpret_cast<const std::uint8_t*>(again.data()), again.size()}, 0, to_bus);
    RC_ASSERT(texts(to_bus).back() == "300#11A00500");
  }));
}

TEST(AnyMessage, SurvivesFramesAndStream) {
  EXPECT_TRUE(rc::check([](std::uint8_t source, std::uint16_t type) {
    const auto size = *rc::gen::inRange<std::size_t>(0, kMostPayload + 1);
    const Message message{source, type,
                          *rc::gen::container<std::vector<std::uint8_t>>(size, rc::gen::arbitrary<std::uint8_t>())};
    Assembler assembler;
    std::optional<Message> whole;
    for (const Frame& f : to_frames(message)) {
      RC_ASSERT(!whole);
      whole = assembler.push(f);
    }
    RC_ASSERT(whole == message);
    StreamReader reader;
    reader.push(to_bytes(message));
    RC_ASSERT(reader.next() == message);
    RC_ASSERT(!reader.next());
  }));
}

}  // namespace
}  // namespace tandem::bridges::footbot_emulator
