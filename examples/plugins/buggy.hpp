// A toy robot on two wheels, as its controller, its bridge and its emulator know it.
//
// It talks over a serial line, in lines of text:
//   V <left> <right>                   from the host: speeds of the wheels in mm/s. Without one for 500 ms it stops.
//   E <left> <right> <speed> <speed>   its answer: mm that each wheel has rolled, and mm/s that it turns with
#pragma once
#include "hal/catalog.hpp"
#include "hal/robot_kind.hpp"

namespace buggy {

inline constexpr std::string_view kName = "buggy";
inline constexpr unsigned kBaud = 9600;

const tandem::hal::RobotKind& kind();
void register_bridge(tandem::hal::Registrar& registrar);  // and how the guardian stops it
void register_emulator(tandem::hal::Registrar& registrar);

}  // namespace buggy
