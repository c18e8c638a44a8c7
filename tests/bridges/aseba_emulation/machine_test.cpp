// The virtual machine, with words as ASEBA's own compiler (aseba 1.6.99) makes them.
#include "bridges/aseba_emulation/machine.hpp"

#include <gmock/gmock.h>

namespace tandem::bridges::aseba_emulation {
namespace {

using testing::ElementsAre;

constexpr std::uint16_t kTimer = 0xFFFD, kInit = 0xFFFF;

NodeSpec spec(std::vector<std::vector<std::int16_t>>& calls) {
  NodeSpec spec;
  spec.name = "n";
  spec.variables = {
      {"_id", 1},         {"event.source", 1}, {"event.args", 32}, {"motor.left.target", 1}, {"motor.right.target", 1},
      {"timer.period", 2}};
  spec.events = {{"buttons", ""}, {"timer0", ""}};
  spec.functions = {{"sound.freq", "", {{1, "a"}, {1, "b"}}},
                    {"leds.top", "", {{1, "r"}, {1, "g"}, {1, "b"}}, [&calls](std::span<const std::int16_t> values) {
                       calls.emplace_back(values.begin(), values.end());
                     }}};
  spec.bytecode_words = 64;
  spec.stack_words = 8;
  spec.variable_words = 60;
  spec.runs_programs = true;
  spec.reset_clears = true;
  return spec;
}

/// onevent timer0: if alive > 0 then alive -= 1, motor.left.target = l, else 0 end;
/// if led[0] != 0 then call leds.top(led[0], led[1], led[2]) end. At the start: timer.period[0] = 20.
/// Its variables: alive 38, l 39, r 40, led 41 to 43.
const std::vector<std::uint16_t> kProgram = {0x0005, 0xfffd, 0x0005, 0xffff, 0x001b, 0x3026, 0x1000, 0xa00c,
                                             0x0009, 0x3026, 0x1001, 0x8003, 0x4026, 0x3027, 0x4022, 0x9003,
                                             0x1000, 0x4022, 0x3029, 0x1000, 0xa00b, 0x0006, 0x102b, 0x102a,
                                             0x1029, 0xc001, 0x0000, 0x1014, 0x4024, 0x0000};

class ANode : public testing::Test {
 protected:
  ANode() : node_(spec(calls_)) {}
  std::vector<Message> ask(std::uint16_t type, const std::vector<std::uint16_t>& words) {
    Message question{0, type, {}};
    for (const std::uint16_t word : words) question.add(word);
    std::vector<Message> answers;
    node_.obey(question, 0, answers, sink_);
    return answers;
  }
  void load(std::vector<std::uint16_t> program) {
    program.insert(program.begin(), {std::uint16_t{1}, std::uint16_t{0}});
    ask(type::kSetBytecode, program);
  }
  void set(std::uint16_t address, std::uint16_t value) { ask(type::kSetVariables, {1, address, value}); }
  std::vector<Message> tick() {
    std::vector<Message> said;
    node_.happen("timer0", 0, said, sink_);
    return said;
  }
  int get(std::uint16_t address) {
    return static_cast<std::int16_t>(ask(type::kGetVariables, {1, address, 1}).at(0).word(1));
  }

  std::vector<std::vector<std::int16_t>> calls_;
  EventSink sink_ = [](hal::TimeNs, std::string_view, const EventFields&) {};
  Node node_;
};

TEST_F(ANode, RunsItsProgramOnceToldTo) {
  load(kProgram);
  EXPECT_EQ(get(36), 0) << "it waits";
  ask(type::kRun, {1});
  EXPECT_EQ(get(36), 20);
  set(38, 2);
  set(39, 123);
  EXPECT_TRUE(tick().empty());
  EXPECT_EQ(get(34), 123);
  EXPECT_EQ(get(38), 1);
  tick();
  tick();
  EXPECT_EQ(get(38), 0);
  EXPECT_EQ(get(34), 0);
  EXPECT_TRUE(calls_.empty());
}

TEST_F(ANode, CallsNativeFunctionsWithVariables) {
  load(kProgram);
  ask(type::kRun, {1});
  set(41, 7);
  set(42, 8);
  set(43, 9);
  tick();
  EXPECT_THAT(calls_, ElementsAre(ElementsAre(7, 8, 9)));
}

TEST_F(ANode, IsClearedByANewProgram) {
  set(38, 5);
  load(kProgram);
  EXPECT_EQ(get(38), 0);
  EXPECT_EQ(get(0), 1) << "but its number";
  EXPECT_TRUE(node_.take_reset());
  EXPECT_FALSE(node_.take_reset());
}

TEST_F(ANode, StopsAndSaysWhyWhereAProgramCannotGoOn) {
  // 1 / 0; an array; a function that is not emulated; what never ends.
  const std::vector<std::pair<std::vector<std::uint16_t>, std::uint16_t>> programs = {
      {{3, kInit, 3, 0x1001, 0x1000, 0x8005, 0}, type::kDivisionByZero},
      {{3, kInit, 3, 0x5000, 0}, type::kNodeError},
      {{3, kInit, 3, 0x1022, 0x1022, 0xC000, 0}, type::kNodeError},
      {{3, kInit, 3, 0x4000, 0}, type::kNodeError},
      {{3, kInit, 3, 0x9000, 0}, type::kExecutionKilled}};
  for (const auto& [program, error] : programs) {
    load(program);
    const auto said = ask(type::kRun, {1});
    ASSERT_EQ(said.size(), 2U);
    EXPECT_EQ(said[1].type, error);
    EXPECT_EQ(ask(type::kGetExecutionState, {1}).at(0).word(1), 2) << "it runs no further";
  }
}

TEST_F(ANode, RemembersForWhenWhetherItHeld) {
  // when alive > 0 do l = l + 1 end
  load({3, kTimer, 3, 0x3026, 0x1000, 0xA10C, 0x0006, 0x3027, 0x1001, 0x8002, 0x4027, 0});
  ask(type::kRun, {1});
  set(38, 1);
  for (int i = 0; i < 3; ++i) tick();
  EXPECT_EQ(get(39), 1) << "only as it becomes true";
  set(38, 0);
  tick();
  set(38, 1);
  tick();
  EXPECT_EQ(get(39), 2);
}

}  // namespace
}  // namespace tandem::bridges::aseba_emulation
