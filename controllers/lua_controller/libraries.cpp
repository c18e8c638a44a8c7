// The libraries that scripts have. What would differ between runs or machines is replaced or left out: the order of
// pairs, elementary functions, random numbers, clocks, addresses in texts, files. What can take long counts its steps.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "controllers/lua_controller/devices.hpp"
#include "controllers/lua_controller/own_tables.hpp"
#include "controllers/lua_controller/patterns.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/elementary.hpp"

namespace tandem::controllers::lua {
namespace {

// --- numbers ---

double sin_of(double x) noexcept {
  return hal::sin(x);
}
double cos_of(double x) noexcept {
  return hal::cos(x);
}
double tan_of(double x) noexcept {
  return hal::tan(x);
}
double exp_of(double x) noexcept {
  return hal::exp(x);
}
double asin_of(double x) noexcept {
  return hal::atan2(x, std::sqrt((1.0 - x) * (1.0 + x)));
}
double acos_of(double x) noexcept {
  return hal::atan2(std::sqrt((1.0 - x) * (1.0 + x)), x);
}
double log10_of(double x) noexcept {
  return hal::log(x) / 0x1.26bb1bbb55516p+1;
}

/// The power that the operator ^ is. Whole exponents by squaring, so that what can be exact is.
double power(double base, double exponent) noexcept {
  if (exponent == 0.0 || base == 1.0) return 1.0;
  if (exponent == 0.5 && base >= 0.0) return std::sqrt(base);
  const bool whole = exponent == std::floor(exponent);
  if (whole && std::fabs(exponent) <= 1024.0) {
    double result = 1.0;
    double factor = base;
    for (auto left = static_cast<unsigned>(std::fabs(exponent)); left != 0; left >>= 1U) {
      if ((left & 1U) != 0) result *= factor;
      factor *= factor;
    }
    return exponent < 0.0 ? 1.0 / result : result;
  }
  if (base < 0.0 && whole) {
    const double size = hal::pow(-base, exponent);
    return std::fmod(exponent, 2.0) != 0.0 ? -size : size;
  }
  return hal::pow(base, exponent);
}

template <double (*function)(double) noexcept>
int of_one(lua_State* L) {
  lua_pushnumber(L, function(luaL_checknumber(L, 1)));
  return 1;
}

int math_atan(lua_State* L) {
  lua_pushnumber(L, hal::atan2(luaL_checknumber(L, 1), luaL_optnumber(L, 2, 1.0)));
  return 1;
}

int math_log(lua_State* L) {
  const double x = luaL_checknumber(L, 1);
  if (lua_isnoneornil(L, 2)) {
    lua_pushnumber(L, hal::log(x));
    return 1;
  }
  const double base = luaL_checknumber(L, 2);
  int exponent = 0;
  if (base == 2.0 && std::frexp(x, &exponent) == 0.5)
    lua_pushnumber(L, exponent - 1);
  else
    lua_pushnumber(L, base == 10.0 ? log10_of(x) : hal::log(x) / hal::log(base));
  return 1;
}

int math_pow(lua_State* L) {
  lua_pushnumber(L, power(luaL_checknumber(L, 1), luaL_checknumber(L, 2)));
  return 1;
}

hal::Random& random_of(lua_State* L) {
  return Interpreter::of(L).actor().random;
}

int math_random(lua_State* L) {
  hal::Random& random = random_of(L);
  lua_Integer low = 1;
  lua_Integer high = 0;
  switch (lua_gettop(L)) {
    case 0:
      lua_pushnumber(L, random.uniform());
      return 1;
    case 1:
      high = luaL_checkinteger(L, 1);
      if (high == 0) {
        lua_pushinteger(L, static_cast<lua_Integer>(random()));
        return 1;
      }
      break;
    case 2:
      low = luaL_checkinteger(L, 1);
      high = luaL_checkinteger(L, 2);
      break;
    default:
      return luaL_error(L, "math.random() takes 0, 1 or 2 arguments");
  }
  luaL_argcheck(L, low <= high, lua_gettop(L), "interval is empty");
  lua_pushinteger(L, random.integer(low, high));
  return 1;
}

int math_randomseed(lua_State* L) {
  Actor& actor = Interpreter::of(L).actor();
  const double number = luaL_optnumber(L, 1, 0.0);
  std::uint64_t bits = 0;
  std::memcpy(&bits, &number, sizeof bits);
  actor.random = hal::Random(hal::seed_of(actor.run_seed ^ bits, actor.id), 1);
  return 0;
}

// --- robot.random ---

int uniform(lua_State* L) {
  const int count = lua_gettop(L);
  if (count > 2) return luaL_error(L, "robot.random.uniform() expects 0, 1, or 2 arguments");
  const double low = count == 2 ? luaL_checknumber(L, 1) : 0.0;
  const double high = count == 0 ? 1.0 : luaL_checknumber(L, count);
  lua_pushnumber(L, random_of(L).uniform(low, high));
  return 1;
}

int uniform_int(lua_State* L) {
  const int count = lua_gettop(L);
  if (count < 1 || count > 2) return luaL_error(L, "robot.random.uniform_int() expects 1 or 2 arguments");
  const double low = count == 2 ? std::floor(luaL_checknumber(L, 1)) : 0.0;
  const double high = std::floor(luaL_checknumber(L, count));
  luaL_argcheck(L, low < high && std::fabs(low) < 9e15 && std::fabs(high) < 9e15, count, "interval is empty");
  lua_pushinteger(L, random_of(L).integer(static_cast<std::int64_t>(low), static_cast<std::int64_t>(high) - 1));
  return 1;
}

int bernoulli(lua_State* L) {
  if (lua_gettop(L) > 1) return luaL_error(L, "robot.random.bernoulli() expects 0 or 1 arguments");
  lua_pushinteger(L, random_of(L).chance(luaL_optnumber(L, 1, 0.5)) ? 1 : 0);
  return 1;
}

int gaussian(lua_State* L) {
  const int count = lua_gettop(L);
  if (count != 1 && count != 2) return luaL_error(L, "robot.random.gaussian() expects 1 or 2 arguments");
  const double deviation = luaL_checknumber(L, 1);
  lua_pushnumber(L, random_of(L).normal(luaL_optnumber(L, 2, 0.0), deviation));
  return 1;
}

int exponential(lua_State* L) {
  expect_arguments(L, 1, "robot.random.exponential(mean)");
  lua_pushnumber(L, random_of(L).exponential(luaL_checknumber(L, 1)));
  return 1;
}

/// [Knuth, The Art of Computer Programming 2, 3.4.1], by parts that exp(-mean) can tell from 0.
int poisson(lua_State* L) {
  expect_arguments(L, 1, "robot.random.poisson(mean)");
  double mean = luaL_checknumber(L, 1);
  luaL_argcheck(L, mean >= 0.0 && mean <= 1e6, 1, "a mean is from 0 to 1e6");
  Interpreter::of(L).spend(L, static_cast<std::int64_t>(mean));
  lua_Integer events = 0;
  while (mean > 0.0) {
    const double part = std::min(mean, 30.0);
    mean -= part;
    const double least = hal::exp(-part);
    for (double product = random_of(L).uniform(); product > least; product *= random_of(L).uniform()) ++events;
  }
  lua_pushinteger(L, events);
  return 1;
}

// --- the order of tables ---

/// A key, as far as it has an order that is the same in every run: numbers, then texts, then truth values.
struct Key {
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
    default:
      key.rank = 3;
  }
  return key;
}

int no_order(lua_State* L) {
  return luaL_error(L,
                    "the table has keys that are tables or functions, which have no order that is the same in every "
                    "run; use numbers or texts as keys");
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
  Key* end = keys;
  int objects = 0;
  lua_pushnil(L);
  while (lua_next(L, table) != 0) {
    lua_pop(L, 1);
    *end = key_at(L, -1);
    if (end->rank == 3 && ++objects > 1) no_order(L);
    ++end;
  }
  std::sort(keys, end);
  lua_Integer n = 0;
  for (const Key* key = keys; key != end; ++key) {
    if (key->rank == 0 && key->whole) lua_pushinteger(L, key->integer);
    if (key->rank == 0 && !key->whole) lua_pushnumber(L, key->number);
    if (key->rank == 1) lua_pushlstring(L, key->text, key->size);
    if (key->rank == 2) lua_pushboolean(L, static_cast<int>(key->integer));
    if (key->rank == 3) {  // the only one
      lua_pushnil(L);
      while (lua_next(L, table) != 0) {
        lua_pop(L, 1);
        if (key_at(L, -1).rank == 3) break;
      }
    }
    lua_rawseti(L, memory + 1, ++n);
  }
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
  if (before.rank == 3) return 0;  // the last
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
    if (key.rank == 3 && ++objects > 1) no_order(L);
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

int set_metatable(lua_State* L) {
  luaL_checktype(L, 1, LUA_TTABLE);
  luaL_argexpected(L, lua_isnoneornil(L, 2) || lua_istable(L, 2), 2, "nil or table");
  lua_settop(L, 2);
  if (luaL_getmetafield(L, 1, "__metatable") != LUA_TNIL) return luaL_error(L, "cannot change a protected metatable");
  if (lua_istable(L, 2)) {
    for (const char* const field : {"__gc", "__mode"}) {
      lua_pushstring(L, field);
      if (lua_rawget(L, 2) != LUA_TNIL)
        return luaL_error(L, "a metatable with %s: when memory is collected is not the same in every run", field);
      lua_pop(L, 1);
    }
  }
  lua_settop(L, 2);
  lua_setmetatable(L, 1);
  return 1;
}

int collect_garbage(lua_State* L) {
  lua_pushinteger(L, 0);
  return 1;
}

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

int left_out(lua_State* L) {  // upvalue: the library's name
  push_text(L, 2);
  return luaL_error(L, "%s.%s is not there: what a robot does depends on its sensors and on its random numbers alone",
                    lua_tostring(L, lua_upvalueindex(1)), lua_tostring(L, -1));
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
    if (found) compiled = Interpreter::of(L).compile_for_all(L, text, path.c_str(), name);
  }
  if (!found) {
    lua_pop(L, 1);
    return Loaded::Missing;
  }
  lua_remove(L, -2);
  return compiled ? Loaded::Yes : Loaded::Wrong;
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
      return luaL_error(L, "dofile: there is no file '%s' beneath the folder of %s", name,
                        Interpreter::of(L).script().path.c_str());
    case Loaded::Wrong:
      return lua_error(L);
    case Loaded::Yes:
      break;
  }
  Interpreter::of(L).push_globals(L);
  lua_call(L, 1, LUA_MULTRET);
  return lua_gettop(L) - 1;
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

void set(lua_State* L, const char* name, lua_CFunction function) {
  lua_pushcfunction(L, function);
  lua_setfield(L, -2, name);
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

void open_random(lua_State* L) {
  lua_newtable(L);
  set(L, "uniform", &uniform);
  set(L, "uniform_int", &uniform_int);
  set(L, "bernoulli", &bernoulli);
  set(L, "gaussian", &gaussian);
  set(L, "exponential", &exponential);
  set(L, "poisson", &poisson);
  lua_setfield(L, -2, "random");
}

void open_libraries(lua_State* L, Interpreter&) {
  const int all = lua_gettop(L);
  lua_newtable(L);
  lua_setfield(L, LUA_REGISTRYINDEX, "tandem.files");

  luaL_requiref(L, "_G", luaopen_base, 0);
  for (const char* const name :
       {"assert", "error", "getmetatable", "ipairs", "pcall", "rawequal", "select", "tonumber", "type", "_VERSION"}) {
    lua_getfield(L, -1, name);
    lua_setfield(L, all, name);
  }
  lua_settop(L, all);
  set(L, "pairs", &pairs);
  set(L, "next", &next);
  set(L, "tostring", &tostring);
  set(L, "rawset", &raw_set);
  set(L, "rawget", &raw_get);
  set(L, "rawlen", &raw_length);
  set(L, "xpcall", &xpcall);
  set(L, "setmetatable", &set_metatable);
  set(L, "collectgarbage", &collect_garbage);
  set(L, "require", &require);
  set(L, "dofile", &do_file);
  set(L, "load", &load);
  set(L, "loadstring", &load);
  set(L, "log", &log_info);
  set(L, "logerr", &log_error);
  set(L, "print", &print);

  open(L, all, LUA_MATHLIBNAME, luaopen_math);
  set(L, "sin", &of_one<sin_of>);
  set(L, "cos", &of_one<cos_of>);
  set(L, "tan", &of_one<tan_of>);
  set(L, "asin", &of_one<asin_of>);
  set(L, "acos", &of_one<acos_of>);
  set(L, "atan", &math_atan);
  set(L, "atan2", &math_atan);
  set(L, "exp", &of_one<exp_of>);
  set(L, "log", &math_log);
  set(L, "log10", &of_one<log10_of>);
  set(L, "pow", &math_pow);
  set(L, "random", &math_random);
  set(L, "randomseed", &math_randomseed);
  take_away(L, {"cosh", "sinh", "tanh"});
  lua_settop(L, all);

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
  lua_settop(L, all);

  open(L, all, LUA_TABLIBNAME, luaopen_table);
  set(L, "sort", &sort);
  for (const char* const name : {"insert", "remove"}) count_steps<length_of_first>(L, name);
  count_steps<moved>(L, "move");
  count_steps<concatenated>(L, "concat");
  lua_getfield(L, -1, "unpack");
  lua_setfield(L, all, "unpack");
  lua_settop(L, all);

  open(L, all, LUA_COLIBNAME, luaopen_coroutine);
  set(L, "resume", &coroutine_resume);
  set(L, "wrap", &coroutine_wrap);
  lua_settop(L, all);
  open(L, all, LUA_UTF8LIBNAME, luaopen_utf8);
  for (const char* const name : {"len", "codepoint", "offset"}) count_steps<length_of_text>(L, name);
  lua_settop(L, all);

  lua_newtable(L);
  set(L, "traceback", &traceback);
  lua_setfield(L, all, "debug");
  for (const char* const library : {"os", "io"}) {
    lua_newtable(L);
    if (std::strcmp(library, "os") == 0) {
      set(L, "clock", &os_clock);
      set(L, "time", &os_time);
    }
    lua_setfield(L, all, library);
  }
  // What it lacks says why.
  lua_getfield(L, all, "io");
  lua_newtable(L);
  lua_pushliteral(L, "io");
  lua_pushcclosure(L, &left_out, 1);
  lua_setfield(L, -2, "__index");
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_setmetatable(L, -2);
  lua_settop(L, all);
}

}  // namespace tandem::controllers::lua

// What Lua's own code calls, by the linker's option --wrap: its operator ^, and the files of the process, which it
// refers to in functions that scripts do not have.
extern "C" {
double __wrap_pow(double base, double exponent);
double __wrap_pow(double base, double exponent) {
  return tandem::controllers::lua::power(base, exponent);
}
FILE* __wrap_stdin = nullptr;
FILE* __wrap_stdout = nullptr;
FILE* __wrap_stderr = nullptr;
}
