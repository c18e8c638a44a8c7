#include "bridges/aseba/bytecode_writer.hpp"

#include <gmock/gmock.h>

namespace tandem::bridges::aseba {
namespace {

// The program of tests/bridges/aseba_emulation/machine_test.cpp: ASEBA's own compiler makes these words of it.
TEST(BytecodeWriter, MakesTheWordsOfAsebasCompiler) {
  BytecodeWriter code;
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

TEST(BytecodeWriter, PushesNumbersOfAnySize) {
  BytecodeWriter code;
  code.begin(kInitEvent);
  code.push(-1).push(2047).push(-2048).push(2048).push(-30000);
  EXPECT_THAT(code.finish(),
              testing::ElementsAre(3, 0xffff, 3, 0x1fff, 0x17ff, 0x1800, 0x2000, 2048, 0x2000, 0x8ad0, 0));
}

}  // namespace
}  // namespace tandem::bridges::aseba
