// The libraries that scripts have. What would differ between runs or machines is replaced or left out: the order of
// pairs, elementary functions, random numbers, addresses in texts; clocks and files are in outside.cpp. What can take
// long counts its steps.
#include <cstdio>
#include <cstring>
#include <limits>
#include <string>

#include "controllers/lua_controller/devices.hpp"
#include "controllers/lua_controller/own_tables.hpp"
#include "controllers/lua_controller/patterns.hpp"

namespace tandem::controllers::lua {
namespace {

// --- texts ---

int tostring(lua_State* L) {
  luaL_checkany(L, 1);
  push_text(L, 1);
  return 1;
}

int format(lua_State* L) {  // upvalue: the library's own
  const int count = lua_gettop(L);
  const char* const pattern = luaL_checkstring(L, 1);
  for (const char* at = std::strchr(pattern, '%'); at != nullptr; at = std::strchr(at, '%')) {
    for (++at; *at != '\0' && std::strchr("-+ #0123456789.", *at) != nullptr; ++at) continue;
    if (*at == 'p') return luaL_error(L, "string.format: %%p tells an address, which differs from run to run");
    if (*at != '\0') ++at;
  }
  for (int i = 2; i <= count; ++i) {
    const int type = lua_type(L, i);
    if (type != LUA_TTABLE && type != LUA_TFUNCTION && type != LUA_TTHREAD && type != LUA_TUSERDATA) continue;
    push_text(L, i);
    lua_replace(L, i);
  }
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, count, 1);
  return 1;
}

int say(lua_State* L, hal::Severity severity, const char* between) {
  const int count = lua_gettop(L);
  luaL_Buffer text;
  luaL_buffinit(L, &text);
  for (int i = 1; i <= count; ++i) {
    if (i > 1) luaL_addstring(&text, between);
    push_text(L, i);
    luaL_addvalue(&text);
  }
  luaL_pushresult(&text);
  std::size_t size = 0;
  const char* const all = lua_tolstring(L, -1, &size);
  hal::RobotLog& log = Interpreter::of(L).actor().log;
  severity == hal::Severity::Error ? log.error({all, size}) : log.info({all, size});
  return 0;
}

int log_info(lua_State* L) {
  return say(L, hal::Severity::Info, "");
}
int log_error(lua_State* L) {
  return say(L, hal::Severity::Error, "");
}
int print(lua_State* L) {
  return say(L, hal::Severity::Info, "\t");
}

// --- what would make runs differ ---

/// Notes the table at 1, whose __gc is called at the end of its robot: by number, and by itself so that it is there
/// once.
void note_finalized(lua_State* L) {
  Interpreter::of(L).push_own(L);
  if (lua_getfield(L, -1, "finalized") != LUA_TTABLE) {
    lua_pop(L, 1);
    lua_newtable(L);
    lua_pushvalue(L, -1);
    lua_setfield(L, -3, "finalized");
  }
  lua_pushvalue(L, 1);
  if (lua_rawget(L, -2) != LUA_TNIL) return;
  lua_pop(L, 1);
  const auto number = static_cast<lua_Integer>(lua_rawlen(L, -1)) + 1;
  lua_pushvalue(L, 1);
  lua_rawseti(L, -2, number);
  lua_pushvalue(L, 1);
  lua_pushboolean(L, 1);
  lua_rawset(L, -3);
}

int set_metatable(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  luaL_argexpected(L, lua_isnoneornil(L, 2) || lua_istable(L, 2), 2, "nil or table");
  lua_settop(L, 2);
  if (luaL_getmetafield(L, 1, "__metatable") != LUA_TNIL) return luaL_error(L, "cannot change a protected metatable");
  lua_settop(L, 2);
  if (lua_istable(L, 2)) {
    lua_pushliteral(L, "__gc");
    if (lua_rawget(L, 2) != LUA_TNIL) note_finalized(L);
  }
  lua_settop(L, 2);
  lua_setmetatable(L, 1);
  return 1;
}

int collect_garbage(lua_State* L) {
  lua_pushinteger(L, 0);
  return 1;
}

int traceback(lua_State* L) {
  luaL_traceback(L, L, luaL_optstring(L, 1, nullptr), 1);
  return 1;
}

/// Tables that robots share keep their metatable to themselves, and so are known.
int raw_set(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  luaL_checkany(L, 2);
  luaL_checkany(L, 3);
  lua_settop(L, 3);
  if (is_late(L, 1)) {
    set_late(L);
  } else {
    if (luaL_getmetafield(L, 1, "__metatable") != LUA_TNIL)
      return luaL_error(L, "rawset: this table is shared by all robots");
    lua_rawset(L, 1);
  }
  lua_settop(L, 1);
  return 1;
}

int raw_get(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  luaL_checkany(L, 2);
  lua_settop(L, 2);
  return get_late(L);
}

int raw_length(lua_State* L) {
  luaL_argexpected(L, lua_istable(L, 1) || lua_type(L, 1) == LUA_TSTRING, 1, "table or string");
  lua_pushinteger(L, is_late(L, 1) ? luaL_len(L, 1) : static_cast<lua_Integer>(lua_rawlen(L, 1)));
  return 1;
}

// --- calls in calls ---

/// How errors reach the handler of xpcall: not when the call is over, which no handler may put off.
int handle(lua_State* L) {  // upvalue: the handler
  if (Interpreter::of(L).steps().over != Steps::Over::No) return 1;
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, 1, 1);
  return 1;
}

