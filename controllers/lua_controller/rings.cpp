// Rings of sensors as ARGoS' scripts know them: a list of readings, counter-clockwise from forward.
#include "controllers/lua_controller/rings.hpp"

#include <span>
#include <string>
#include <vector>

#include "controllers/lua_controller/devices.hpp"
#include "controllers/lua_controller/own_tables.hpp"
#include "hal/device/argos_curves.hpp"
#include "hal/device/argos_readings.hpp"
#include "hal/device/ring_sensors.hpp"

namespace tandem::controllers::lua {
namespace {

/// The table becomes a ring of sensors, or a list of numbers where `member` is null. What the script changed in it is
/// put right with each filling, by a function in Lua: that is the fastest.
void open_ring(lua_State* L, Interpreter& in, std::size_t device, std::span<const hal::Mount> mounts, bool bare) {
  const int table = lua_gettop(L);
  Device& d = in.device(device);
  d.order = hal::argos::counter_clockwise(mounts);
  if (d.order.empty()) return;
  bool compiled = false;
  {
    std::string arguments, members, body;
    for (std::size_t i = 1; i <= d.order.size(); ++i) {
      const std::string n = std::to_string(i);
      const std::string comma = i > 1 ? "," : "";
      arguments += comma + "v" + n;
      members += comma + "s" + n;
      body +=
          bare ? "l[" + n + "]=v" + n + "\n" : "s=s" + n + " l[" + n + "]=s s.value=v" + n + " s.angle=a" + n + "\n";
    }
    std::string angles;
    for (std::size_t i = 1; i <= d.order.size(); ++i) angles += (i > 1 ? ",a" : "a") + std::to_string(i);
    const std::string text = bare
                                 ? "local l=_ENV return function(" + arguments + ")\nlocal l=l\n" + body + "end"
                                 : "local list=_ENV return function(" + members + ")\nreturn function(" + angles +
                                       ")\nreturn function(" + arguments + ")\nlocal l,s=list\n" + body + "end end end";
    compiled = in.compile(L, text, "=filler");
  }
  if (!compiled) lua_error(L);
  lua_pushvalue(L, table);
  lua_call(L, 1, 1);
  luaL_checkstack(L, 64, nullptr);
  const int count = static_cast<int>(d.order.size());
  if (!bare) {
    for (int i = 0; i < count; ++i) {
      lua_createtable(L, 0, 2);
      make_readings(L);
      lua_pushvalue(L, -1);
      lua_rawseti(L, table, i + 1);
    }
    lua_call(L, count, 1);
    for (int i = 0; i < count; ++i) {
      lua_pushnumber(L, hal::argos::signed_angle(mounts[d.order[static_cast<std::size_t>(i)]].bearing_rad));
    }
    lua_call(L, count, 1);
  }
  d.filler = luaL_ref(L, LUA_REGISTRYINDEX);
}

/// Hands the readings to the ring's function. `value(i)`: of Tandem's sensor i.
template <class Value>
void fill_ring(lua_State* L, Interpreter& in, std::size_t device, Value&& value) {
  const Device& d = in.device(device);
  if (d.order.empty()) return;
  const int count = static_cast<int>(d.order.size());
  luaL_checkstack(L, count + 8, nullptr);
  lua_rawgeti(L, LUA_REGISTRYINDEX, d.filler);
  for (const std::size_t i : d.order) lua_pushnumber(L, value(i));
  lua_call(L, count, 0);
}

void open_ring_of_part(lua_State* L, Interpreter& in, std::size_t device, std::span<const hal::Mount> mounts) {
  const std::string_view written = in.device(device).written;
  open_ring(L, in, device, mounts, written == "proximity" || written == "light");
}

}  // namespace

void open_proximity(lua_State* L, Interpreter& in, std::size_t device) {
  if (const auto* part = in.kind().part<hal::ProximityPart>()) open_ring_of_part(L, in, device, part->mounts);
}

void open_light(lua_State* L, Interpreter& in, std::size_t device) {
  if (const auto* part = in.kind().part<hal::LightPart>()) open_ring_of_part(L, in, device, part->mounts);
}

void fill_proximity(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& p = *static_cast<const hal::Proximity*>(port);
  hal::ArgosProximity curve = hal::argos_proximity(in.device(device).written);
  if (curve == hal::ArgosProximity::Epuck && !in.script().argos) curve = hal::ArgosProximity::Footbot;
  fill_ring(L, in, device, [&](std::size_t i) {
    const bool nothing = i >= p.count || p.distance_m[i] == p.range_m;  // farther: a reading that is noise alone
    return nothing ? 0.0 : hal::argos_reading(curve, static_cast<double>(p.distance_m[i]));
  });
}

void fill_light(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& light = *static_cast<const hal::Light*>(port);
  fill_ring(L, in, device, [&](std::size_t i) { return i < light.count ? static_cast<double>(light.level[i]) : 0.0; });
}

}  // namespace tandem::controllers::lua
