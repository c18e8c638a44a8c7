// Lua's patterns for string.find, match, gmatch and gsub, counted step by step (limits.hpp): a pattern that would try
// for hours ends the robot as a loop does, at the same tick everywhere.
#pragma once
#include "controllers/lua_controller/interpreter.hpp"

namespace tandem::controllers::lua {

/// Puts the four functions into the table at the top of the stack.
void open_patterns(lua_State* state);

}  // namespace tandem::controllers::lua