/// Stack: the handler, true, results.
int end_of_xpcall(lua_State* L, int status, lua_KContext) {
  if (status == LUA_OK || status == LUA_YIELD) return lua_gettop(L) - 1;
  lua_pushboolean(L, 0);
  lua_pushvalue(L, -2);
  return 2;
}

int xpcall(lua_State* L) {  // (function, handler, arguments)
  luaL_checktype(L, 2, LUA_TFUNCTION);
  lua_pushvalue(L, 2);
  lua_pushcclosure(L, &handle, 1);
  lua_replace(L, 2);
  lua_pushboolean(L, 1);
  lua_pushvalue(L, 1);
  lua_rotate(L, 3, 2);  // function, handler, true, function, arguments
  lua_remove(L, 1);     // handler, true, function, arguments
  return end_of_xpcall(L, lua_pcallk(L, lua_gettop(L) - 3, LUA_MULTRET, 1, 0, &end_of_xpcall), 0);
}

/// Resumes with the arguments on the top. @returns the number of results on the top, or -1 with the error there
int resume(lua_State* L, lua_State* thread, int arguments) {
  Interpreter& in = Interpreter::of(L);
  if (lua_checkstack(thread, arguments) == 0) {
    lua_pushliteral(L, "too many arguments to resume");
    return -1;
  }
  if (lua_status(thread) == LUA_OK && lua_gettop(thread) == 0) {
    lua_pushliteral(L, "cannot resume dead coroutine");
    return -1;
  }
  lua_xmove(L, thread, arguments);
  int results = 0;
  const bool on_main = in.set_on_main(false);
  const int status = lua_resume(thread, L, arguments, &results);
  in.set_on_main(on_main);
  if (in.steps().over != Steps::Over::No) {
    luaL_where(L, 1);
    in.stop(L);
  }
  if (status != LUA_OK && status != LUA_YIELD) {
    lua_xmove(thread, L, 1);
    return -1;
  }
  if (lua_checkstack(L, results + 1) == 0) {
    lua_pop(thread, results);
    lua_pushliteral(L, "too many results to resume");
    return -1;
  }
  lua_xmove(thread, L, results);
  return results;
}

int coroutine_resume(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTHREAD);
  const int results = resume(L, lua_tothread(L, 1), lua_gettop(L) - 1);
  lua_pushboolean(L, results >= 0 ? 1 : 0);
  lua_insert(L, results >= 0 ? -(results + 1) : -2);
  return results >= 0 ? results + 1 : 2;
}

int wrapped(lua_State* L) {
  const int results = resume(L, lua_tothread(L, lua_upvalueindex(1)), lua_gettop(L));
  return results >= 0 ? results : lua_error(L);
}

