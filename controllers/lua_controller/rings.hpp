// Rings of sensors as ARGoS' scripts know them.
#pragma once
#include <cstddef>

#include "controllers/lua_controller/interpreter.hpp"

namespace tandem::controllers::lua {

// Prepare the table of readings, on the top of the stack, and fill it: see DeviceApi.
void open_proximity(lua_State* state, Interpreter& in, std::size_t device);
void open_light(lua_State* state, Interpreter& in, std::size_t device);
void fill_proximity(lua_State* state, Interpreter& in, std::size_t device, const void* port);
void fill_light(lua_State* state, Interpreter& in, std::size_t device, const void* port);

}  // namespace tandem::controllers::lua
