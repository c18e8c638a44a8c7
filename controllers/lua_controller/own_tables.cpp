#include "controllers/lua_controller/own_tables.hpp"

#include "controllers/lua_controller/interpreter.hpp"

namespace tandem::controllers::lua {
namespace {

// A late copy's metatable, which all late copies of one original have, holds more than Lua looks for:
enum Slot : lua_Integer { kMark = 0, kOriginal = 1, kReadings = 2, kCopied = 3 };
char mark;  // at kMark; kCopied is the metatable of those that have become a copy, or false: none
constexpr const char* kReadingsMeta = "tandem.readings";

/// Pushes the metatable of the table at `index` where it is a late copy's; else nothing, and false.
bool push_late_meta(lua_State* L, int index) {
  if (!lua_istable(L, index) || lua_getmetatable(L, index) == 0) return false;
  lua_rawgeti(L, -1, kMark);
  const bool late = lua_touserdata(L, -1) == &mark;
  lua_pop(L, late ? 1 : 2);
  return late;
}

/// Copies the entries of the table at `from` into that at `to`, past metatables.
void copy_entries(lua_State* L, int from, int to) {
  from = lua_absindex(L, from);
  to = lua_absindex(L, to);
  lua_pushnil(L);
  while (lua_next(L, from) != 0) {
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    lua_rawset(L, to);
  }
}

/// The late copy at 1, whose metatable is on the top, becomes a copy in full.
void copy_in_full(lua_State* L) {
  const int meta = lua_gettop(L);
  if (lua_rawgeti(L, meta, kOriginal) != LUA_TTABLE) {  // it is one
    lua_settop(L, meta);
    return;
  }
  copy_entries(L, -1, 1);
  if (lua_rawgeti(L, meta, kCopied) != LUA_TTABLE) lua_pushnil(L);
  lua_setmetatable(L, 1);
  lua_settop(L, meta);
  Interpreter::of(L).became_own(L);
}

int late_length(lua_State* L) {
  if (!push_late_meta(L, 1)) return luaL_argerror(L, 1, "a table is expected");
  lua_rawgeti(L, -1, kReadings);
  lua_Integer count = 0;  // its length as Lua knows it depends on how long it has been, for others
  while (lua_rawgeti(L, -1, count + 1) != LUA_TNIL) {
    lua_pop(L, 1);
    ++count;
  }
  lua_pushinteger(L, count);
  return 1;
}

/// Pushes what the present robot has added to the table at `index`, or nil.
void push_added(lua_State* L, int index, bool make) {
  Interpreter::of(L).push_own(L);
  lua_getfield(L, -1, "added");
  lua_pushvalue(L, index);
  lua_rawget(L, -2);
  if (make && lua_isnil(L, -1)) {
    lua_pop(L, 1);
    lua_newtable(L);
    lua_pushvalue(L, index);
    lua_pushvalue(L, -2);
    lua_rawset(L, -4);
  }
}

int filled_anew(lua_State* L) {
  return luaL_error(
      L, "this table is filled anew for every step: what is to stay in it goes into a table of the script's own");
}

int added_newindex(lua_State* L) {  // (table, key, value)
  if (Interpreter::of(L).filling()) {
    lua_rawset(L, 1);
    return 0;
  }
  if (lua_type(L, 2) != LUA_TSTRING) return filled_anew(L);
  push_added(L, 1, true);
  lua_pushvalue(L, 2);
  lua_pushvalue(L, 3);
  lua_rawset(L, -3);
  return 0;
}

}  // namespace

void make_late(lua_State* L) {
  const int original = lua_gettop(L);
  const int readings = original - 1;
  const bool reads = lua_istable(L, readings);
  if (reads) {  // what the original lacks is looked for in the readings
    lua_newtable(L);
    lua_pushvalue(L, readings);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, original);
  }
  for (const bool late : {false, true}) {
    lua_createtable(L, 3, 4);  // original + 1: of copies in full, original + 2: of late ones
    lua_pushlightuserdata(L, &mark);
    lua_rawseti(L, -2, kMark);
    lua_pushvalue(L, late ? original : readings);
    lua_setfield(L, -2, "__index");
    lua_pushcfunction(L, &set_late);
    lua_setfield(L, -2, "__newindex");
    lua_pushboolean(L, 0);
    lua_setfield(L, -2, "__metatable");
    if (late)
      lua_pushvalue(L, original);
    else
      lua_pushboolean(L, 0);
    lua_rawseti(L, -2, kOriginal);
    if (!reads) continue;
    lua_pushcfunction(L, &late_length);
    lua_setfield(L, -2, "__len");
    lua_pushvalue(L, readings);
    lua_rawseti(L, -2, kReadings);
  }
  if (reads) {
    lua_pushvalue(L, original + 1);
    lua_rawseti(L, original + 2, kCopied);
  }
  lua_replace(L, readings);
  lua_settop(L, readings);
}