int coroutine_wrap(lua_State* L) {
  luaL_checktype(L, 1, LUA_TFUNCTION);
  lua_State* const thread = lua_newthread(L);
  lua_pushvalue(L, 1);
  lua_xmove(L, thread, 1);
  lua_pushcclosure(L, &wrapped, 1);
  return 1;
}

/// A function of Lua's library that takes as many steps as `count(L)` tells. Upvalue: the function.
template <std::int64_t (*count)(lua_State*)>
int counted(lua_State* L) {
  const std::int64_t steps = count(L);
  if (steps > 0) Interpreter::of(L).spend(L, steps);
  const int arguments = lua_gettop(L);
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_insert(L, 1);
  lua_call(L, arguments, LUA_MULTRET);
  return lua_gettop(L);
}

std::int64_t length_of_first(lua_State* L) {
  return lua_istable(L, 1) ? luaL_len(L, 1) : 0;
}
std::int64_t moved(lua_State* L) {
  const lua_Integer from = luaL_optinteger(L, 2, 1);
  const lua_Integer to = luaL_optinteger(L, 3, 0);
  return from > 0 || to < std::numeric_limits<lua_Integer>::max() + from ? to - from : to;
}
std::int64_t concatenated(lua_State* L) {
  const lua_Integer from = luaL_optinteger(L, 3, 1);
  const lua_Integer to = lua_isnoneornil(L, 4) ? length_of_first(L) : luaL_checkinteger(L, 4);
  return from > 0 || to < std::numeric_limits<lua_Integer>::max() + from ? to - from : to;
}
std::int64_t repeated(lua_State* L) {  // of what is there, memory counts
  const bool nothing = lua_rawlen(L, 1) == 0 && (lua_type(L, 3) != LUA_TSTRING || lua_rawlen(L, 3) == 0);
  return nothing ? luaL_checkinteger(L, 2) : 0;
}
std::int64_t length_of_text(lua_State* L) {
  return lua_type(L, 1) == LUA_TSTRING ? static_cast<std::int64_t>(lua_rawlen(L, 1) / 16) : 0;
}

/// The function `name` of the library on the top counts from now on.
template <std::int64_t (*count)(lua_State*)>
void count_steps(lua_State* L, const char* name) {
  lua_getfield(L, -1, name);
  lua_pushcclosure(L, &counted<count>, 1);
  lua_setfield(L, -2, name);
}

template <std::size_t kCount>
void take_away(lua_State* L, const char* const (&names)[kCount]) {
  for (const char* const name : names) {
    lua_pushnil(L);
    lua_setfield(L, -2, name);
  }
}

/// Opens a library of Lua's into the table `all` and leaves it on the top.
void open(lua_State* L, int all, const char* name, lua_CFunction library) {
  luaL_requiref(L, name, library, 0);
  lua_pushvalue(L, -1);
  lua_setfield(L, all, name);
}

}  // namespace

void push_text(lua_State* L, int index) {
  index = lua_absindex(L, index);
  const int type = lua_type(L, index);
  const bool object = type == LUA_TTABLE || type == LUA_TFUNCTION || type == LUA_TTHREAD || type == LUA_TUSERDATA;
  if (!object || luaL_getmetafield(L, index, "__tostring") != LUA_TNIL) {
    if (object) lua_pop(L, 1);
    luaL_tolstring(L, index, nullptr);
    return;
  }
  Interpreter::of(L).push_own(L);
  if (lua_getfield(L, -1, "numbers") != LUA_TTABLE) {
    lua_pop(L, 1);
    lua_newtable(L);
    lua_pushinteger(L, 0);
    lua_rawseti(L, -2, 0);
    lua_pushvalue(L, -1);
    lua_setfield(L, -3, "numbers");
  }
  lua_pushvalue(L, index);
  if (lua_rawget(L, -2) != LUA_TNUMBER) {
    lua_pop(L, 1);
    lua_rawgeti(L, -1, 0);
    const lua_Integer number = lua_tointeger(L, -1) + 1;
    lua_pop(L, 1);
    lua_pushinteger(L, number);
    lua_rawseti(L, -2, 0);
    lua_pushvalue(L, index);
    lua_pushinteger(L, number);
    lua_rawset(L, -3);
    lua_pushinteger(L, number);
  }
  lua_pushfstring(L, "%s: %I", luaL_typename(L, index), static_cast<LUAI_UACINT>(lua_tointeger(L, -1)));
  lua_insert(L, -4);
  lua_pop(L, 3);
}

