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
  names.engines = {{"kinematics2d", "", {}},
                   {"dynamics2d", "", {.forces = true, .joints = core::kEveryJoint}},
                   {"dynamics3d", "", {.plane = false, .forces = true, .joints = core::kEveryJoint}},
                   {"particle3d", "pointmass3d", {.plane = false, .air = true}}};
  for (const hal::PortType* port : all_port_types()) {
    auto& devices = port->role == hal::Role::Sensor ? names.sensors : names.actuators;
    devices.emplace_back(port->name);
  }
  return names;
}

}  // namespace tandem::app
