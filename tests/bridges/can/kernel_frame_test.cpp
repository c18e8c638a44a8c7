#include "bridges/can/kernel_frame.hpp"

#include <cstring>
#include <gtest/gtest.h>
#include <linux/can/error.h>

#include "tests/bridges/can/frames.hpp"

namespace tandem::bridges {
namespace {

std::array<std::uint8_t, 16> bytes_of(const can_frame& raw) {
  std::array<std::uint8_t, 16> bytes{};
  static_assert(sizeof raw == sizeof bytes);
  std::memcpy(bytes.data(), &raw, sizeof raw);
  return bytes;
}

can_frame error_frame(std::uint32_t classes, std::uint8_t controller = 0) {
  can_frame raw{};
  raw.can_id = CAN_ERR_FLAG | classes;
  raw.can_dlc = CAN_ERR_DLC;
  raw.data[1] = controller;
  return raw;
}

TEST(KernelFrame, HasTheKernelsLayout) {
  const std::array<std::uint8_t, 4> data = {0x11, 0xA0, 0x05, 0x00};
  const std::array<std::uint8_t, 16> expected = {0x00, 0x03, 0, 0, 4, 0, 0, 0, 0x11, 0xA0, 0x05, 0, 0, 0, 0, 0};
  EXPECT_EQ(bytes_of(to_kernel(make_frame(0x300, data))), expected);
}

TEST(KernelFrame, KeepsExtendedAndRemoteFramesApart) {
  CanFrame frame = make_frame(0x12ABCDEF, std::array<std::uint8_t, 2>{0xAA, 0x55});
  frame.extended = true;
  EXPECT_EQ(to_kernel(frame).can_id, 0x92ABCDEFU);
  EXPECT_TRUE(same_on_wire(*from_kernel(to_kernel(frame)), frame));

  CanFrame remote;
  remote.id = 0x123;
  remote.remote = true;
  remote.size = 4;
  EXPECT_EQ(to_kernel(remote).can_id, 0x40000123U);
  EXPECT_TRUE(same_on_wire(*from_kernel(to_kernel(remote)), remote));
}

TEST(KernelFrame, RefusesErrorFramesAndImpossibleLengths) {
  EXPECT_FALSE(from_kernel(error_frame(CAN_ERR_BUSOFF)));
  can_frame raw{};
  raw.can_dlc = 9;
  EXPECT_FALSE(from_kernel(raw));
}

TEST(ErrorFrames, TellTheControllersState) {
  BusRecord record;
  note_error_frame(error_frame(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING), record);
  EXPECT_EQ(record.state(), BusState::Warning);
  note_error_frame(error_frame(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE), record);
  EXPECT_EQ(record.state(), BusState::Passive);
  EXPECT_TRUE(can_pass(record.state()));
  note_error_frame(error_frame(CAN_ERR_BUSOFF), record);
  EXPECT_EQ(record.state(), BusState::BusOff);
  EXPECT_FALSE(can_pass(record.state()));
  note_error_frame(error_frame(CAN_ERR_RESTARTED), record);
  EXPECT_EQ(record.state(), BusState::Active);
  EXPECT_EQ(record.counts.bus_offs, 1U);
  EXPECT_EQ(record.counts.restarts, 1U);
  EXPECT_EQ(record.counts.error_reports, 4U);
}

TEST(ErrorFrames, CountWhatTheyTell) {
  BusRecord record;
  note_error_frame(error_frame(CAN_ERR_ACK), record);
  note_error_frame(error_frame(CAN_ERR_TX_TIMEOUT | CAN_ERR_ACK), record);
  note_error_frame(error_frame(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW), record);
  EXPECT_EQ(record.counts.no_acknowledge, 2U);
  EXPECT_EQ(record.counts.send_timeouts, 1U);
  EXPECT_EQ(record.counts.overrun, 1U);
  EXPECT_EQ(record.state(), BusState::Active);
}

TEST(BusRecord, NeverLeavesGone) {
  BusRecord record;
  record.become(BusState::Gone);
  record.become(BusState::Active);
  EXPECT_EQ(record.state(), BusState::Gone);
  EXPECT_EQ(record.counts.downs, 1U);
  EXPECT_EQ(record.counts.restarts, 0U);
}

}  // namespace
}  // namespace tandem::bridges