void expect_arguments(lua_State* L, int count, const char* call) {
  const int given = lua_gettop(L);
  if (given == count) return;
  const bool colon = given == count + 1 && lua_istable(L, 1);
  luaL_error(L, "%s expects %d argument%s, and got %d%s", call, count, count == 1 ? "" : "s", given,
             colon ? ", the first of them a table: it is called with a dot, not with a colon" : "");
}

namespace {

constexpr luaL_Reg kBase[] = {{"tostring", &tostring},
                              {"rawset", &raw_set},
                              {"rawget", &raw_get},
                              {"rawlen", &raw_length},
                              {"xpcall", &xpcall},
                              {"setmetatable", &set_metatable},
                              {"collectgarbage", &collect_garbage},
                              {"log", &log_info},
                              {"logerr", &log_error},
                              {"print", &print},
                              {nullptr, nullptr}};
constexpr luaL_Reg kCoroutine[] = {{"resume", &coroutine_resume}, {"wrap", &coroutine_wrap}, {nullptr, nullptr}};
constexpr luaL_Reg kDebug[] = {{"traceback", &traceback}, {nullptr, nullptr}};

void open_base(lua_State* L, int all) {
  luaL_requiref(L, "_G", luaopen_base, 0);
  for (const char* const name :
       {"assert", "error", "getmetatable", "ipairs", "pcall", "rawequal", "select", "tonumber", "type", "_VERSION"}) {
    lua_getfield(L, -1, name);
    lua_setfield(L, all, name);
  }
  lua_settop(L, all);
  luaL_setfuncs(L, kBase, 0);
  open_code(L);
  open_order(L);
}

void open_string(lua_State* L, int all) {
  open(L, all, LUA_STRLIBNAME, luaopen_string);
  lua_getfield(L, -1, "format");
  lua_pushcclosure(L, &format, 1);
  lua_setfield(L, -2, "format");
  take_away(L, {"dump"});
  open_patterns(L);
  count_steps<repeated>(L, "rep");
  for (const char* const name : {"reverse", "lower", "upper", "byte"}) count_steps<length_of_text>(L, name);
  lua_pushliteral(L, "");
  lua_getmetatable(L, -1);
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
}

void open_table(lua_State* L, int all) {
  open(L, all, LUA_TABLIBNAME, luaopen_table);
  open_sort(L);
  for (const char* const name : {"insert", "remove"}) count_steps<length_of_first>(L, name);
  count_steps<moved>(L, "move");
  count_steps<concatenated>(L, "concat");
  lua_getfield(L, -1, "unpack");
  lua_setfield(L, all, "unpack");
}

}  // namespace

void open_libraries(lua_State* L, Interpreter& in) {
  const int all = lua_gettop(L);
  open_base(L, all);
  open(L, all, LUA_MATHLIBNAME, luaopen_math);
  open_math(L);
  take_away(L, {"cosh", "sinh", "tanh"});
  lua_settop(L, all);
  open_string(L, all);
  lua_settop(L, all);
  open_table(L, all);
  lua_settop(L, all);
  open(L, all, LUA_COLIBNAME, luaopen_coroutine);
  luaL_setfuncs(L, kCoroutine, 0);
  lua_settop(L, all);
  open(L, all, LUA_UTF8LIBNAME, luaopen_utf8);
  for (const char* const name : {"len", "codepoint", "offset"}) count_steps<length_of_text>(L, name);
  lua_settop(L, all);
  lua_newtable(L);
  luaL_setfuncs(L, kDebug, 0);
  lua_setfield(L, all, "debug");
  lua_settop(L, all);
  open_outside(L, in);
}

}  // namespace tandem::controllers::lua
