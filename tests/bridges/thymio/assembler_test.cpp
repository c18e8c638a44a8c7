#include "bridges/thymio/assembler.hpp"

#include <gmock/gmock.h>

#include "bridges/thymio/program.hpp"

namespace tandem::bridges::thymio {
namespace {

using testing::HasSubstr;

// The program of tests/bridges/aseba_emulation/machine_test.cpp: ASEBA's own compiler makes these words of it.
TEST(Assembler, MakesTheWordsOfAsebasCompiler) {
  Assembler code;
  code.begin(local_event(1));
  code.load(38).push(0).begin_if(Op::Greater);
  code.load(38).push(1).apply(Op::Subtract).store(38);
  code.load(39).store(34);
  code.otherwise().push(0).store(34).end_if();
  code.load(41).push(0).begin_if(Op::NotEqual).call(1, {41, 42, 43}).end_if();
  code.begin(kInitEvent);
  code.push(20).store(36);
  EXPECT_THAT(code.finish(),
              testing::ElementsAre(0x0005, 0xfffd, 0x0005, 0xffff, 0x001b, 0x3026, 0x1000, 0xa00c, 0x0009, 0x3026,
                                   0x1001, 0x8003, 0x4026, 0x3027, 0x4022, 0x9003, 0x1000, 0x4022, 0x3029, 0x1000,
                                   0xa00b, 0x0006, 0x102b, 0x102a, 0x1029, 0xc001, 0x0000, 0x1014, 0x4024, 0x0000));
}

TEST(Assembler, PushesNumbersOfAnySize) {
  Assembler code;
  code.begin(kInitEvent);
  code.push(-1).push(2047).push(-2048).push(2048).push(-30000);
  EXPECT_THAT(code.finish(),
              testing::ElementsAre(3, 0xffff, 3, 0x1fff, 0x17ff, 0x1800, 0x2000, 2048, 0x2000, 0x8ad0, 0));
}

aseba::NodeDescription thymio_node() {
  aseba::NodeDescription node;
  node.name = "thymio-II";
  node.bytecode_words = 1534;
  node.variable_words = 586;
  std::uint16_t address = 0;
  for (const auto& [name, words] : {std::pair{"_id", 1},
                                    {"motor.left.target", 1},
                                    {"motor.right.target", 1},
                                    {"motor.left.speed", 1},
                                    {"motor.right.speed", 1},
                                    {"timer.period", 2}}) {
    node.variables.push_back({name, address, static_cast<std::uint16_t>(words)});
    address = static_cast<std::uint16_t>(address + words);
  }
  node.local_events = {"timer0"};
  node.native_functions = {"leds.top"};
  return node;
}

TEST(Program, FitsANodeAsItDescribesItself) {
  auto program = make_program(thymio_node());
  ASSERT_TRUE(program.ok()) << program.error().message;
  EXPECT_EQ(program->mailbox, 7);
  EXPECT_EQ(program->motors.right_target, 2);
  EXPECT_TRUE(program->lights);
  EXPECT_FALSE(program->sounds);
  EXPECT_NE(program->signature, 0);
  EXPECT_EQ(make_program(thymio_node())->signature, program->signature);
  auto moved = thymio_node();
  moved.variables.push_back({"x", 7, 1});
  EXPECT_NE(make_program(moved)->signature, program->signature);
}

TEST(Program, SaysWhatANodeLacks) {
  auto node = thymio_node();
  node.variables[1].words = 2;
  EXPECT_THAT(make_program(node).error().message, HasSubstr("its variable 'motor.left.target' has 2 words, not 1"));
  node = thymio_node();
  node.local_events.clear();
  EXPECT_THAT(make_program(node).error().message, HasSubstr("its event 'timer0' is missing"));
  node = thymio_node();
  node.variable_words = 20;
  EXPECT_THAT(make_program(node).error().message,
              HasSubstr("room for 13 words of a program's variables; 30 are needed"));
  node = thymio_node();
  node.bytecode_words = 20;
  EXPECT_THAT(make_program(node).error().message, HasSubstr("room for 20 words of a program"));
}

}  // namespace
}  // namespace tandem::bridges::thymio
