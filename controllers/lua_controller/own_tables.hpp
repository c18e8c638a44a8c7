// Tables that every robot has to itself, although their contents are there once.
//
// A late copy is an empty table of the robot's own that shows what its original holds; the first thing that the script
// writes into it makes it a copy in full. No script gets hold of an original. Readings are in tables that are filled
// anew before each robot's turn; a late copy can show these as well, and a ring of sensors is such a table itself: what
// a script writes over a reading lasts until the end of its turn, and names that it adds are kept for that robot.
#pragma once
#include "controllers/lua_controller/lua.hpp"

namespace tandem::controllers::lua {

/// Replaces the original, on the top, by what late copies of it are made from; below it are readings, or nil, which go.
/// Neither is reached by any other way from then on.
void make_late(lua_State* state);

/// Whether what late copies are made from is at `index`.
bool is_original(lua_State* state, int index);
/// Pushes a new late copy of what is at `index`.
void push_late_copy(lua_State* state, int index);

/// Whether the value at `index` shows what others hold too.
bool is_late(lua_State* state, int index);
/// Pushes a plain table of all that the table at `index` shows.
void push_whole(lua_State* state, int index);
/// Pushes what the table at 1, a late copy, shows for the key at 2.
int get_late(lua_State* state);
/// `table[key] = value` of a late copy, which are at 1, 2, 3.
int set_late(lua_State* state);

/// Makes the table on the top one of readings.
void open_readings(lua_State* state);  // once, before all others
void make_readings(lua_State* state);
/// `__index` of such a table: what the robot added.
int added_index(lua_State* state);

}  // namespace tandem::controllers::lua
