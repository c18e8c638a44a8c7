#include "controllers/lua_controller/interpreter.hpp"

#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstring>
#include <pthread.h>
#include <stdexcept>

#include "controllers/lua_controller/devices.hpp"
#include "controllers/lua_controller/sources.hpp"
#include "controllers/lua_controller/vectors.hpp"
#include "controllers/lua_controller/watchdog.hpp"
#include "hal/element.hpp"

namespace tandem::controllers::lua {
namespace {

constexpr int kCountedAtOnce = 10'000;  // instructions

thread_local Interpreter* stepping = nullptr;

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

// --- fields of shared tables that are each robot's own ---

/// Pushes the fields that the present robot has added to the table at `index`, or nil.
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

int shared_index(lua_State* L) {  // (table, key)
  push_added(L, 1, false);
  if (!lua_istable(L, -1)) return 0;
  lua_pushvalue(L, 2);
  lua_rawget(L, -2);
  return 1;
}

int shared_newindex(lua_State* L) {  // (table, key, value)
  if (Interpreter::of(L).filling()) {
    lua_rawset(L, 1);
    return 0;
  }
  if (lua_type(L, 2) != LUA_TSTRING)
    return luaL_error(L,
                      "this table is filled anew for every step: what is to stay in it goes into a table of the "
                      "script's own");
  push_added(L, 1, true);
  lua_pushvalue(L, 2);
  lua_pushvalue(L, 3);
  lua_rawset(L, -3);
  return 0;
}

int robot_index(lua_State* L) {  // robot.id, robot.params, and what the script added
  if (lua_type(L, 2) == LUA_TSTRING) {
    const char* const key = lua_tostring(L, 2);
    Interpreter& in = Interpreter::of(L);
    if (std::strcmp(key, "id") == 0) {
      lua_pushlstring(L, in.actor().id.data(), in.actor().id.size());
      return 1;
    }
    if (std::strcmp(key, "params") == 0) {
      in.push_own(L);
      lua_getfield(L, -1, "params");
      return 1;
    }
  }
  return shared_index(L);
}

int unknown_global(lua_State* L) {
  return luaL_error(L, "nothing has been assigned to the global '%s'; the parameter strict forbids to read it",
                    luaL_tolstring(L, 2, nullptr));
}

// --- what a robot's functions can change ---

char no_value;  // stands for nil in what was kept

/// Walks over everything that can be reached. Stack: 1 argument, 2 record or nil, 3 seen, 4 shared, 5 to do.
class Walk {
 public:
  explicit Walk(lua_State* state) : L(state) {}

  void visit(int index) {
    index = lua_absindex(L, index);
    const int type = lua_type(L, index);
    if (type == LUA_TTHREAD) return check_thread(index);
    if (type != LUA_TTABLE && type != LUA_TFUNCTION) return;
    for (const int set : {3, 4}) {
      lua_pushvalue(L, index);
      const bool known = lua_rawget(L, set) != LUA_TNIL;
      lua_pop(L, 1);
      if (known) return;
    }
    lua_pushvalue(L, index);
    lua_pushboolean(L, 1);
    lua_rawset(L, 3);
    lua_pushvalue(L, index);
    lua_rawseti(L, 5, ++left_);
  }

  void run() {
    luaL_checkstack(L, 16, nullptr);
    while (left_ > 0) {
      lua_rawgeti(L, 5, left_);
      lua_pushnil(L);
      lua_rawseti(L, 5, left_--);
      lua_newtable(L);
      if (lua_istable(L, 6))
        table();
      else
        function();
      if (!lua_isnil(L, 2)) {
        lua_rawseti(L, 2, kept_ + 2);
        lua_rawseti(L, 2, kept_ + 1);
        kept_ += 2;
      }
      lua_settop(L, 5);
    }
  }

 private:
  void table() {
    lua_Integer n = 0;
    if (lua_getmetatable(L, 6) != 0)
      visit(-1);
    else
      lua_pushboolean(L, 0);
    lua_rawseti(L, 7, ++n);
    lua_pushnil(L);
    while (lua_next(L, 6) != 0) {
      visit(-2);
      visit(-1);
      lua_pushvalue(L, -2);
      lua_rawseti(L, 7, ++n);
      lua_rawseti(L, 7, ++n);
    }
  }
  void function() {
    for (int i = 1; lua_getupvalue(L, 6, i) != nullptr; ++i) {
      visit(-1);
      if (lua_isnil(L, -1)) {
        lua_pop(L, 1);
        lua_pushlightuserdata(L, &no_value);
      }
      lua_rawseti(L, 7, i);
    }
  }
  void check_thread(int index) {
    lua_State* const thread = lua_tothread(L, index);
    if (lua_status(thread) == LUA_OK && lua_gettop(thread) == 0) return;  // it has ended
    luaL_error(L, "it holds a coroutine that has not come to its end, which cannot be copied");
  }