bool is_original(lua_State* L, int index) {
  if (!lua_istable(L, index)) return false;
  const bool is = lua_rawgeti(L, index, kMark) == LUA_TLIGHTUSERDATA && lua_touserdata(L, -1) == &mark;
  lua_pop(L, 1);
  return is;
}

void push_late_copy(lua_State* L, int index) {
  index = lua_absindex(L, index);
  lua_createtable(L, 0, 0);
  lua_pushvalue(L, index);
  lua_setmetatable(L, -2);
}

bool is_late(lua_State* L, int index) {
  const bool late = push_late_meta(L, index);
  if (late) lua_pop(L, 1);
  return late;
}

void push_whole(lua_State* L, int index) {
  index = lua_absindex(L, index);
  if (!push_late_meta(L, index)) return lua_pushvalue(L, index);
  const int meta = lua_gettop(L);
  lua_newtable(L);
  for (const Slot part : {kReadings, kOriginal}) {
    if (lua_rawgeti(L, meta, part) == LUA_TTABLE) copy_entries(L, -1, meta + 1);
    lua_settop(L, meta + 1);
  }
  copy_entries(L, index, -1);
  lua_remove(L, meta);
}

int get_late(lua_State* L) {
  lua_pushvalue(L, 2);
  if (lua_rawget(L, 1) != LUA_TNIL || !push_late_meta(L, 1)) return 1;
  for (const Slot part : {kOriginal, kReadings}) {
    if (lua_rawgeti(L, 4, part) == LUA_TTABLE) {
      lua_pushvalue(L, 2);
      if (lua_rawget(L, 5) != LUA_TNIL) return 1;
    }
    lua_settop(L, 4);
  }
  lua_pushnil(L);
  return 1;
}

int set_late(lua_State* L) {
  if (!push_late_meta(L, 1)) return luaL_argerror(L, 1, "a table is expected");
  if (lua_rawgeti(L, 4, kReadings) == LUA_TTABLE) {
    lua_pushvalue(L, 2);
    const bool reading = lua_rawget(L, 5) != LUA_TNIL;
    lua_settop(L, 5);
    if (reading) {  // until it is filled anew, before the next robot's turn
      lua_pushvalue(L, 2);
      lua_pushvalue(L, 3);
      lua_rawset(L, 5);
      return 0;
    }
    if (lua_type(L, 2) != LUA_TSTRING) return filled_anew(L);
  }
  lua_settop(L, 4);
  copy_in_full(L);
  lua_pushvalue(L, 2);
  lua_pushvalue(L, 3);
  lua_rawset(L, 1);
  return 0;
}

void open_readings(lua_State* L) {
  lua_newtable(L);
  lua_pushcfunction(L, &added_index);
  lua_setfield(L, -2, "__index");
  lua_pushcfunction(L, &added_newindex);
  lua_setfield(L, -2, "__newindex");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_setfield(L, LUA_REGISTRYINDEX, kReadingsMeta);
}

void make_readings(lua_State* L) {
  luaL_setmetatable(L, kReadingsMeta);
}

int added_index(lua_State* L) {  // (table, key)
  push_added(L, 1, false);
  if (!lua_istable(L, -1)) return 0;
  lua_pushvalue(L, 2);
  lua_rawget(L, -2);
  return 1;
}

}  // namespace tandem::controllers::lua
