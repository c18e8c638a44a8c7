// robot.sensors and robot.actuators: every port that the configuration lists, by the names and units that the port
// itself tells (`tandem describe`), whatever ARGoS calls it. A field of many scalars is indexed from 1.
#include <cmath>
#include <cstring>

#include "controllers/lua_controller/devices.hpp"

namespace tandem::controllers::lua {
namespace {

/// What a port, or a field of many scalars, is to a script.
struct Reference {
  std::size_t device = 0;
  std::size_t field = 0;
};

constexpr const char* kPort = "tandem.port";
constexpr const char* kField = "tandem.field";

void* memory_of(lua_State* L, std::size_t device) {
  return Interpreter::of(L).actor().ports[device];
}

void push_scalar(lua_State* L, const void* row, const hal::Field& field, std::size_t index) {
  const double value = hal::get_value(row, field, index);
  switch (field.scalar) {
    case hal::Scalar::Bool:
      lua_pushboolean(L, value != 0.0 ? 1 : 0);
      break;
    case hal::Scalar::F32:
    case hal::Scalar::F64:
      lua_pushnumber(L, value);
      break;
    default:
      lua_pushinteger(L, static_cast<lua_Integer>(value));
  }
}

struct Limits {
  double least, most;
};
Limits limits_of(hal::Scalar scalar) noexcept {
  switch (scalar) {
    case hal::Scalar::U8:
      return {0.0, 255.0};
    case hal::Scalar::U16:
      return {0.0, 65535.0};
    case hal::Scalar::U32:
      return {0.0, 4294967295.0};
    case hal::Scalar::I32:
      return {-2147483648.0, 2147483647.0};
    default:
      return {-9007199254740992.0, 9007199254740992.0};
  }
}

const char* name_of(lua_State* L, const Device& device, const hal::Field& field) {
  return lua_pushfstring(L, "robot.%s.%s.%s", device.type->role == hal::Role::Sensor ? "sensors" : "actuators",
                         device.type->name.data(), field.name.data());
}

int set_scalar(lua_State* L, const Reference& at, const hal::Field& field, std::size_t index, int value) {
  const Device& device = Interpreter::of(L).device(at.device);
  double number = 0.0;
  if (field.scalar == hal::Scalar::Bool) {
    if (!lua_isboolean(L, value))
      return luaL_error(L, "%s is true or false, not a %s", name_of(L, device, field), luaL_typename(L, value));
    number = lua_toboolean(L, value);
  } else {
    if (lua_type(L, value) != LUA_TNUMBER)
      return luaL_error(L, "%s is a number, not a %s", name_of(L, device, field), luaL_typename(L, value));
    number = lua_tonumber(L, value);
    if (field.scalar != hal::Scalar::F32 && field.scalar != hal::Scalar::F64) {
      const Limits limits = limits_of(field.scalar);
      if (!(number >= limits.least && number <= limits.most) || number != std::floor(number))
        return luaL_error(L, "%s is a whole number from %f to %f, not %f", name_of(L, device, field), limits.least,
                          limits.most, number);
    }
  }
  hal::set_value(memory_of(L, at.device), field, index, number);
  return 0;
}

/// Which scalar the script means; raises an error when it is not in use.
std::size_t index_at(lua_State* L, const Reference& at, const hal::Field& field) {
  const Device& device = Interpreter::of(L).device(at.device);
  const bool sensor = device.type->role == hal::Role::Sensor;
  const std::size_t most = sensor ? hal::used_count(*device.type, memory_of(L, at.device), field) : field.count;
  const lua_Integer index = luaL_checkinteger(L, 2);
  if (index < 1 || index > static_cast<lua_Integer>(most)) {
    if (sensor) return field.count;
    luaL_error(L, "%s has the indices 1 to %d, not %I", name_of(L, device, field), static_cast<int>(most),
               static_cast<LUAI_UACINT>(index));
  }
  return static_cast<std::size_t>(index - 1);
}

const hal::Field& field_of(lua_State* L, const Reference& at) {
  return Interpreter::of(L).device(at.device).type->fields[at.field];
}

int field_index(lua_State* L) {
  const auto& at = *static_cast<const Reference*>(luaL_checkudata(L, 1, kField));
  const hal::Field& field = field_of(L, at);
  const std::size_t index = index_at(L, at, field);
  if (index == field.count) return 0;  // as beyond the end of a list
  push_scalar(L, memory_of(L, at.device), field, index);
  return 1;
}

int field_newindex(lua_State* L) {
  const auto& at = *static_cast<const Reference*>(luaL_checkudata(L, 1, kField));
  const hal::Field& field = field_of(L, at);
  if (Interpreter::of(L).device(at.device).type->role == hal::Role::Sensor)
    return luaL_error(L, "%s is a reading: it cannot be set", name_of(L, Interpreter::of(L).device(at.device), field));
  return set_scalar(L, at, field, index_at(L, at, field), 3);
}

int field_length(lua_State* L) {
  const auto& at = *static_cast<const Reference*>(luaL_checkudata(L, 1, kField));
  const Device& device = Interpreter::of(L).device(at.device);
  const hal::Field& field = field_of(L, at);
  lua_pushinteger(L, static_cast<lua_Integer>(device.type->role == hal::Role::Sensor
                                                  ? hal::used_count(*device.type, memory_of(L, at.device), field)
                                                  : field.count));
  return 1;
}

/// Pushes what the port has under the key at 2: the number of a scalar, or a field. Raises an error when it has none.
int push_member(lua_State* L, const Reference& at) {
  lua_getiuservalue(L, 1, 1);
  lua_pushvalue(L, 2);
  if (const int type = lua_rawget(L, -2); type != LUA_TNIL) return type;
  const Device& device = Interpreter::of(L).device(at.device);
  luaL_Buffer names;
  luaL_buffinit(L, &names);
  for (std::size_t i = 0; i < device.type->fields.size(); ++i) {
    if (i > 0) luaL_addstring(&names, ", ");
    luaL_addlstring(&names, device.type->fields[i].name.data(), device.type->fields[i].name.size());
  }
  luaL_pushresult(&names);
  const char* const all = lua_tostring(L, -1);
  push_text(L, 2);
  return luaL_error(L, "the %s %s has no field '%s'; it has: %s",
                    device.type->role == hal::Role::Sensor ? "sensor" : "actuator", device.type->name.data(),
                    lua_tostring(L, -1), all);
}

int port_index(lua_State* L) {
  const auto& at = *static_cast<const Reference*>(luaL_checkudata(L, 1, kPort));
  if (push_member(L, at) != LUA_TNUMBER) return 1;
  const auto field = static_cast<std::size_t>(lua_tointeger(L, -1));
  push_scalar(L, memory_of(L, at.device), Interpreter::of(L).device(at.device).type->fields[field], 0);
  return 1;
}

int port_newindex(lua_State* L) {
  const auto& at = *static_cast<const Reference*>(luaL_checkudata(L, 1, kPort));
  const int type = push_member(L, at);
  const Device& device = Interpreter::of(L).device(at.device);
  if (device.type->role == hal::Role::Sensor) {
    push_text(L, 2);
    return luaL_error(L, "robot.sensors.%s.%s is a reading: it cannot be set", device.type->name.data(),
                      lua_tostring(L, -1));
  }
  if (type == LUA_TNUMBER)
    return set_scalar(L, at, device.type->fields[static_cast<std::size_t>(lua_tointeger(L, -1))], 0, 3);
  const Reference list = *static_cast<const Reference*>(lua_touserdata(L, -1));  // a whole list at once
  const hal::Field& field = field_of(L, list);
  if (!lua_istable(L, 3))
    return luaL_error(L, "%s is a list, not a %s", name_of(L, device, field), luaL_typename(L, 3));
  const auto count = static_cast<std::size_t>(lua_rawlen(L, 3));
  if (count > field.count)
    return luaL_error(L, "%s has %d values at most, not %d", name_of(L, device, field), static_cast<int>(field.count),
                      static_cast<int>(count));
  for (std::size_t i = 0; i < count; ++i) {
    lua_rawgeti(L, 3, static_cast<lua_Integer>(i) + 1);
    set_scalar(L, list, field, i, lua_gettop(L));
    lua_pop(L, 1);
  }
  return 0;
}

void make_class(lua_State* L, const char* name, lua_CFunction index, lua_CFunction newindex, lua_CFunction length) {
  luaL_newmetatable(L, name);
  lua_pushcfunction(L, index);
  lua_setfield(L, -2, "__index");
  lua_pushcfunction(L, newindex);
  lua_setfield(L, -2, "__newindex");
  if (length != nullptr) {
    lua_pushcfunction(L, length);
    lua_setfield(L, -2, "__len");
  }
  lua_pushboolean(L, 0);
  lua_setfield(L, -2, "__metatable");
  lua_pop(L, 1);
}

void push_reference(lua_State* L, const char* name, std::size_t device, std::size_t field, int values) {
  *static_cast<Reference*>(lua_newuserdatauv(L, sizeof(Reference), values)) = Reference{device, field};
  luaL_setmetatable(L, name);
}

}  // namespace

void open_ports(lua_State* L, Interpreter& in) {
  make_class(L, kPort, &port_index, &port_newindex, nullptr);
  make_class(L, kField, &field_index, &field_newindex, &field_length);
  for (const hal::Role role : {hal::Role::Sensor, hal::Role::Actuator}) {
    lua_newtable(L);
    for (std::size_t i = 0; i < in.devices().size(); ++i) {
      const hal::PortType& type = *in.devices()[i].type;
      if (type.role != role) continue;
      push_reference(L, kPort, i, 0, 1);
      lua_createtable(L, 0, static_cast<int>(type.fields.size()));
      for (std::size_t f = 0; f < type.fields.size(); ++f) {
        lua_pushlstring(L, type.fields[f].name.data(), type.fields[f].name.size());
        if (type.fields[f].count == 1)
          lua_pushinteger(L, static_cast<lua_Integer>(f));
        else
          push_reference(L, kField, i, f, 0);
        lua_rawset(L, -3);
      }
      lua_setiuservalue(L, -2, 1);
      lua_setfield(L, -2, type.plain_name().data());
    }
    lua_setfield(L, -2, role == hal::Role::Sensor ? "sensors" : "actuators");
  }
}

}  // namespace tandem::controllers::lua