  lua_State* L;
  lua_Integer left_ = 0;
  lua_Integer kept_ = 0;
};

struct Setup {
  const std::vector<hal::ListedDevice>* devices;
};
struct Begin {
  Variables made;
};
struct Keep {
  const Variables* variables;
  int kept;
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

class Interpreter::Call {
 public:
  explicit Call(Interpreter& in) : in_(in) {
    in.running_ = in.state_;
    in.disarm();
    in.turns_.fetch_add(1, std::memory_order_relaxed);
    stepping = &in;
    const std::lock_guard hold(in.busy_lock_);
    in.thread_ = pthread_self();
    in.busy_ = true;
  }
  ~Call() {
    {
      const std::lock_guard hold(in_.busy_lock_);
      in_.busy_ = false;
    }
    stepping = nullptr;
    lua_sethook(in_.state_, nullptr, 0, 0);
    in_.actor_ = nullptr;
    in_.variables_ = nullptr;
    in_.filling_ = false;
    lua_settop(in_.state_, 0);
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

 private:
  Interpreter& in_;
};

void Interpreter::look() noexcept {
  const std::lock_guard hold(busy_lock_);
  const std::uint64_t turns = turns_.load(std::memory_order_relaxed);
  if (busy_ && turns == turns_seen_) pthread_kill(thread_, watchdog_signal());
  turns_seen_ = turns;
}

void Interpreter::on_signal(int) noexcept {
  Interpreter* const in = stepping;
  if (in == nullptr) return;
  in->armed_.store(true, std::memory_order_relaxed);
  lua_sethook(in->running_, &count, LUA_MASKCOUNT, in->overtime_ ? 1 : kCountedAtOnce);
}

void Interpreter::count(lua_State* L, lua_Debug*) {
  Interpreter& in = of(L);
  if (!in.armed_.load(std::memory_order_relaxed)) return lua_sethook(L, nullptr, 0, 0);  // a coroutine of another turn
  if (!in.overtime_) {
    in.counted_ += kCountedAtOnce;
    if (in.counted_ < in.script_->most_instructions) return;
    in.overtime_ = true;
  }
  lua_sethook(L, &count, LUA_MASKCOUNT, 1);  // so that no pcall of the script goes on
  luaL_where(L, 0);
  in.no_end(L);
}

/// Raises the error with the place that is on the top.
int Interpreter::no_end(lua_State* L) {
  lua_pushfstring(L,
                  "it does not come to an end: %I instructions were not enough; the parameter most_instructions "
                  "allows more",
                  static_cast<LUAI_UACINT>(script_->most_instructions));
  lua_concat(L, 2);
  return lua_error(L);
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
    const std::string near = hal::closest(text.substr(begin, text.find('\'', begin) - begin), shared_names());
    if (!near.empty()) text += "; there is '" + near + "'";
  }
  if (text == "not enough memory")
    text += ": all scripts of an interpreter share " + std::to_string(Memory::kMost >> 20U) + " MiB";
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
  lua_rawgeti(state_, LUA_REGISTRYINDEX, pristine_);
  for (lua_Integer i = 1; lua_rawgeti(state_, 1, i) == LUA_TTABLE; ++i) {
    take();
    lua_settop(state_, 1);
  }
  lua_settop(state_, 0);
  lua_rawgeti(state_, LUA_REGISTRYINDEX, common_);
  lua_pushliteral(state_, "robot");
  if (lua_rawget(state_, 1) == LUA_TTABLE) {
    for (const char* const table : {"sensors", "actuators"}) {
      lua_pushstring(state_, table);
      if (lua_rawget(state_, 2) == LUA_TTABLE) take();
      lua_settop(state_, 2);
    }
  }
  lua_settop(state_, 0);
  return names;
}

void Interpreter::protect(lua_CFunction function, void* argument) {
  lua_settop(state_, 0);
  lua_pushcfunction(state_, function);
  lua_pushlightuserdata(state_, argument);
  if (lua_pcall(state_, 1, 0, 0) != LUA_OK) throw std::runtime_error(taken_message());
}

// --- making ---

Interpreter::Interpreter(std::shared_ptr<const Script> script, const hal::RobotKind& kind,
                         const std::vector<hal::ListedDevice>& devices)
    : script_(std::move(script)), kind_(kind) {
  static std::once_flag once;
  std::call_once(once, [] {
    struct sigaction action {};
    action.sa_handler = &on_signal;
    action.sa_flags = SA_RESTART | SA_ONSTACK;
    sigemptyset(&action.sa_mask);
    sigaction(watchdog_signal(), &action, nullptr);
  });
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
  *static_cast<Interpreter**>(lua_getextraspace(state_)) = this;
  try {
    const Call call(*this);
    protect(&protected_setup, nullptr);
  } catch (...) {
    lua_close(state_);
    throw;
  }
  watch(*this);
}

Interpreter::~Interpreter() {
  unwatch(*this);
  lua_close(state_);
}

int Interpreter::protected_setup(lua_State* L) {
  lua_settop(L, 0);
  of(L).filling_ = true;  // shared tables take what is put into them
  of(L).setup(L);
  return 0;
}

bool Interpreter::compile(lua_State* L, std::string_view text, const char* name) noexcept {
  Source source{without_marks(text)};
  return lua_load(L, &Source::read, &source, name, "t") == LUA_OK;
}

void Interpreter::make_shared(lua_State* L) noexcept {
  lua_rawgeti(L, LUA_REGISTRYINDEX, shared_meta_);
  lua_setmetatable(L, -2);
}

void Interpreter::setup(lua_State* L) {
  const auto meta = [L](lua_CFunction index, lua_CFunction newindex) {
    lua_newtable(L);
    lua_pushcfunction(L, index);
    lua_setfield(L, -2, "__index");
    lua_pushcfunction(L, newindex);
    lua_setfield(L, -2, "__newindex");
    lua_pushboolean(L, 0);
    lua_setfield(L, -2, "__metatable");
  };
  meta(&shared_index, &shared_newindex);
  shared_meta_ = luaL_ref(L, LUA_REGISTRYINDEX);

  lua_newtable(L);  // 1: what all robots have
  open_libraries(L, *this);
  lua_newtable(L);  // 2: robot
  open_random(L);
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    const DeviceApi* const api = devices_[i].api;
    if (api == nullptr) continue;
    lua_getfield(L, 2, api->table);
    if (!lua_istable(L, -1)) {
      lua_pop(L, 1);
      lua_newtable(L);
      lua_pushvalue(L, -1);
      lua_setfield(L, 2, api->table);
    }
    lua_pushvalue(L, -1);
    devices_[i].table = luaL_ref(L, LUA_REGISTRYINDEX);
    if (api->open != nullptr) api->open(L, *this, i);
    lua_settop(L, 3);
    make_shared(L);
    lua_settop(L, 2);
  }
  open_ports(L, *this);
  meta(&robot_index, &shared_newindex);
  lua_setmetatable(L, 2);
  lua_setfield(L, 1, "robot");

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

