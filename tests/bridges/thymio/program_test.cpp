#include "bridges/thymio/program.hpp"

#include <gmock/gmock.h>

namespace tandem::bridges::thymio {
namespace {

using testing::HasSubstr;

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
