// Numbers of scripts: elementary functions with the same bits everywhere, and random numbers from the robot's own.
#include <cmath>
#include <cstring>

#include "controllers/lua_controller/devices.hpp"
#include "hal/elementary.hpp"
#include "hal/poisson.hpp"

namespace tandem::controllers::lua {
namespace {

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

bool of_argos(lua_State* L) {
  return Interpreter::of(L).script().argos;
}

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
  const std::int64_t drawn = random_of(L).integer(static_cast<std::int64_t>(low), static_cast<std::int64_t>(high) - 1);
  if (of_argos(L))
    lua_pushnumber(L, static_cast<double>(drawn));
  else
    lua_pushinteger(L, drawn);
  return 1;
}

int bernoulli(lua_State* L) {
  if (lua_gettop(L) > 1) return luaL_error(L, "robot.random.bernoulli() expects 0 or 1 arguments");
  const bool drawn = random_of(L).chance(luaL_optnumber(L, 1, 0.5));
  if (of_argos(L))
    lua_pushboolean(L, drawn ? 1 : 0);
  else
    lua_pushinteger(L, drawn ? 1 : 0);
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

int poisson(lua_State* L) {
  expect_arguments(L, 1, "robot.random.poisson(mean)");
  const double mean = luaL_checknumber(L, 1);
  luaL_argcheck(L, mean >= 0.0 && mean <= 1e6, 1, "a mean is from 0 to 1e6");
  Interpreter::of(L).spend(L, static_cast<std::int64_t>(mean));
  lua_pushinteger(L, hal::poisson(random_of(L), mean));
  return 1;
}

constexpr luaL_Reg kMath[] = {{"sin", &of_one<hal::sin>},
                              {"cos", &of_one<hal::cos>},
                              {"tan", &of_one<hal::tan>},
                              {"asin", &of_one<asin_of>},
                              {"acos", &of_one<acos_of>},
                              {"atan", &math_atan},
                              {"atan2", &math_atan},
                              {"exp", &of_one<hal::exp>},
                              {"log", &math_log},
                              {"log10", &of_one<log10_of>},
                              {"pow", &math_pow},
                              {"random", &math_random},
                              {"randomseed", &math_randomseed},
                              {nullptr, nullptr}};

constexpr luaL_Reg kRandom[] = {{"uniform", &uniform},   {"uniform_int", &uniform_int}, {"bernoulli", &bernoulli},
                                {"gaussian", &gaussian}, {"exponential", &exponential}, {"poisson", &poisson},
                                {nullptr, nullptr}};

}  // namespace

void open_math(lua_State* L) {
  luaL_setfuncs(L, kMath, 0);
}

void open_random(lua_State* L) {
  lua_newtable(L);
  luaL_setfuncs(L, kRandom, 0);
  lua_setfield(L, -2, "random");
}

}  // namespace tandem::controllers::lua

// What Lua's own operator ^ calls, by the linker's option --wrap.
extern "C" {
double __wrap_pow(double base, double exponent);
double __wrap_pow(double base, double exponent) {
  return tandem::controllers::lua::power(base, exponent);
}
}
