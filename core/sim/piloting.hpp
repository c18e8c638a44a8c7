// From what a controller asks of a flying robot to what its engine is told.
#pragma once
#include "core/device/device.hpp"

namespace tandem::core {

/// Goes through a block of flying robots once all their actuators have acted: which of their commands counts, and how
/// far tasks (taking off, landing, holding on to the ceiling) have come. Writes only the block's rows.
///
/// A robot whose controller takes FlightTask starts landed where it stands on something, else in the air; others obey
/// their commands from the start. One that is halted hovers, or stays where it stands or hangs.
void pilot(const DeviceContext& context, SpaceStores& stores) noexcept;

}  // namespace tandem::core