  if (script_->strict) {
    lua_newtable(L);
    lua_pushcfunction(L, &unknown_global);
    lua_setfield(L, -2, "__index");
    lua_setmetatable(L, 1);
  }
  // Names that the script uses are put into each robot's globals: found there, they cost the least.
  lua_newtable(L);
  lua_pushnil(L);
  while (lua_next(L, 1) != 0) {
    if (lua_type(L, -2) == LUA_TSTRING && mentions(script_->text(), lua_tostring(L, -2))) {
      lua_pushvalue(L, -2);
      lua_insert(L, -2);
      lua_rawset(L, 2);
    } else {
      lua_pop(L, 1);
    }
  }
  direct_ = luaL_ref(L, LUA_REGISTRYINDEX);

  lua_newtable(L);
  lua_pushvalue(L, 1);
  lua_setfield(L, -2, "__index");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  globals_meta_ = luaL_ref(L, LUA_REGISTRYINDEX);

  if (!compile(L, script_->text(), ("@" + script_->path).c_str())) lua_error(L);
  chunk_ = luaL_ref(L, LUA_REGISTRYINDEX);

  // Functions of shared tables, to notice when one is replaced.
  lua_newtable(L);                                                   // 2
  const auto remember = [L](const char* prefix, const char* name) {  // the table on the top, which stays there
    lua_newtable(L);
    lua_pushnil(L);
    while (lua_next(L, -3) != 0) {
      if (lua_isfunction(L, -1)) {
        lua_pushvalue(L, -2);
        lua_insert(L, -2);
        lua_rawset(L, -4);
      } else {
        lua_pop(L, 1);
      }
    }
    lua_pushvalue(L, -2);
    lua_rawseti(L, -2, 0);  // the table itself
    lua_pushfstring(L, "%s%s", prefix, name);
    lua_rawseti(L, -2, 1);
    lua_rawseti(L, 2, static_cast<lua_Integer>(lua_rawlen(L, 2)) + 1);
  };
  for (const char* const library : {"math", "string", "table", "coroutine", "utf8", "os", "debug"}) {
    lua_getfield(L, 1, library);
    remember("", library);
    make_shared(L);
    lua_settop(L, 2);
  }
  lua_getfield(L, 1, "robot");
  lua_pushnil(L);
  while (lua_next(L, 3) != 0) {
    if (lua_istable(L, -1)) remember("robot.", lua_tostring(L, -2));
    lua_settop(L, 4);
  }
  lua_settop(L, 2);
  pristine_ = luaL_ref(L, LUA_REGISTRYINDEX);

