#include "controllers/lua_controller/interpreter.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "controllers/lua_controller/copies.hpp"
#include "controllers/lua_controller/devices.hpp"
#include "controllers/lua_controller/own_tables.hpp"
#include "controllers/lua_controller/sources.hpp"
#include "hal/element.hpp"

namespace tandem::controllers::lua {
namespace {

constexpr std::ptrdiff_t kMostHot = 2048;

struct Begin {
  Variables made;
};
struct Stepping {
  Interpreter::Turn (*next)(void*);
  void* job;
};
struct Function {
  const char* name;
  bool found;
};

}  // namespace

bool Script::read(const std::string& name, std::string& found_path, std::string& found_text) const {
  const std::string written = name_beneath(files.front().name, name);
  for (const hal::SourceFile& file : files) {
    if (file.name != written) continue;
    found_path = file.path;
    found_text = file.text;
    return true;
  }
  return read_beneath(path, name, found_path, found_text);
}

// --- calls, and their end ---

void Interpreter::leave() noexcept {
  memory_.charge_to(nullptr, 0);
  steps_.begin(Steps::kUnlimited);
  if (memory_.collection_due()) collect(state_);
  actor_ = nullptr;
  variables_ = nullptr;
  filling_ = false;
  memory_.set_filling(false);
  lua_settop(state_, 0);
}

/// The readings of the present robot. What is made for it is charged; the lists that it stands in are everybody's.
void Interpreter::fill(lua_State* L) {
  memory_.charge_to(&variables_->account, script_->most_memory * Script::kMemoryOfCall);
  memory_.set_filling(true);
  filling_ = true;
  for (const std::size_t i : filled_) devices_[i].api->fill(L, *this, i, actor_->ports[i]);
  filling_ = false;
  memory_.set_filling(false);
}

void Interpreter::tell_dropped(std::uint32_t dropped, const char* what) {
  if (dropped == 0 || std::exchange(dropped_told_, true)) return;
  actor_->log.warning(std::to_string(dropped) + " " + what +
                      " were dropped, the farthest: more than its port keeps; from here on nothing is said of that");
}

/// Calls the function below its arguments, on the top, as the present robot's.
void Interpreter::run(lua_State* L, int arguments) {
  if (variables_->strings != strings_now_) select_strings(L, variables_->strings);
  memory_.charge_to(&variables_->account, script_->most_memory * Script::kMemoryOfCall);
  steps_.begin(script_->most_instructions);
  lua_call(L, arguments, 0);
  if (steps_.left < 0) steps_.go_on();
  const Steps::Over over = steps_.over;
  memory_.charge_to(nullptr, 0);
  steps_.begin(Steps::kUnlimited);
  if (over != Steps::Over::No) {
    steps_.over = over;
    lua_pushliteral(L, "");
    stop(L);
  }
  if (variables_->account.charged >= variables_->account.measure_at) check_kept(L);
  if (memory_.collection_due()) collect(L);
}

void Interpreter::look(lua_State* L, lua_Debug*) {
  Interpreter& in = of(L);
  if (in.memory_.collection_due()) in.collect(L);
  in.steps_.go_on();
  if (in.steps_.over == Steps::Over::No) return;
  luaL_where(L, 0);
  in.stop(L);
}

void Interpreter::exhausted(lua_State* L) {
  steps_.go_on();
  if (steps_.over == Steps::Over::No) return;
  luaL_where(L, 1);
  stop(L);
}

int Interpreter::stop(lua_State* L) {
  if (steps_.over == Steps::Over::Memory)
    lua_pushfstring(L,
                    "it takes more memory than a robot has: %I MiB that stay, and %I in one call; the parameter "
                    "most_memory allows more",
                    static_cast<LUAI_UACINT>(script_->most_memory >> 20U),
                    static_cast<LUAI_UACINT>(script_->most_memory * Script::kMemoryOfCall >> 20U));
  else
    lua_pushfstring(L,
                    "it does not come to an end: %I instructions were not enough; the parameter most_instructions "
                    "allows more",
                    static_cast<LUAI_UACINT>(script_->most_instructions));
  lua_concat(L, 2);
  return lua_error(L);
}

void Interpreter::collect(lua_State* L) noexcept {
  lua_gc(L, LUA_GCCOLLECT, 0);
  memory_.collected();
}

/// What the present robot keeps from call to call; too much is an error.
void Interpreter::check_kept(lua_State* L) {
  Account& account = variables_->account;
  const std::uint64_t kept = measured(L);
  const std::uint64_t most = script_->most_memory;
  account.charged = 0;
  account.measure_at = std::max(most - std::min(kept, most), most / 8);
  if (kept <= most) return;
  steps_.over = Steps::Over::Memory;
  lua_pushliteral(L, "");
  stop(L);
}

/// "x":name() looks in the library of texts that is referred to, or in everybody's.
void Interpreter::select_strings(lua_State* L, int strings) {
  lua_pushliteral(L, "");
  lua_getmetatable(L, -1);
  lua_rawgeti(L, LUA_REGISTRYINDEX, strings == LUA_NOREF ? strings_ : strings);
  lua_setfield(L, -2, "__index");
  lua_pop(L, 2);
  strings_now_ = strings;
}

/// Whether the robot's library of texts is a late copy or one in full; on the top is what is its own besides.
void Interpreter::find_strings(lua_State* L, Variables& variables) {
  luaL_unref(L, LUA_REGISTRYINDEX, variables.strings);
  variables.strings = LUA_NOREF;
  if (lua_getfield(L, -1, "string") == LUA_TTABLE && !is_late(L, -1)) {
    variables.strings = luaL_ref(L, LUA_REGISTRYINDEX);
  } else {
    lua_pop(L, 1);
  }
  select_strings(L, variables.strings);
}

void Interpreter::became_own(lua_State* L) {
  push_own(L);
  lua_getfield(L, -1, "string");
  const bool strings = lua_rawequal(L, -1, 1) != 0;
  lua_pop(L, 1);
  if (strings) find_strings(L, *variables_);
  lua_pop(L, 1);
}

bool Interpreter::push_library(lua_State* L, const char* name) {
  lua_rawgeti(L, LUA_REGISTRYINDEX, libraries_);
  if (lua_getfield(L, -1, name) != LUA_TTABLE) {
    lua_pop(L, 2);
    return false;
  }
  push_late_copy(L, -1);
  push_globals(L);
  lua_pushstring(L, name);
  lua_pushvalue(L, -3);
  lua_rawset(L, -3);
  lua_pop(L, 1);
  if (std::string_view(name) == LUA_STRLIBNAME) {
    push_own(L);
    if (lua_getfield(L, -1, "string") == LUA_TNIL) {  // the first: what texts look in, whatever becomes of the name
      lua_pushvalue(L, -3);
      lua_setfield(L, -3, "string");
    }
    lua_pop(L, 2);
  }
  lua_replace(L, -3);
  lua_pop(L, 1);
  return true;
}

std::string Interpreter::taken_message() {
  std::string text;
  if (lua_type(state_, -1) == LUA_TSTRING) {
    std::size_t size = 0;
    const char* const characters = lua_tolstring(state_, -1, &size);
    text.assign(characters, size);
  } else {
    text = std::string("an error that is no text but a ") + luaL_typename(state_, -1);
  }
  lua_settop(state_, 0);
  if (text == "not enough memory") {
    if (steps_.over != Steps::Over::Memory) return text + ": the machine has no more";
    text = "it takes more memory than a robot has: " +
           std::to_string(script_->most_memory * Script::kMemoryOfCall >> 20U) +
           " MiB in one call; the parameter most_memory allows more";
  }
  for (const DeviceApi& api : device_apis()) {
    const bool open = std::any_of(devices_.begin(), devices_.end(), [&](const Device& d) {
      return d.api != nullptr && std::string_view(d.api->table) == api.table;
    });
    if (open || text.find("(field '" + std::string(api.table) + "')") == std::string::npos) continue;
    text += "; the configuration lists no device for robot." + std::string(api.table);
    return text;
  }
  constexpr std::string_view kMissing = "a nil value (field '";
  if (const std::size_t at = text.find(kMissing); at != std::string::npos) {
    const std::size_t begin = at + kMissing.size();
    const std::string name = text.substr(begin, text.find('\'', begin) - begin);
    const std::string near = hal::closest(name, shared_names());
    if (near == name && !name.empty()) {
      text += "; there is such a name, but in another table";
    } else if (!near.empty()) {
      text += "; there is '" + near + "'";
    }
  }
  return text;
}

/// Names of functions of libraries and devices, and of devices.
std::vector<std::string> Interpreter::shared_names() {
  std::vector<std::string> names;
  const auto take = [&] {  // the keys of the table on the top
    lua_pushnil(state_);
    while (lua_next(state_, -2) != 0) {
      lua_pop(state_, 1);
      if (lua_type(state_, -1) == LUA_TSTRING) names.emplace_back(lua_tostring(state_, -1));
    }
  };
  for (const int tables : {libraries_, parts_}) {
    lua_rawgeti(state_, LUA_REGISTRYINDEX, tables);
    lua_pushnil(state_);
    while (lua_next(state_, 1) != 0) {
      if (is_original(state_, -1)) {
        push_late_copy(state_, -1);
        push_whole(state_, -1);
        take();
      }
      lua_settop(state_, 2);
    }
    lua_settop(state_, 0);
  }
  return names;
}

void Interpreter::protect(lua_CFunction function, void* argument) {
  lua_settop(state_, 0);
  lua_pushcfunction(state_, function);
  lua_pushlightuserdata(state_, argument);
  if (lua_pcall(state_, 1, 0, 0) != LUA_OK) throw std::runtime_error(taken_message());
}

// --- robots ---

int Interpreter::protected_begin(lua_State* L) {
  Interpreter& in = of(L);
  Begin& begin = *static_cast<Begin*>(lua_touserdata(L, 1));
  in.variables_ = &begin.made;
  begin.made.account.measure_at = in.script_->most_memory;
  lua_createtable(L, 0, 4);  // 2: what is its own besides
  lua_pushvalue(L, 2);
  begin.made.own = luaL_ref(L, LUA_REGISTRYINDEX);
  lua_newtable(L);
  lua_setfield(L, 2, "added");
  lua_newtable(L);
  lua_setfield(L, 2, "loaded");

  // What a step uses is made at once, so that it lies together.
  const std::byte* const first = in.memory_.next();
  lua_createtable(L, 0, in.globals_of_one_);  // 3: globals
  lua_pushvalue(L, 3);
  begin.made.globals = luaL_ref(L, LUA_REGISTRYINDEX);
  lua_rawgeti(L, LUA_REGISTRYINDEX, in.direct_);  // 4
  lua_pushnil(L);
  while (lua_next(L, 4) != 0) {
    if (is_original(L, -1)) {
      lua_pop(L, 1);
      in.push_library(L, lua_tostring(L, -1));
    } else {
      lua_pushvalue(L, -2);
      lua_pushvalue(L, -2);
      lua_rawset(L, 3);
    }
    lua_pop(L, 1);
  }
  lua_settop(L, 3);
  lua_pushvalue(L, 3);
  lua_setfield(L, 3, "_G");
  in.push_robot(L);
  lua_setfield(L, 3, "robot");
  lua_rawgeti(L, LUA_REGISTRYINDEX, in.globals_meta_);
  lua_setmetatable(L, 3);

  in.fill(L);
  lua_rawgeti(L, LUA_REGISTRYINDEX, in.chunk_);
  lua_pushvalue(L, 3);
  in.run(L, 1);
  if (in.memory_.next() > first && in.memory_.next() - first < kMostHot) {
    begin.made.hot = first;
    begin.made.hot_bytes = static_cast<std::size_t>(in.memory_.next() - first);
  }
  lua_pushliteral(L, "step");
  if (lua_rawget(L, 3) != LUA_TFUNCTION)
    luaL_error(L, "%s has no function step(), which is called in every step", in.script_->path.c_str());
  lua_pushliteral(L, "init");
  if (lua_rawget(L, 3) == LUA_TFUNCTION) in.run(L, 0);
  return 0;
}

/// Pushes the table `robot` of the present robot.
void Interpreter::push_robot(lua_State* L) {
  lua_createtable(L, 0, 8);
  const int robot = lua_gettop(L);
  lua_rawgeti(L, LUA_REGISTRYINDEX, parts_);
  lua_pushnil(L);
  while (lua_next(L, robot + 1) != 0) {
    if (is_original(L, -1)) {
      push_late_copy(L, -1);
      lua_replace(L, -2);
    }
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    lua_rawset(L, robot);
  }
  lua_pushlstring(L, actor_->id.data(), actor_->id.size());
  lua_setfield(L, robot, "id");
  lua_newtable(L);
  for (const hal::NamedText& param : script_->params) {
    lua_pushlstring(L, param.value.data(), param.value.size());
    lua_setfield(L, -2, param.name.c_str());
  }
  lua_setfield(L, robot, "params");
  lua_settop(L, robot);
}

Variables Interpreter::begin(Actor& actor) {
  const Call call(*this);
  actor_ = &actor;
  Begin begin;
  try {
    protect(&protected_begin, &begin);
  } catch (...) {
    end(begin.made);
    throw;
  }
  return begin.made;
}

void Interpreter::end(Variables& variables) noexcept {
  if (strings_now_ == variables.strings) strings_now_ = kUnknown;  // another robot's can get its number
  luaL_unref(state_, LUA_REGISTRYINDEX, variables.strings);
  luaL_unref(state_, LUA_REGISTRYINDEX, variables.globals);
  luaL_unref(state_, LUA_REGISTRYINDEX, variables.own);
}

bool Interpreter::has(Variables& variables, const char* function) {
  const Call call(*this);
  variables_ = &variables;
  Function asked{function, false};
  protect(
      [](lua_State* L) {
        auto& f = *static_cast<Function*>(lua_touserdata(L, 1));
        of(L).push_globals(L);
        lua_pushstring(L, f.name);
        f.found = lua_rawget(L, -2) == LUA_TFUNCTION;
        return 0;
      },
      &asked);
  return asked.found;
}

bool Interpreter::call(Actor& actor, Variables& variables, const char* function) {
  const Call call(*this);
  actor_ = &actor;
  variables_ = &variables;
  Function asked{function, false};
  protect(
      [](lua_State* L) {
        auto& f = *static_cast<Function*>(lua_touserdata(L, 1));
        of(L).fill(L);
        of(L).push_globals(L);
        lua_pushstring(L, f.name);
        f.found = lua_rawget(L, -2) == LUA_TFUNCTION;
        if (f.found) of(L).run(L, 0);
        return 0;
      },
      &asked);
  return asked.found;
}

bool Interpreter::finalize_last(Actor& actor, Variables& variables) {
  const Call call(*this);
  actor_ = &actor;
  variables_ = &variables;
  bool any = false;
  protect(
      [](lua_State* L) {
        of(L).push_own(L);
        if (lua_getfield(L, -1, "finalized") != LUA_TTABLE) return 0;
        const auto last = static_cast<lua_Integer>(lua_rawlen(L, -1));
        if (last == 0) return 0;
        *static_cast<bool*>(lua_touserdata(L, 1)) = true;
        lua_rawgeti(L, -1, last);
        lua_pushnil(L);
        lua_rawseti(L, -3, last);
        if (luaL_getmetafield(L, -1, "__gc") != LUA_TFUNCTION) return 0;
        lua_insert(L, -2);
        of(L).run(L, 1);
        return 0;
      },
      &any);
  return any;
}

int Interpreter::protected_step(lua_State* L) {
  Interpreter& in = of(L);
  const Stepping& todo = *static_cast<const Stepping*>(lua_touserdata(L, 1));
  lua_pushliteral(L, "step");
  for (;;) {
    const Turn turn = todo.next(todo.job);
    if (turn.actor == nullptr) return 0;
    in.actor_ = turn.actor;
    in.variables_ = turn.variables;
    in.fill(L);
    lua_rawgeti(L, LUA_REGISTRYINDEX, turn.variables->globals);
    lua_pushvalue(L, 2);
    lua_rawget(L, -2);
    in.run(L, 0);
    lua_settop(L, 2);
  }
}

std::string Interpreter::step(Turn (*next)(void*), void* job) noexcept {
  const Call call(*this);
  Stepping todo{next, job};
  lua_settop(state_, 0);
  lua_pushcfunction(state_, &protected_step);
  lua_pushlightuserdata(state_, &todo);
  if (lua_pcall(state_, 1, 0, 0) == LUA_OK) return {};
  if (steps_.over == Steps::Over::Memory && variables_ != nullptr) empty(*variables_);
  return taken_message();
}

/// What the robot had, which is at its end, is garbage from now on.
void Interpreter::empty(const Variables& variables) noexcept {
  for (const int table : {variables.globals, variables.own}) {
    lua_rawgeti(state_, LUA_REGISTRYINDEX, table);
    lua_pushnil(state_);
    while (lua_next(state_, -2) != 0) {
      lua_pop(state_, 1);
      lua_pushvalue(state_, -1);
      lua_pushnil(state_);
      lua_rawset(state_, -4);
    }
    lua_pop(state_, 1);
  }
}

// --- copies ---

std::uint64_t Interpreter::measured(lua_State* L) {
  return measure_reached(L, {variables_->globals, variables_->own}, shared_);
}

int Interpreter::protected_keep(lua_State* L) {
  Interpreter& in = of(L);
  push_record(L, {in.variables_->globals, in.variables_->own}, in.shared_);
  *static_cast<int*>(lua_touserdata(L, 1)) = luaL_ref(L, LUA_REGISTRYINDEX);
  return 0;
}

int Interpreter::keep(Variables& variables) {
  const Call call(*this);
  variables_ = &variables;
  int kept = LUA_NOREF;
  protect(&protected_keep, &kept);
  return kept;
}

int Interpreter::protected_put_back(lua_State* L) {
  Interpreter& in = of(L);
  lua_rawgeti(L, LUA_REGISTRYINDEX, *static_cast<const int*>(lua_touserdata(L, 1)));
  put_back_record(L);
  in.push_own(L);
  in.find_strings(L, *in.variables_);
  return 0;
}

void Interpreter::put_back(Variables& variables, int kept) {
  const Call call(*this);
  variables_ = &variables;
  protect(&protected_put_back, &kept);
}

int Interpreter::share(int kept) {
  const Call call(*this);
  protect(
      [](lua_State* L) {
        int& reference = *static_cast<int*>(lua_touserdata(L, 1));
        lua_rawgeti(L, LUA_REGISTRYINDEX, reference);
        reference = luaL_ref(L, LUA_REGISTRYINDEX);
        return 0;
      },
      &kept);
  return kept;
}

void Interpreter::forget(int kept) noexcept {
  luaL_unref(state_, LUA_REGISTRYINDEX, kept);
}

}  // namespace tandem::controllers::lua
