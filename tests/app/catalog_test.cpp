// What the program contains fits together.
#include "app/catalog.hpp"

#include <gmock/gmock.h>

#include "core/device/device.hpp"
#include "core/physics/solver.hpp"
#include "hal/port.hpp"

namespace tandem::app {
namespace {

TEST(TheCatalog, HasPortsRobotsDevicesAndEngines) {
  EXPECT_GT(catalog().all<hal::PortType>().size(), 30U);
  EXPECT_THAT(catalog().names("robot"),
              testing::UnorderedElementsAre("e-puck", "e-puck2", "eye-bot", "foot-bot", "thymio"));
  EXPECT_THAT(catalog().names("engine"), testing::Contains("kinematics2d"));
  EXPECT_EQ(catalog().find<hal::PortType>("sensor proximity"), catalog().all<hal::PortType>().at(2));
  for (const hal::Catalog::Entry& e : catalog().entries()) EXPECT_EQ(e.origin, hal::Catalog::kInside);
}

TEST(TheCatalog, EveryDeviceIsAPortAndEveryPortIsSimulated) {
  for (const core::DeviceType* type : catalog().all<core::DeviceType>()) {
    const auto* port = catalog().find<hal::PortType>(hal::port_entry(type->device, type->role));
    ASSERT_NE(port, nullptr) << type->catalog_name();
    EXPECT_EQ(port->role, type->role);
  }
  for (const hal::PortType* port : catalog().all<hal::PortType>())
    EXPECT_NE(core::find_device(catalog(), port->name, port->role, "default"), nullptr) << port->name;
}

TEST(TheCatalog, WhatDoesNotMoveARobotIsNotHeldBack) {
  for (const hal::PortType* port : catalog().all<hal::PortType>()) {
    const bool moves = port->slow_down != nullptr;
    EXPECT_EQ(moves, port->keep_inside != nullptr) << port->name;
    EXPECT_EQ(moves, port->keep_out != nullptr) << port->name;
    EXPECT_FALSE(port->role == hal::Role::Sensor && port->limit != nullptr) << port->name;
    EXPECT_FALSE(moves && port->limit == nullptr) << port->name;
  }
}

}  // namespace
}  // namespace tandem::app
