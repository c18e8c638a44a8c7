#include "bridges/can/kernel_frame.hpp"

#include <linux/can/error.h>

namespace tandem::bridges {
namespace {

/// The controller's own report, the second data byte of an error frame of its class.
void note_controller(std::uint8_t report, BusRecord& record) noexcept {
  if ((report & CAN_ERR_CRTL_RX_OVERFLOW) != 0) ++record.counts.overrun;
  if ((report & (CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) != 0) {
    record.become(BusState::Passive);
  } else if ((report & (CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) != 0) {
    record.become(BusState::Warning);
  } else if ((report & CAN_ERR_CRTL_ACTIVE) != 0) {
    record.become(BusState::Active);
  }
}

}  // namespace

can_frame to_kernel(const CanFrame& frame) noexcept {
  can_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.can_dlc = frame.size;
  std::ranges::copy(frame.bytes(), raw.data);
  return raw;
}

std::optional<CanFrame> from_kernel(const can_frame& raw) noexcept {
  if (is_error_frame(raw) || raw.can_dlc > CAN_MAX_DLEN) return std::nullopt;
  CanFrame frame;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.size = raw.can_dlc;
  if (!frame.remote) std::copy_n(raw.data, frame.size, frame.data.begin());
  return frame;
}

bool is_error_frame(const can_frame& raw) noexcept {
  return (raw.can_id & CAN_ERR_FLAG) != 0;
}

void note_error_frame(const can_frame& raw, BusRecord& record) noexcept {
  ++record.counts.error_reports;
  if ((raw.can_id & CAN_ERR_ACK) != 0) ++record.counts.no_acknowledge;
  if ((raw.can_id & CAN_ERR_TX_TIMEOUT) != 0) ++record.counts.send_timeouts;
  if ((raw.can_id & CAN_ERR_RESTARTED) != 0) record.become(BusState::Active);
  if ((raw.can_id & CAN_ERR_CRTL) != 0) note_controller(raw.data[1], record);
  if ((raw.can_id & CAN_ERR_BUSOFF) != 0) record.become(BusState::BusOff);
}

std::uint32_t error_mask() noexcept {
  return CAN_ERR_TX_TIMEOUT | CAN_ERR_LOSTARB | CAN_ERR_CRTL | CAN_ERR_PROT | CAN_ERR_TRX | CAN_ERR_ACK |
         CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;
}

}  // namespace tandem::bridges
