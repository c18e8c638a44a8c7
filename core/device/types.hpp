// The lists of implementations, one a file of this folder; device.cpp joins them.
#pragma once
#include "core/device/describe.hpp"
#include "core/device/proximity.hpp"

namespace tandem::core {

std::vector<DeviceType> wheel_types();
std::vector<DeviceType> ring_level_types();
std::vector<DeviceType> body_device_types();
std::vector<DeviceType> range_and_bearing_types();
std::vector<DeviceType> flight_types();

}  // namespace tandem::core
