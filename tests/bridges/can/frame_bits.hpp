// Length of a frame on the bus, in bits and in time.
#pragma once
#include <cstddef>

#include "bridges/can/frame.hpp"

namespace tandem::bridges {

/// Bits of the frame on the wire, from its start to the end of the pause behind it: with the stuff bits that its own
/// content calls for and its checksum, without anybody's errors. At most 135 for a standard frame, 160 for an extended
/// one.
/// Source: ISO 11898-1; K. Tindell, A. Burns, A. Wellings, "Calculating Controller Area Network (CAN) message response
/// times", 1995.
std::size_t frame_bits(const CanFrame& frame) noexcept;

}  // namespace tandem::bridges
