#include <gtest/gtest.h>

// Needs the test framework before it.
#include <rapidcheck/gtest.h>

#include "tests/bridges/epuck_emulator/bench.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

/// Bytes of which many mean something to the robot.
rc::Gen<std::uint8_t> talk() {
  return rc::gen::weightedOneOf<std::uint8_t>({{3, rc::gen::arbitrary<std::uint8_t>()},
                                               {3, rc::gen::inRange<std::uint8_t>(0x80, 0xFF)},
                                               {3, rc::gen::inRange<std::uint8_t>('A', 'z')},
                                               {2, rc::gen::element<std::uint8_t>(0, '\r', '\n', ',', '-', '9')}});
}

std::vector<SentByte> heard_of(Variant variant, const std::vector<std::uint8_t>& said,
                               const std::vector<TimeNs>& looks) {
  HeldBody body;
  Firmware firmware({.variant = variant}, body, {});
  firmware.power_on(0);
  std::vector<SentByte> out;
  TimeNs now = 0;
  std::size_t look = 0;
  for (const std::uint8_t byte : said) {
    const TimeNs next = now + 2 * kByteNs;
    if (look < looks.size()) {  // somebody looks between two bytes
      const TimeNs at = now + looks[look++] % (2 * kByteNs);
      firmware.run_until(at);
      firmware.take_sent(at, out);
    }
    now = next;
    firmware.receive(byte, now);
  }
  now += 600 * kSecond;
  firmware.run_until(now);
  firmware.take_sent(now, out);
  return out;
}

Variant any_variant() {
  return static_cast<Variant>(*rc::gen::inRange(0, 4));
}

RC_GTEST_PROP(FirmwareProperty, NoInputCrashesItAndItsAnswersComeInOrder, ()) {
  const auto said = *rc::gen::container<std::vector<std::uint8_t>>(talk());
  const auto out = heard_of(any_variant(), said, {});
  RC_ASSERT(out.size() >= kGreeting.size());
  for (std::size_t i = 1; i < out.size(); ++i) RC_ASSERT(out[i].at >= out[i - 1].at + kByteNs);
}

RC_GTEST_PROP(FirmwareProperty, WhenItIsLookedAtDoesNotMatter, ()) {
  const Variant variant = any_variant();
  const auto said = *rc::gen::container<std::vector<std::uint8_t>>(talk());
  const auto looks = *rc::gen::container<std::vector<TimeNs>>(rc::gen::inRange<TimeNs>(0, 2 * kByteNs));
  RC_ASSERT(heard_of(variant, said, looks) == heard_of(variant, said, {}));
}

RC_GTEST_PROP(FirmwareProperty, ZerosAndACarriageReturnAlwaysBringItBack, ()) {
  const Variant variant = any_variant();
  Bench robot(variant);
  auto said = *rc::gen::container<std::vector<std::uint8_t>>(talk());
  robot.say({reinterpret_cast<const char*>(said.data()), said.size()});
  robot.say(std::string(40, '\0'));
  robot.say("\r");
  robot.say("S\r");  // after a lone CR in the idle state this is skipped to, and obeyed
  const std::string answer = robot.say("V\r");
  RC_ASSERT(answer.find("v,Version") != std::string::npos);
}

RC_GTEST_PROP(FirmwareProperty, WheelsNeverTurnFasterThanTheMotorsCan, (std::int16_t left, std::int16_t right)) {
  const Variant variant = any_variant();
  Bench robot(variant);
  robot.say("D," + std::to_string(left) + "," + std::to_string(right) + "\r");
  const double limit_m_s = facts_of(variant).speed_limit_steps_s * kStep_m * (1.0 + 1e-5);
  RC_ASSERT(std::abs(robot.body.command().left_m_s) <= limit_m_s);
  RC_ASSERT(std::abs(robot.body.command().right_m_s) <= limit_m_s);
}

}  // namespace
}  // namespace tandem::bridges::epuck_emulator
