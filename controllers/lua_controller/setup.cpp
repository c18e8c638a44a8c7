// Making an interpreter: libraries and the parts of `robot`, of which robots get late copies (own_tables.hpp), and the
// compiled script.
#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "controllers/lua_controller/copies.hpp"
#include "controllers/lua_controller/devices.hpp"
#include "controllers/lua_controller/own_tables.hpp"
#include "controllers/lua_controller/vectors.hpp"

namespace tandem::controllers::lua {
namespace {

/// A text with `_ENV` as its argument, on its first line: line numbers stay.
struct Source {
  static constexpr std::string_view kHead = "local _ENV = ...; ";
  std::string_view text;
  int part = 0;

  static const char* read(lua_State*, void* self, std::size_t* size) {
    Source& s = *static_cast<Source*>(self);
    const std::string_view part = s.part == 0 ? kHead : s.part == 1 ? s.text : std::string_view();
    ++s.part;
    *size = part.size();
    return part.data();
  }
};

std::string_view without_marks(std::string_view text) noexcept {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.starts_with('#')) text.remove_prefix(std::min(text.find('\n'), text.size()));  // "#!/usr/bin/lua"
  return text;
}

/// Whether `word` stands in the text as a word.
bool mentions(std::string_view text, std::string_view word) noexcept {
  const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !in_word(text[at - 1])) && (end == text.size() || !in_word(text[end]))) return true;
  }
  return false;
}

/// "walk.lua:12: unexpected symbol" on the top says what it is: "walk.lua:12: syntax error: unexpected symbol".
void name_syntax_error(lua_State* L) noexcept {
  const char* const text = lua_tostring(L, -1);
  const std::size_t place = length_of_place(text);
  if (place == 0) return;
  lua_pushlstring(L, text, place);
  lua_pushliteral(L, "syntax error: ");
  lua_pushstring(L, text + place);
  lua_concat(L, 3);
  lua_replace(L, -2);
}

int metatable_of(lua_State* L) {
  if (lua_getmetatable(L, 1) == 0) lua_pushnil(L);
  return 1;
}

}  // namespace

std::size_t length_of_place(std::string_view text) noexcept {
  for (std::size_t at = text.find(':'); at != std::string_view::npos; at = text.find(':', at + 1)) {
    const std::size_t end = std::min(text.find_first_not_of("0123456789", at + 1), text.size());
    if (end > at + 1 && text.substr(end).starts_with(": ")) return end + 2;
  }
  return 0;
}

Interpreter::Interpreter(std::shared_ptr<const Script> script, const hal::RobotKind& kind,
                         const std::vector<hal::ListedDevice>& devices)
    : script_(std::move(script)), kind_(kind) {
  if (devices.size() > Actor::kMostDevices)
    throw std::runtime_error("has more devices than " + std::to_string(Actor::kMostDevices) + " in its configuration");
  for (const hal::ListedDevice& listed : devices) {
    Device device;
    device.type = listed.port;
    device.written = listed.written;
    for (const DeviceApi& api : device_apis()) {
      if (api.role == listed.port->role && api.port == listed.port->name && api.layout == listed.port->layout)
        device.api = &api;
    }
    if (device.api != nullptr && device.api->fill != nullptr) filled_.push_back(devices_.size());
    devices_.push_back(std::move(device));
  }
  state_ = lua_newstate(&Memory::allocate, &memory_);
  if (state_ == nullptr) throw std::runtime_error("has no memory for an interpreter");
  memory_.state_is_made();
  *static_cast<Interpreter**>(lua_getextraspace(state_)) = this;
  lua_gc(state_, LUA_GCINC, 0, 0, 0);
  lua_gc(state_, LUA_GCRESTART);  // only when it is asked to: limits.cpp
  lua_sethook(state_, &look, LUA_MASKCOUNT, 1);
  try {
    const Call call(*this);
    protect(&protected_setup, nullptr);
    collect(state_);
  } catch (...) {
    lua_close(state_);
    throw;
  }
}

Interpreter::~Interpreter() {
  lua_close(state_);
}

int Interpreter::protected_setup(lua_State* L) {
  lua_settop(L, 0);
  of(L).filling_ = true;  // tables of readings take what is put into them
  of(L).setup(L);
  return 0;
}

bool Interpreter::compile(lua_State* L, std::string_view text, const char* name) noexcept {
  Source source{without_marks(text)};
  const int status = lua_load(L, &Source::read, &source, name, "t");
  if (status == LUA_ERRSYNTAX) name_syntax_error(L);
  return status == LUA_OK;
}

bool Interpreter::compile_for_all(lua_State* L, std::string_view text, const char* name, const char* file) noexcept {
  const Steps before = steps_;
  Account* const account = memory_.suspend_account();
  const bool compiled = compile(L, text, name);
  if (compiled) {
    lua_getfield(L, LUA_REGISTRYINDEX, "tandem.files");
    lua_pushvalue(L, -2);
    lua_setfield(L, -2, file);
    lua_pop(L, 1);
  }
  memory_.resume_account(account);
  steps_ = before;
  return compiled;
}

void Interpreter::setup(lua_State* L) {
  open_readings(L);
  setup_robot(L);
  setup_globals(L);
  if (!compile(L, script_->text(), ("@" + script_->path).c_str())) lua_error(L);
  chunk_ = luaL_ref(L, LUA_REGISTRYINDEX);
  note_shared(L);
}

