// What scripts have of the world outside of their robot: code in files, and, where they are allowed it, all of Lua's io
// and os.
#include <cstdio>
#include <cstring>
#include <string>

#include "controllers/lua_controller/devices.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/input_file.hpp"

// The files of the process, which Lua's own code refers to in functions that scripts do not have: by the linker's
// option
// --wrap.
extern "C" {
extern FILE *__real_stdin, *__real_stdout, *__real_stderr;
FILE* __wrap_stdin = nullptr;
FILE* __wrap_stdout = nullptr;
FILE* __wrap_stderr = nullptr;
}

namespace tandem::controllers::lua {
namespace {

constexpr std::size_t kLargestScript = std::size_t{64} << 20;

void use_files_of_process() noexcept {
  static const bool once = [] {
    __wrap_stdin = __real_stdin;
    __wrap_stdout = __real_stdout;
    __wrap_stderr = __real_stderr;
    return true;
  }();
  (void)once;
}

// --- code ---

/// Pushes the chunk of a file, as compiled for all robots of the interpreter, or a message. Lua's errors leave no
/// object of C++ behind: the texts go to Lua first.
enum class Loaded { Yes, Missing, Wrong };
Loaded push_file(lua_State* L, const char* name) {
  lua_getfield(L, LUA_REGISTRYINDEX, "tandem.files");
  if (lua_getfield(L, -1, name) == LUA_TFUNCTION) {
    lua_remove(L, -2);
    return Loaded::Yes;
  }
  lua_pop(L, 1);
  bool compiled = false;
  bool found = false;
  {
    std::string path;
    std::string text;
    try {
      found = Interpreter::of(L).script().read(name, path, text);
      path.insert(0, "@");
    } catch (const std::exception&) {
      found = false;
    }
    if (!found && Interpreter::of(L).script().allow_io) {
      if (auto read = hal::read_whole_file(name, "the script", kLargestScript); read.ok()) {
        found = true;
        path = std::string("@") + name;
        text = std::move(read).value();
      }
    }
    if (found) compiled = Interpreter::of(L).compile_for_all(L, text, path.c_str(), name);
  }
  if (!found) {
    lua_pop(L, 1);
    return Loaded::Missing;
  }
  lua_remove(L, -2);
  return compiled ? Loaded::Yes : Loaded::Wrong;
}

/// The same by the robot's package.path. Stack: 5 is the module's name with slashes.
Loaded push_by_package_path(lua_State* L) {
  Interpreter::of(L).push_globals(L);
  if (lua_getfield(L, -1, LUA_LOADLIBNAME) != LUA_TTABLE || lua_getfield(L, -1, "path") != LUA_TSTRING)
    return Loaded::Missing;
  luaL_gsub(L, lua_tostring(L, -1), "?", lua_tostring(L, 5));
  for (const char* at = lua_tostring(L, -1); *at != '\0';) {
    const char* const end = at + std::strcspn(at, ";");
    lua_pushlstring(L, at, static_cast<std::size_t>(end - at));
    if (const Loaded loaded = push_file(L, lua_tostring(L, -1)); loaded != Loaded::Missing) return loaded;
    lua_pop(L, 1);
    at = *end == ';' ? end + 1 : end;
  }
  return Loaded::Missing;
}

int require(lua_State* L) {
  const char* const name = luaL_checkstring(L, 1);
  lua_settop(L, 1);
  Interpreter::of(L).push_own(L);
  lua_getfield(L, 2, "loaded");  // 3
  if (lua_getfield(L, 3, name) != LUA_TNIL) return 1;
  for (const char* const library : {"math", "string", "table", "coroutine", "utf8", "os"}) {
    if (std::strcmp(library, name) != 0) continue;
    Interpreter::of(L).push_globals(L);
    lua_getfield(L, -1, name);
    return 1;
  }
  luaL_gsub(L, name, ".", "/");
  Loaded loaded = Loaded::Missing;
  for (const char* const end : {".lua", "/init.lua"}) {
    lua_settop(L, 5);
    loaded = push_file(L, lua_pushfstring(L, "%s%s", lua_tostring(L, 5), end));
    if (loaded != Loaded::Missing) break;
  }
  if (loaded == Loaded::Missing && Interpreter::of(L).script().allow_io) loaded = push_by_package_path(L);
  if (loaded == Loaded::Missing)
    return luaL_error(L,
                      "require: there is no module '%s': neither %s.lua nor %s/init.lua lies beneath the folder of %s",
                      name, lua_tostring(L, 5), lua_tostring(L, 5), Interpreter::of(L).script().path.c_str());
  if (loaded == Loaded::Wrong) return lua_error(L);
  Interpreter::of(L).push_globals(L);
  lua_call(L, 1, 1);
  if (lua_isnil(L, -1)) lua_pushboolean(L, 1);
  lua_pushvalue(L, -1);
  lua_setfield(L, 3, name);
  return 1;
}

int do_file(lua_State* L) {
  const char* const name = luaL_checkstring(L, 1);
  lua_settop(L, 1);
  switch (push_file(L, name)) {
    case Loaded::Missing:
      return luaL_error(L, "dofile: there is no file '%s' beneath the folder of %s%s", name,
                        Interpreter::of(L).script().path.c_str(),
                        Interpreter::of(L).script().allow_io ? ", nor at that path"
                                                             : "; allow_io=\"true\" in <params> allows others");
    case Loaded::Wrong:
      return lua_error(L);
    case Loaded::Yes:
      break;
  }
  Interpreter::of(L).push_globals(L);
  lua_call(L, 1, LUA_MULTRET);
  return lua_gettop(L) - 1;
}

/// Runs the chunk of a file with its environment: its upvalues.
int run_file(lua_State* L) {
  lua_settop(L, 0);
  lua_pushvalue(L, lua_upvalueindex(1));
  lua_pushvalue(L, lua_upvalueindex(2));
  lua_call(L, 1, LUA_MULTRET);
  return lua_gettop(L);
}

int load_file(lua_State* L) {  // (name, mode, environment)
  if (!Interpreter::of(L).script().allow_io) {
    return luaL_error(L,
                      "loadfile is not there: allow_io=\"true\" in <params>, or the option --allow-io, gives it to "
                      "scripts; require and dofile take files beneath the script's folder");
  }
  const char* const name = luaL_checkstring(L, 1);
  lua_settop(L, 3);
  switch (push_file(L, name)) {
    case Loaded::Missing:
      lua_pushnil(L);
      lua_pushfstring(L, "cannot open %s", name);
      return 2;
    case Loaded::Wrong:
      lua_pushnil(L);
      lua_insert(L, -2);
      return 2;
    case Loaded::Yes:
      break;
  }
  if (lua_isnil(L, 3))
    Interpreter::of(L).push_globals(L);
  else
    lua_pushvalue(L, 3);
  lua_pushcclosure(L, &run_file, 2);
  return 1;
}

/// A text as a function: with the robot's globals, or the environment that is given.
int load(lua_State* L) {
  std::size_t size = 0;
  const char* const text = luaL_checklstring(L, 1, &size);
  const char* const name = luaL_optstring(L, 2, "=(load)");
  lua_settop(L, 4);
  if (luaL_loadbufferx(L, text, size, name, "t") != LUA_OK) {
    lua_pushnil(L);
    lua_insert(L, -2);
    return 2;
  }
  if (lua_isnil(L, 4))
    Interpreter::of(L).push_globals(L);
  else
    lua_pushvalue(L, 4);
  lua_setupvalue(L, -2, 1);
  return 1;
}

// --- clock and files ---

/// The clock's port, where the configuration lists it.
const hal::Clock* clock_of(lua_State* L) {
  Interpreter& in = Interpreter::of(L);
  for (std::size_t i = 0; i < in.devices().size(); ++i) {
    if (in.devices()[i].type->layout == hal::port_type<hal::Clock>().layout &&
        in.devices()[i].type->name == hal::Clock::kName)
      return static_cast<const hal::Clock*>(in.actor().ports[i]);
  }
  return nullptr;
}

int os_clock(lua_State* L) {
  const hal::Clock* const clock = clock_of(L);
  lua_pushnumber(L, clock == nullptr ? 0.0 : hal::to_seconds(clock->now_ns));
  return 1;
}

int os_time(lua_State* L) {
  if (!lua_isnoneornil(L, 1)) return luaL_error(L, "os.time takes no date here: it is the time of the run");
  const hal::Clock* const clock = clock_of(L);
  lua_pushinteger(L, clock == nullptr ? 0 : clock->now_ns / hal::kNsPerSecond);
  return 1;
}

int left_out(lua_State* L) {  // upvalue: the library's name
  push_text(L, 2);
  return luaL_error(L,
                    "%s.%s is not there: what a robot does depends on its sensors and on its random numbers alone; "
                    "allow_io=\"true\" in <params>, or the option --allow-io, gives scripts all of %s",
                    lua_tostring(L, lua_upvalueindex(1)), lua_tostring(L, -1), lua_tostring(L, lua_upvalueindex(1)));
}

/// What would end or change the whole program.
int of_the_program(lua_State* L) {
  return luaL_error(L, "os.exit and os.setlocale are not there: they would end or change the whole run");
}

constexpr luaL_Reg kCode[] = {{"require", &require}, {"dofile", &do_file},  {"loadfile", &load_file},
                              {"load", &load},       {"loadstring", &load}, {nullptr, nullptr}};
constexpr luaL_Reg kOs[] = {{"clock", &os_clock}, {"time", &os_time}, {nullptr, nullptr}};

/// What is left of a library that reaches outside; what it lacks says why.
void open_rest(lua_State* L, int all, const char* name, const luaL_Reg* functions) {
  lua_newtable(L);
  if (functions != nullptr) luaL_setfuncs(L, functions, 0);
  lua_pushvalue(L, -1);
  lua_setfield(L, all, name);
  lua_newtable(L);
  lua_pushstring(L, name);
  lua_pushcclosure(L, &left_out, 1);
  lua_setfield(L, -2, "__index");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_setmetatable(L, -2);
}

/// All of io and os but what concerns the whole program, and package.path.
void open_files(lua_State* L, int all) {
  use_files_of_process();
  luaL_requiref(L, LUA_IOLIBNAME, luaopen_io, 0);
  lua_setfield(L, all, LUA_IOLIBNAME);
  luaL_getmetatable(L, LUA_FILEHANDLE);
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_settop(L, all);
  luaL_requiref(L, LUA_OSLIBNAME, luaopen_os, 0);
  lua_pushvalue(L, -1);
  lua_setfield(L, all, LUA_OSLIBNAME);
  for (const char* const name : {"exit", "setlocale"}) {
    lua_pushcfunction(L, &of_the_program);
    lua_setfield(L, -2, name);
  }
  lua_settop(L, all);
  lua_newtable(L);
  lua_pushliteral(L, "./?.lua;./?/init.lua");
  lua_setfield(L, -2, "path");
  lua_pushliteral(L, "");
  lua_setfield(L, -2, "cpath");
  lua_pushliteral(L, "/\n;\n?\n!\n-\n");
  lua_setfield(L, -2, "config");
  lua_setfield(L, all, LUA_LOADLIBNAME);
  lua_settop(L, all);
}

}  // namespace

void open_code(lua_State* L) {
  lua_newtable(L);
  lua_setfield(L, LUA_REGISTRYINDEX, "tandem.files");
  luaL_setfuncs(L, kCode, 0);
}

void open_outside(lua_State* L, Interpreter& in) {
  const int all = lua_gettop(L);
  if (in.script().allow_io) return open_files(L, all);
  open_rest(L, all, LUA_OSLIBNAME, kOs);
  open_rest(L, all, LUA_IOLIBNAME, nullptr);
  open_rest(L, all, LUA_LOADLIBNAME, nullptr);
  lua_settop(L, all);
}

}  // namespace tandem::controllers::lua
