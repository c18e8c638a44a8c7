// Walks over everything that a robot's functions can reach: to keep it, to put it back, to measure it.
#pragma once
#include <cstdint>
#include <initializer_list>

#include "controllers/lua_controller/lua.hpp"

namespace tandem::controllers::lua {

/// @returns a reference to the set of all tables and functions that can be reached from what these refer to
int push_shared(lua_State* state, std::initializer_list<int> roots);
/// Pushes a record of the contents of all that can be reached, but not of what `shared` has. Raises an error: something
/// cannot be kept.
void push_record(lua_State* state, std::initializer_list<int> roots, int shared);
/// Puts the record on the top back.
void put_back_record(lua_State* state);
/// Bytes of all that can be reached, by what it holds: the same wherever it was made.
std::uint64_t measure_reached(lua_State* state, std::initializer_list<int> roots, int shared);

}  // namespace tandem::controllers::lua
