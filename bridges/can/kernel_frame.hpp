// Frames as Linux passes them through a raw CAN socket: struct can_frame, and what error frames say.
//
// Sources: Linux kernel, Documentation/networking/can.rst, include/uapi/linux/can.h, include/uapi/linux/can/error.h.
#pragma once
#include <cstdint>
#include <linux/can.h>
#include <optional>

#include "bridges/can/can_link.hpp"

namespace tandem::bridges {

/// `frame` must be valid.
can_frame to_kernel(const CanFrame& frame) noexcept;

/// Empty for error frames and for lengths beyond 8.
std::optional<CanFrame> from_kernel(const can_frame& raw) noexcept;

bool is_error_frame(const can_frame& raw) noexcept;
/// Counts an error frame and takes over what it says about the controller's state.
void note_error_frame(const can_frame& raw, BusRecord& record) noexcept;
/// Error classes worth hearing of: all but single bus errors, which may flood.
std::uint32_t error_mask() noexcept;

}  // namespace tandem::bridges
