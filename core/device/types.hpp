// The lists of implementations, one a file of this folder; `register_devices` adds them all.
#pragma once
#include "core/device/describe.hpp"
#include "core/device/proximity.hpp"

namespace tandem::core {

std::vector<DeviceType> wheel_types();
std::vector<DeviceType> ring_level_types();
std::vector<DeviceType> accelerometer_types();
std::vector<DeviceType> body_device_types();
std::vector<DeviceType> range_and_bearing_types();
std::vector<DeviceType> flight_types();
std::vector<DeviceType> flight_sensor_types();
std::vector<DeviceType> pan_tilt_types();
std::vector<DeviceType> turret_types();
std::vector<DeviceType> gripper_types();
std::vector<DeviceType> scanner_types();
std::vector<DeviceType> camera_types();
std::vector<DeviceType> lamp_types();
std::vector<DeviceType> time_of_flight_types();
std::vector<DeviceType> selector_types();
std::vector<DeviceType> button_types();

}  // namespace tandem::core
