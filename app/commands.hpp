// Commands of this program. There are two such pages, commands.cpp for the whole program and board_commands.cpp for the
// one on a robot's board; a build has one of them.
#pragma once
#include "app/command/command_line.hpp"

namespace tandem::app {

const Program& program();

}  // namespace tandem::app
