// The modules on the kernel's own CAN. Runs in a guest that has vcan0.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <thread>

#include "bridges/footbot_emulator/emulator.hpp"
#include "tests/bridges/can/guest_process.hpp"

namespace tandem::bridges::footbot_emulator {
namespace {

using testing::HasSubstr;

TEST(OnTheKernelsCan, ModulesAnswerForeignTools) {
  std::atomic<bool> stop{false};
  std::atomic<bool> ready{false};
  Options options;
  options.link = "can:vcan0";
  options.firmware = "v5";
  options.ready = [&](const std::string& path) {
    EXPECT_EQ(path, "can:vcan0");
    ready = true;
  };
  hal::Status status;
  std::thread emulator([&] { status = run(options, stop); });
  while (!ready) std::this_thread::yield();

  Background ear("candump -L vcan0");
  // candump says nothing before the first frame.
  for (int i = 0; i < 100 && !ear.says("301#0C900500", 1); ++i) shell("cansend vcan0 300#11A00500");
  for (int id = 1; id <= 9; ++id) EXPECT_TRUE(ear.says("30" + std::to_string(id) + "#0C900500"));
  EXPECT_EQ(shell("cansend vcan0 100#0CA007002200FF00 && cansend vcan0 200#0100"), "");
  EXPECT_EQ(shell("cansend vcan0 300#0BA0070022000300"), "");
  EXPECT_TRUE(ear.says("107#05902200FF000100")) << ear.output();
  EXPECT_TRUE(ear.says("207#0000")) << ear.output();
  // Extended and remote frames are not for them.
  EXPECT_EQ(shell("cansend vcan0 00000300#0CA0070022000900 && cansend vcan0 300#R"), "");
  EXPECT_EQ(shell("cansend vcan0 300#0BA0070022000100"), "");
  EXPECT_TRUE(ear.says("307#05902200FF00")) << ear.output();

  stop = true;
  emulator.join();
  EXPECT_TRUE(status.ok());
}

TEST(OnTheKernelsCan, AMissingInterfaceIsNamed) {
  const std::atomic<bool> stop{true};
  Options options;
  options.link = "can:vcan9";
  const hal::Status status = run(options, stop);
  ASSERT_FALSE(status.ok());
  EXPECT_THAT(status.error().message, HasSubstr("vcan9: there is no such interface"));
}

}  // namespace
}  // namespace tandem::bridges::footbot_emulator