/// Parts of `robot`, by name: what late copies are made from, and rings of sensors as they are.
void Interpreter::setup_robot(lua_State* L) {
  lua_newtable(L);  // 1: functions by part
  lua_newtable(L);  // 2: readings by part
  lua_newtable(L);  // 3: parts
  const auto push_table = [L](int tables, const char* part) {
    if (lua_getfield(L, tables, part) == LUA_TTABLE) return;
    lua_pop(L, 1);
    lua_newtable(L);
    lua_pushvalue(L, -1);
    lua_setfield(L, tables, part);
  };
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    const DeviceApi* const api = devices_[i].api;
    if (api == nullptr) continue;
    push_table(1, api->table);
    open_functions(L, *api, i);
    if (api->fill != nullptr) {
      push_table(2, api->table);
      lua_pushvalue(L, -1);
      devices_[i].table = luaL_ref(L, LUA_REGISTRYINDEX);
    }
    if (api->open_ring != nullptr) api->open_ring(L, *this, i);
    lua_settop(L, 3);
  }
  lua_pushvalue(L, 1);
  open_random(L);
  open_ports(L, *this);
  lua_settop(L, 3);
  const auto is_ring = [this](std::string_view part) {
    return std::any_of(devices_.begin(), devices_.end(), [&](const Device& d) {
      return d.api != nullptr && d.api->table == part && d.api->open_ring != nullptr;
    });
  };
  lua_pushnil(L);
  while (lua_next(L, 1) != 0) {  // 4: name, 5: functions
    lua_pushvalue(L, 4);
    lua_rawget(L, 2);
    if (is_ring(lua_tostring(L, 4))) {
      make_readings(L);
    } else {
      lua_insert(L, 5);
      make_late(L);
    }
    lua_pushvalue(L, 4);
    lua_insert(L, -2);
    lua_rawset(L, 3);
    lua_settop(L, 4);
  }
  lua_settop(L, 3);
  parts_ = luaL_ref(L, LUA_REGISTRYINDEX);
  lua_settop(L, 0);
}

void Interpreter::setup_globals(lua_State* L) {
  lua_newtable(L);  // 1: what all robots have
  open_libraries(L, *this);
  lua_getfield(L, 1, LUA_STRLIBNAME);
  strings_ = luaL_ref(L, LUA_REGISTRYINDEX);

  lua_pushcfunction(L, &metatable_of);
  lua_setfield(L, 1, "_tandem_metatable");
  if (!compile(L, kVectors, "=vectors")) lua_error(L);
  lua_pushvalue(L, 1);
  lua_call(L, 1, 0);
  for (const char* const maker : {"vector2", "vector3", "orientation"}) {  // what devices call
    const char* const name = lua_pushfstring(L, "_tandem_%s", maker);
    const char* const kept = lua_pushfstring(L, "tandem.%s", maker);
    lua_getfield(L, 1, name);
    lua_setfield(L, LUA_REGISTRYINDEX, kept);
    lua_pushnil(L);
    lua_setfield(L, 1, name);
    lua_settop(L, 1);
  }
  lua_pushnil(L);
  lua_setfield(L, 1, "_tandem_metatable");

  lua_newtable(L);  // 2: libraries
  for (const char* const library : {"math", "string", "table", "coroutine", "utf8", "os", "debug", "io", "package"}) {
    lua_pushnil(L);  // no readings
    lua_getfield(L, 1, library);
    make_late(L);
    lua_setfield(L, 2, library);
    lua_pushnil(L);
    lua_setfield(L, 1, library);
  }
  // Names that the script uses are put into each robot's globals: found there, they cost the least.
  lua_newtable(L);  // 3
  for (const int names : {1, 2}) {
    lua_pushnil(L);
    while (lua_next(L, names) != 0) {
      const std::string_view name = lua_tostring(L, -2);
      const bool used = std::any_of(script_->files.begin(), script_->files.end(),
                                    [&](const hal::SourceFile& file) { return mentions(file.text, name); });
      if (used) {
        lua_pushvalue(L, -2);
        lua_pushvalue(L, -2);
        lua_rawset(L, 3);
      }
      lua_pop(L, 1);
    }
  }
  constexpr int kOfAScript = 10;  // with _G and robot
  globals_of_one_ = kOfAScript;
  for (lua_pushnil(L); lua_next(L, 3) != 0; lua_pop(L, 1)) ++globals_of_one_;
  direct_ = luaL_ref(L, LUA_REGISTRYINDEX);
  libraries_ = luaL_ref(L, LUA_REGISTRYINDEX);

  lua_newtable(L);
  lua_pushcfunction(L, &unknown_global);
  lua_setfield(L, -2, "__index");
  lua_setmetatable(L, 1);
  lua_newtable(L);
  lua_pushvalue(L, 1);
  lua_setfield(L, -2, "__index");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  globals_meta_ = luaL_ref(L, LUA_REGISTRYINDEX);
  common_ = luaL_ref(L, LUA_REGISTRYINDEX);
}

/// What no global of the robot's and no function has that name: a library that it has not used yet, or nothing.
int Interpreter::unknown_global(lua_State* L) {
  Interpreter& in = of(L);
  if (lua_type(L, 2) == LUA_TSTRING && in.push_library(L, lua_tostring(L, 2))) return 1;
  if (!in.script_->strict) return 0;
  push_text(L, 2);
  return luaL_error(L, "nothing has been assigned to the global '%s'; the parameter strict forbids to read it",
                    lua_tostring(L, -1));
}

/// All that there is now is no robot's state.
void Interpreter::note_shared(lua_State* L) {
  lua_settop(L, 0);
  shared_ = push_shared(L, {common_, direct_, globals_meta_, libraries_, parts_, chunk_});
}

}  // namespace tandem::controllers::lua