  common_ = luaL_ref(L, LUA_REGISTRYINDEX);
  // All that there is now is shared: no robot's state.
  lua_settop(L, 0);
  lua_pushnil(L);
  lua_pushnil(L);
  lua_newtable(L);
  lua_newtable(L);
  lua_newtable(L);
  Walk walk(L);
  for (const int root : {common_, direct_, globals_meta_, shared_meta_, pristine_, chunk_}) {
    lua_rawgeti(L, LUA_REGISTRYINDEX, root);
    walk.visit(-1);
    lua_settop(L, 5);
  }
  lua_pushliteral(L, "");
  if (lua_getmetatable(L, -1) != 0) walk.visit(-1);
  lua_settop(L, 5);
  walk.run();
  lua_settop(L, 3);
  shared_ = luaL_ref(L, LUA_REGISTRYINDEX);
}

void Interpreter::check_shared(lua_State* L) {
  const int top = lua_gettop(L);
  lua_rawgeti(L, LUA_REGISTRYINDEX, pristine_);
  const auto count = static_cast<lua_Integer>(lua_rawlen(L, -1));
  for (lua_Integer i = 1; i <= count; ++i) {
    lua_rawgeti(L, top + 1, i);
    lua_rawgeti(L, -1, 0);
    lua_pushnil(L);
    while (lua_next(L, top + 2) != 0) {
      if (lua_type(L, -2) == LUA_TSTRING) {
        lua_pushvalue(L, -2);
        lua_rawget(L, top + 3);
        if (lua_rawequal(L, -1, -2) == 0) {
          lua_pushvalue(L, -3);  // for the robots that follow
          lua_pushvalue(L, -3);
          lua_rawset(L, top + 3);
          lua_rawgeti(L, top + 2, 1);
          luaL_error(L, "the script replaces %s.%s, which all robots share; give its function a name of its own",
                     lua_tostring(L, -1), lua_tostring(L, -4));
        }
        lua_pop(L, 1);
      }
      lua_pop(L, 1);
    }
    lua_settop(L, top + 1);
  }
  lua_settop(L, top);
}

// --- robots ---

int Interpreter::protected_begin(lua_State* L) {
  Interpreter& in = of(L);
  Begin& begin = *static_cast<Begin*>(lua_touserdata(L, 1));
  lua_newtable(L);  // 2: globals
  lua_pushvalue(L, 2);
  begin.made.globals = luaL_ref(L, LUA_REGISTRYINDEX);
  lua_rawgeti(L, LUA_REGISTRYINDEX, in.direct_);
  lua_pushnil(L);
  while (lua_next(L, 3) != 0) {
    lua_pushvalue(L, -2);
    lua_insert(L, -2);
    lua_rawset(L, 2);
  }
  lua_settop(L, 2);
  lua_pushvalue(L, 2);
  lua_setfield(L, 2, "_G");
  lua_rawgeti(L, LUA_REGISTRYINDEX, in.globals_meta_);
  lua_setmetatable(L, 2);

  lua_createtable(L, 0, 4);  // 3: what is its own besides
  lua_newtable(L);
  lua_setfield(L, 3, "added");
  lua_newtable(L);
  lua_setfield(L, 3, "loaded");
  lua_newtable(L);
  for (const hal::NamedText& param : in.script_->params) {
    lua_pushlstring(L, param.value.data(), param.value.size());
    lua_setfield(L, -2, param.name.c_str());
  }
  lua_setfield(L, 3, "params");
  begin.made.own = luaL_ref(L, LUA_REGISTRYINDEX);

  in.variables_ = &begin.made;
  in.fill(L);
  lua_rawgeti(L, LUA_REGISTRYINDEX, in.chunk_);
  lua_pushvalue(L, 2);
  lua_call(L, 1, 0);
  in.check_shared(L);
  lua_settop(L, 2);
  lua_pushliteral(L, "step");
  if (lua_rawget(L, 2) != LUA_TFUNCTION)
    luaL_error(L, "%s has no function step(), which is called in every step", in.script_->path.c_str());
  lua_pushliteral(L, "init");
  if (lua_rawget(L, 2) == LUA_TFUNCTION) {
    lua_call(L, 0, 0);
    in.check_shared(L);
  }
  return 0;
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

void Interpreter::end(const Variables& variables) noexcept {
  luaL_unref(state_, LUA_REGISTRYINDEX, variables.globals);
  luaL_unref(state_, LUA_REGISTRYINDEX, variables.own);
}

bool Interpreter::has(const Variables& variables, const char* function) {
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

bool Interpreter::call(Actor& actor, const Variables& variables, const char* function) {
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
        if (f.found) lua_call(L, 0, 0);
        return 0;
      },
      &asked);
  return asked.found;
}

/// Another robot's turn begins: it has all its instructions.
void Interpreter::disarm() noexcept {
  lua_sethook(state_, nullptr, 0, 0);
  armed_.store(false, std::memory_order_relaxed);
  overtime_ = false;
  counted_ = 0;
}

void Interpreter::fill(lua_State* L) {
  filling_ = true;
  for (const std::size_t i : filled_) devices_[i].api->fill(L, *this, i, actor_->ports[i]);
  filling_ = false;
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
    in.turns_.store(in.turns_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    if (in.armed_.load(std::memory_order_relaxed)) in.disarm();
    in.fill(L);
    lua_rawgeti(L, LUA_REGISTRYINDEX, turn.variables->globals);
    lua_pushvalue(L, 2);
    lua_rawget(L, -2);
    lua_call(L, 0, 0);
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
  return taken_message();
}

// --- copies ---

int Interpreter::protected_keep(lua_State* L) {
  Interpreter& in = of(L);
  Keep& keep = *static_cast<Keep*>(lua_touserdata(L, 1));
  lua_newtable(L);  // 2: what is kept
  lua_newtable(L);  // 3: what was seen
  lua_rawgeti(L, LUA_REGISTRYINDEX, in.shared_);
  lua_newtable(L);  // 5: what is to be looked at
  Walk walk(L);
  for (const int root : {keep.variables->globals, keep.variables->own}) {
    lua_rawgeti(L, LUA_REGISTRYINDEX, root);
    walk.visit(-1);
    lua_settop(L, 5);
  }
  walk.run();
  lua_settop(L, 2);
  keep.kept = luaL_ref(L, LUA_REGISTRYINDEX);
  return 0;
}

int Interpreter::keep(const Variables& variables) {
  const Call call(*this);
  Keep keep{&variables, LUA_NOREF};
  protect(&protected_keep, &keep);
  return keep.kept;
}

int Interpreter::protected_put_back(lua_State* L) {
  lua_rawgeti(L, LUA_REGISTRYINDEX, *static_cast<const int*>(lua_touserdata(L, 1)));
  const auto count = static_cast<lua_Integer>(lua_rawlen(L, 2));
  for (lua_Integer i = 1; i < count; i += 2) {
    lua_rawgeti(L, 2, i);      // 3: table or function
    lua_rawgeti(L, 2, i + 1);  // 4: what it held
    const auto held = static_cast<lua_Integer>(lua_rawlen(L, 4));
    if (lua_istable(L, 3)) {
      lua_pushnil(L);
      while (lua_next(L, 3) != 0) {
        lua_pop(L, 1);
        lua_pushvalue(L, -1);
        lua_pushnil(L);
        lua_rawset(L, 3);
      }
      lua_rawgeti(L, 4, 1);
      if (!lua_istable(L, -1)) lua_pushnil(L);
      lua_setmetatable(L, 3);
      lua_settop(L, 4);
      for (lua_Integer k = 2; k < held; k += 2) {
        lua_rawgeti(L, 4, k);
        lua_rawgeti(L, 4, k + 1);
        lua_rawset(L, 3);
      }
    } else {
      for (lua_Integer k = 1; k <= held; ++k) {
        lua_rawgeti(L, 4, k);
        if (lua_touserdata(L, -1) == &no_value) {
          lua_pop(L, 1);
          lua_pushnil(L);
        }
        lua_setupvalue(L, 3, static_cast<int>(k));
      }
    }
    lua_settop(L, 2);
  }
  return 0;
}

void Interpreter::put_back(int kept) {
  const Call call(*this);
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
