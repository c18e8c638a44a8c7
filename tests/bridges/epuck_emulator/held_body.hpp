// A body that senses what a test says, and keeps what it is told.
#pragma once
#include "bridges/epuck_emulator/body.hpp"
#include "tests/bridges/held_body.hpp"

namespace tandem::bridges::epuck_emulator {

using HeldBody = HeldBodyOf<EmulatedBody, BodySenses, BodyCommand>;

}  // namespace tandem::bridges::epuck_emulator
