// The order of tables: that of their keys, the same in every run, in `pairs`, `next` and `table.sort`.
#include <algorithm>
#include <cstring>
#include <limits>

#include "controllers/lua_controller/devices.hpp"
#include "controllers/lua_controller/memory.hpp"
#include "controllers/lua_controller/own_tables.hpp"

namespace tandem::controllers::lua {
namespace {

/// A key, as far as it has an order that is the same in every run: numbers, then texts, then truth values, then tables
/// in the order in which they were made.
struct Key {
  static constexpr int kTable = 3, kObject = 4;  // as ranks
  int rank = 0;
  bool whole = false;
  lua_Integer integer = 0;
  double number = 0.0;
  const char* text = nullptr;
  std::size_t size = 0;

  bool operator<(const Key& other) const noexcept {
    if (rank != other.rank) return rank < other.rank;
    if (rank == 0) {
      if (whole && other.whole) return integer < other.integer;
      return number < other.number;
    }
    if (rank == 1) {
      const int order = std::memcmp(text, other.text, std::min(size, other.size));
      return order != 0 ? order < 0 : size < other.size;
    }
    return integer < other.integer;
  }
};

/// Raises an error for keys without an order.
Key key_at(lua_State* L, int index) {
  Key key;
  switch (lua_type(L, index)) {
    case LUA_TNUMBER:
      key.whole = lua_isinteger(L, index) != 0;
      if (key.whole) key.integer = lua_tointeger(L, index);
      key.number = lua_tonumber(L, index);
      break;
    case LUA_TSTRING:
      key.rank = 1;
      key.text = lua_tolstring(L, index, &key.size);
      break;
    case LUA_TBOOLEAN:
      key.rank = 2;
      key.integer = lua_toboolean(L, index);
      break;
    case LUA_TTABLE:
      key.integer = static_cast<lua_Integer>(Memory::number_of(lua_topointer(L, index)));
      key.rank = key.integer != 0 ? Key::kTable : Key::kObject;
      break;
    default:
      key.rank = Key::kObject;
  }
  return key;
}

int no_order(lua_State* L) {
  return luaL_error(L,
                    "the table has several keys that are functions or coroutines, which have no order that is the same "
                    "in every run; use numbers, texts or tables as keys");
}

/// Pushes a list of all keys in order. Its memory is Lua's: an error may leave at any time.
void push_keys(lua_State* L, int table) {
  lua_Integer count = 0;
  lua_pushnil(L);
  while (lua_next(L, table) != 0) {
    ++count;
    lua_pop(L, 1);
  }
  Interpreter::of(L).spend(L, count);
  auto* const keys = static_cast<Key*>(lua_newuserdatauv(L, sizeof(Key) * static_cast<std::size_t>(count) + 1, 0));
  const int memory = lua_gettop(L);
  lua_createtable(L, static_cast<int>(count), 0);
  lua_pushnil(L);  // or a table: keys that are objects, by the `size` of their Key
  Key* end = keys;
  lua_Integer objects = 0;
  int without_order = 0;
  lua_pushnil(L);
  while (lua_next(L, table) != 0) {
    lua_pop(L, 1);
    *end = key_at(L, -1);
    if (end->rank == Key::kObject && ++without_order > 1) no_order(L);
    if (end->rank >= Key::kTable) {
      if (objects == 0) {
        lua_newtable(L);
        lua_replace(L, memory + 2);
      }
      lua_pushvalue(L, -1);
      lua_rawseti(L, memory + 2, ++objects);
      end->size = static_cast<std::size_t>(objects);
    }
    ++end;
  }
  std::sort(keys, end);
  lua_Integer n = 0;
  for (const Key* key = keys; key != end; ++key) {
    if (key->rank == 0 && key->whole) lua_pushinteger(L, key->integer);
    if (key->rank == 0 && !key->whole) lua_pushnumber(L, key->number);
    if (key->rank == 1) lua_pushlstring(L, key->text, key->size);
    if (key->rank == 2) lua_pushboolean(L, static_cast<int>(key->integer));
    if (key->rank >= Key::kTable) lua_rawgeti(L, memory + 2, static_cast<lua_Integer>(key->size));
    lua_rawseti(L, memory + 1, ++n);
  }
  lua_settop(L, memory + 1);
  lua_remove(L, memory);
}

/// The next of the keys that were there at the beginning and still are.
int next_of_pairs(lua_State* L) {  // (table, key before): upvalues keys, number
  lua_Integer i = lua_tointeger(L, lua_upvalueindex(2));
  for (;;) {
    if (lua_rawgeti(L, lua_upvalueindex(1), ++i) == LUA_TNIL) return 1;
    lua_pushvalue(L, -1);
    if (lua_rawget(L, 1) != LUA_TNIL) break;
    lua_pop(L, 2);
  }
  lua_pushinteger(L, i);
  lua_replace(L, lua_upvalueindex(2));
  return 2;
}

/// A late copy at 1 is replaced by a table of all that it shows.
void show_whole(lua_State* L) {
  if (!is_late(L, 1)) return;
  push_whole(L, 1);
  lua_replace(L, 1);
}

int pairs(lua_State* L) {
  luaL_checkany(L, 1);
  if (luaL_getmetafield(L, 1, "__pairs") != LUA_TNIL) {
    lua_pushvalue(L, 1);
    lua_call(L, 1, 3);
    return 3;
  }
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_settop(L, 1);
  show_whole(L);
  push_keys(L, 1);
  lua_pushinteger(L, 0);
  lua_pushcclosure(L, &next_of_pairs, 2);
  lua_pushvalue(L, 1);
  lua_pushnil(L);
  return 3;
}

int next(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  lua_settop(L, 2);
  show_whole(L);
  const bool first = lua_isnil(L, 2);
  const Key before = first ? Key{} : key_at(L, 2);
  if (before.rank == Key::kObject) return 0;  // the last
  bool found = false;
  Key least;
  int objects = 0;
  lua_pushnil(L);  // 3: the least so far
  lua_pushnil(L);
  std::int64_t looked_at = 0;
  while (lua_next(L, 1) != 0) {
    lua_pop(L, 1);
    ++looked_at;
    const Key key = key_at(L, -1);
    if (key.rank == Key::kObject && ++objects > 1) no_order(L);
    if ((first || before < key) && (!found || key < least)) {
      found = true;
      least = key;
      lua_pushvalue(L, -1);
      lua_replace(L, 3);
    }
  }
  Interpreter::of(L).spend(L, looked_at);
  lua_settop(L, 3);
  if (!found) return 1;
  lua_pushvalue(L, 3);
  lua_rawget(L, 1);
  return 2;
}

bool is_less(lua_State* L, int a, int b) {
  if (lua_isnil(L, 2)) return lua_compare(L, a, b, LUA_OPLT) != 0;
  lua_pushvalue(L, 2);
  lua_pushvalue(L, a);
  lua_pushvalue(L, b);
  lua_call(L, 2, 1);
  const bool less = lua_toboolean(L, -1) != 0;
  lua_pop(L, 1);
  return less;
}

/// By merging: what is equal stays in its order.
int sort(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  if (!lua_isnoneornil(L, 2)) luaL_checktype(L, 2, LUA_TFUNCTION);
  lua_settop(L, 2);
  const lua_Integer n = luaL_len(L, 1);
  luaL_argcheck(L, n < std::numeric_limits<int>::max(), 1, "array too big");
  for (lua_Integer width = 1; width < n; width *= 2) Interpreter::of(L).spend(L, n);
  lua_createtable(L, static_cast<int>(std::max<lua_Integer>(n, 0)), 0);  // 3
  lua_createtable(L, static_cast<int>(std::max<lua_Integer>(n, 0)), 0);  // 4
  for (lua_Integer i = 1; i <= n; ++i) {
    lua_geti(L, 1, i);
    lua_rawseti(L, 3, i);
  }
  for (lua_Integer width = 1; width < n; width *= 2) {
    for (lua_Integer begin = 1; begin <= n; begin += 2 * width) {
      const lua_Integer middle = std::min(begin + width, n + 1);
      const lua_Integer end = std::min(begin + 2 * width, n + 1);
      lua_Integer left = begin;
      lua_Integer right = middle;
      for (lua_Integer to = begin; to < end; ++to) {
        bool take_right = left == middle;
        if (left < middle && right < end) {
          lua_rawgeti(L, 3, right);
          lua_rawgeti(L, 3, left);
          take_right = is_less(L, lua_gettop(L) - 1, lua_gettop(L));
          lua_pop(L, 2);
        }
        lua_rawgeti(L, 3, take_right ? right++ : left++);
        lua_rawseti(L, 4, to);
      }
    }
    lua_pushvalue(L, 3);  // the two change their parts
    lua_pushvalue(L, 4);
    lua_replace(L, 3);
    lua_replace(L, 4);
  }
  for (lua_Integer i = 1; i <= n; ++i) {
    lua_rawgeti(L, 3, i);
    lua_seti(L, 1, i);
  }
  return 0;
}

constexpr luaL_Reg kOrder[] = {{"pairs", &pairs}, {"next", &next}, {nullptr, nullptr}};

}  // namespace

void open_order(lua_State* L) {
  luaL_setfuncs(L, kOrder, 0);
}

void open_sort(lua_State* L) {
  lua_pushcfunction(L, &sort);
  lua_setfield(L, -2, "sort");
}

}  // namespace tandem::controllers::lua
