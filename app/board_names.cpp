#include "app/board_names.hpp"

#include "app/port_types.hpp"
#include "hal/spec/epuck.hpp"
#include "hal/spec/eyebot.hpp"
#include "hal/spec/footbot.hpp"

namespace tandem::app {

core::KnownNames board_names() {
  core::KnownNames names;
  for (const hal::DataSheet* sheet : {&hal::epuck::kDataSheet, &hal::footbot::kDataSheet, &hal::eyebot::kDataSheet})
    names.robots.emplace_back(sheet->kind);
  names.engines = {"kinematics2d", "dynamics2d", "dynamics3d", "particle3d"};
  for (const hal::PortType* port : all_port_types()) {
    auto& devices = port->role == hal::Role::Sensor ? names.sensors : names.actuators;
    devices.emplace_back(port->name);
  }
  return names;
}

}  // namespace tandem::app
