#include "controllers/lua_controller/devices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "controllers/lua_controller/own_tables.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"
#include "hal/elementary.hpp"

namespace tandem::controllers::lua {
namespace {

constexpr double kM_per_cm = 0.01;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// The port that a function acts on: its first upvalue is the device's number.
template <class Port>
Port& port_of(lua_State* L) {
  const auto device = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(1)));
  return *static_cast<Port*>(Interpreter::of(L).actor().ports[device]);
}

void add(lua_State* L, std::size_t device, const char* name, lua_CFunction function) {
  lua_pushinteger(L, static_cast<lua_Integer>(device));
  lua_pushcclosure(L, function, 1);
  lua_setfield(L, -2, name);
}

void set_number(lua_State* L, const char* name, double value) {
  lua_pushnumber(L, value);
  lua_setfield(L, -2, name);
}

void push_table(lua_State* L, Interpreter& in, std::size_t device) {
  lua_rawgeti(L, LUA_REGISTRYINDEX, in.device(device).table);
}

/// Empties the list at the top beyond `count` entries.
void shorten(lua_State* L, Device& device, std::size_t count) {
  for (std::size_t i = count; i < device.entries; ++i) {
    lua_pushnil(L);
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  device.entries = count;
}

/// Calls one of the constructors in vectors.hpp with the numbers on the top.
void make_vector(lua_State* L, const char* maker, int numbers) {
  lua_getfield(L, LUA_REGISTRYINDEX, maker);
  lua_insert(L, -(numbers + 1));
  lua_call(L, numbers, 1);
}

// --- wheels ---

int set_velocity(lua_State* L) {
  expect_arguments(L, 2, "robot.wheels.set_velocity(left, right)");
  const double left = luaL_checknumber(L, 1);
  const double right = luaL_checknumber(L, 2);
  port_of<hal::WheelSpeeds>(L).set(left * kM_per_cm, right * kM_per_cm);
  return 0;
}

void open_wheels(lua_State* L, Interpreter&, std::size_t device) {
  add(L, device, "set_velocity", &set_velocity);
}

void fill_wheels(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& encoders = *static_cast<const hal::WheelEncoders*>(port);
  Actor& actor = in.actor();
  push_table(L, in, device);
  set_number(L, "distance_left", (encoders.left_m - actor.left_m) / kM_per_cm);
  set_number(L, "distance_right", (encoders.right_m - actor.right_m) / kM_per_cm);
  set_number(L, "velocity_left", static_cast<double>(encoders.left_m_s) / kM_per_cm);
  set_number(L, "velocity_right", static_cast<double>(encoders.right_m_s) / kM_per_cm);
  const hal::DifferentialDrive* const drive = in.kind().drive();
  set_number(L, "axis_length", drive == nullptr ? 0.0 : drive->wheel_base_m / kM_per_cm);
  lua_pop(L, 1);
  actor.left_m = encoders.left_m;
  actor.right_m = encoders.right_m;
}

// --- rings ---

/// Numbers of the sensors in ARGoS' order: counter-clockwise from forward.
std::vector<std::size_t> counter_clockwise(std::span<const hal::Mount> mounts) {
  std::vector<std::size_t> order(mounts.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto turn = [&](std::size_t i) {
    const double rad = std::fmod(mounts[i].bearing_rad, kTwoPi);
    return rad < 0.0 ? rad + kTwoPi : rad;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return turn(a) < turn(b); });
  return order;
}

/// The table becomes a ring of sensors, or a list of numbers where `member` is null. What the script changed in it is
/// put right with each filling, by a function in Lua: that is the fastest.
void open_ring(lua_State* L, Interpreter& in, std::size_t device, std::span<const hal::Mount> mounts, bool bare) {
  const int table = lua_gettop(L);
  Device& d = in.device(device);
  d.order = counter_clockwise(mounts);
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
      const double turn = std::fmod(mounts[d.order[static_cast<std::size_t>(i)]].bearing_rad, kTwoPi);
      lua_pushnumber(L, turn > std::numbers::pi ? turn - kTwoPi : turn <= -std::numbers::pi ? turn + kTwoPi : turn);
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

/// ARGoS' response of the rings of foot-bot, eye-bot and e-puck: 1 at contact, 0 beyond the range.
double response(double distance_m) noexcept {
  return distance_m < 0.009889556 ? 1.0 : 0.0100527 / (distance_m + 0.000163144);
}

void open_proximity(lua_State* L, Interpreter& in, std::size_t device) {
  const auto* const part = in.kind().part<hal::ProximityPart>();
  if (part != nullptr) open_ring(L, in, device, part->mounts, in.device(device).written == "proximity");
}

void fill_proximity(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& p = *static_cast<const hal::Proximity*>(port);
  const bool bare = in.device(device).written == "proximity";
  fill_ring(L, in, device, [&](std::size_t i) {
    if (i >= p.count || p.distance_m[i] >= p.range_m) return 0.0;
    const auto distance_m = static_cast<double>(p.distance_m[i]);
    return bare ? hal::exp(-distance_m) : response(distance_m);
  });
}

void open_light(lua_State* L, Interpreter& in, std::size_t device) {
  const auto* const part = in.kind().part<hal::LightPart>();
  if (part != nullptr) open_ring(L, in, device, part->mounts, in.device(device).written == "light");
}

void fill_light(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& light = *static_cast<const hal::Light*>(port);
  fill_ring(L, in, device, [&](std::size_t i) { return i < light.count ? static_cast<double>(light.level[i]) : 0.0; });
}

// --- ground ---

void fill_ground(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& ground = *static_cast<const hal::Ground*>(port);
  push_table(L, in, device);
  for (std::size_t i = 0; i < ground.count; ++i) {
    lua_pushnumber(L, static_cast<double>(ground.reflectance[i]));
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  shorten(L, in.device(device), ground.count);
  lua_pop(L, 1);
}

template <class Part>
void fill_ground_ring(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& ground = *static_cast<const hal::Ground*>(port);
  const Part* const part = in.kind().part<Part>();
  push_table(L, in, device);
  const std::size_t count = part == nullptr ? 0 : std::min<std::size_t>(ground.count, part->mounts.size());
  for (std::size_t i = 0; i < count; ++i) {
    lua_createtable(L, 0, 2);
    set_number(L, "value", static_cast<double>(ground.reflectance[i]));
    lua_pushnumber(L, part->mounts[i].x_m / kM_per_cm);
    lua_pushnumber(L, part->mounts[i].y_m / kM_per_cm);
    make_vector(L, "tandem.vector2", 2);
    lua_setfield(L, -2, "offset");
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  shorten(L, in.device(device), count);
  lua_pop(L, 1);
}

// --- range and bearing ---

std::size_t payload_of(const Interpreter& in) {
  const auto* const board = in.kind().part<hal::RangeAndBearingPart>();
  return board == nullptr ? 0 : static_cast<std::size_t>(board->payload);
}

std::uint8_t byte_at(lua_State* L, int index, int argument) {
  const double value = lua_type(L, index) == LUA_TNUMBER ? lua_tonumber(L, index) : -1.0;
  if (!(value >= 0.0 && value < 256.0)) luaL_argerror(L, argument, "a byte is a number from 0 to 255");
  return static_cast<std::uint8_t>(value);
}

int set_data(lua_State* L) {
  auto& message = port_of<hal::RangeAndBearingSend>(L);
  const std::size_t size = payload_of(Interpreter::of(L));
  if (lua_gettop(L) == 1) {
    luaL_checktype(L, 1, LUA_TTABLE);
    if (static_cast<std::size_t>(luaL_len(L, 1)) != size)
      return luaL_error(L, "robot.range_and_bearing.set_data(array) expects an array of %d numbers",
                        static_cast<int>(size));
    std::array<std::uint8_t, hal::kRabPayloadMax> bytes{};
    for (std::size_t i = 0; i < size; ++i) {
      lua_geti(L, 1, static_cast<lua_Integer>(i) + 1);
      bytes[i] = byte_at(L, -1, 1);
      lua_pop(L, 1);
    }
    message.payload = bytes;
  } else if (lua_gettop(L) == 2) {
    const lua_Integer index = luaL_checkinteger(L, 1);
    if (index < 1 || index > static_cast<lua_Integer>(size))
      return luaL_error(L, "robot.range_and_bearing.set_data: the index %I is not one of 1 to %d",
                        static_cast<LUAI_UACINT>(index), static_cast<int>(size));
    message.payload[static_cast<std::size_t>(index - 1)] = byte_at(L, 2, 2);
  } else {
    return luaL_error(L, "robot.range_and_bearing.set_data() expects either one or two arguments");
  }
  return 0;
}

int clear_data(lua_State* L) {
  expect_arguments(L, 0, "robot.range_and_bearing.clear_data()");
  port_of<hal::RangeAndBearingSend>(L).payload.fill(0);
  return 0;
}

void open_sending(lua_State* L, Interpreter&, std::size_t device) {
  add(L, device, "set_data", &set_data);
  add(L, device, "clear_data", &clear_data);
}

void fill_hearing(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& heard = *static_cast<const hal::RangeAndBearing*>(port);
  push_table(L, in, device);
  for (std::size_t i = 0; i < heard.count; ++i) {
    lua_createtable(L, 0, 4);
    set_number(L, "range", static_cast<double>(heard.range_m[i]) / kM_per_cm);
    set_number(L, "horizontal_bearing", static_cast<double>(heard.bearing_rad[i]));
    set_number(L, "vertical_bearing", static_cast<double>(heard.elevation_rad[i]));
    const std::size_t size = std::min<std::size_t>(heard.size[i], hal::kRabPayloadMax);
    lua_createtable(L, static_cast<int>(size), 0);
    for (std::size_t k = 0; k < size; ++k) {
      lua_pushinteger(L, heard.message(i)[k]);
      lua_rawseti(L, -2, static_cast<lua_Integer>(k) + 1);
    }
    lua_setfield(L, -2, "data");
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  shorten(L, in.device(device), heard.count);
  lua_pop(L, 1);
}

// --- colours ---

struct NamedColor {
  const char* name;
  hal::Rgb color;
};
constexpr std::array<NamedColor, 17> kColors = {{{"black", {0, 0, 0}},
                                                 {"white", {255, 255, 255}},
                                                 {"red", {255, 0, 0}},
                                                 {"green", {0, 255, 0}},
                                                 {"blue", {0, 0, 255}},
                                                 {"magenta", {255, 0, 255}},
                                                 {"cyan", {0, 255, 255}},
                                                 {"yellow", {255, 255, 0}},
                                                 {"orange", {255, 140, 0}},
                                                 {"brown", {165, 42, 42}},
                                                 {"purple", {160, 32, 240}},
                                                 {"gray10", {26, 26, 26}},
                                                 {"gray30", {77, 77, 77}},
                                                 {"gray50", {128, 128, 128}},
                                                 {"gray70", {178, 178, 178}},
                                                 {"gray80", {204, 204, 204}},
                                                 {"gray90", {229, 229, 229}}}};

/// The colour that the arguments from `first` on tell: a name, "r,g,b", or three numbers.
hal::Rgb color_at(lua_State* L, int first) {
  if (lua_type(L, first) == LUA_TSTRING) {
    const std::string_view text = lua_tostring(L, first);
    for (const NamedColor& known : kColors) {
      if (text == known.name) return known.color;
    }
    std::array<int, 3> rgb{};
    char more = '\0';
    if (std::sscanf(text.data(), "%d,%d,%d%c", &rgb[0], &rgb[1], &rgb[2], &more) == 3 &&
        std::all_of(rgb.begin(), rgb.end(), [](int c) { return c >= 0 && c <= 255; }))
      return {static_cast<std::uint8_t>(rgb[0]), static_cast<std::uint8_t>(rgb[1]), static_cast<std::uint8_t>(rgb[2])};
    luaL_argerror(L, first, "a colour is a name such as \"red\", or \"r,g,b\" with 0 to 255");
  }
  luaL_checknumber(L, first);
  return {byte_at(L, first, first), byte_at(L, first + 1, first + 1), byte_at(L, first + 2, first + 2)};
}

template <class Part>
std::size_t leds_of(const Interpreter& in) {
  const Part* const part = in.kind().part<Part>();
  return part == nullptr ? 0 : part->mounts.size();
}

template <class Port, class Part>
int set_single_color(lua_State* L) {
  const int count = lua_gettop(L);
  if (count != 2 && count != 4) return luaL_error(L, "robot.leds.set_single_color() expects 2 or 4 arguments");
  const lua_Integer led = luaL_checkinteger(L, 1);
  const std::size_t leds = leds_of<Part>(Interpreter::of(L));
  if (led < 1 || led > static_cast<lua_Integer>(leds))
    return luaL_error(L, "robot.leds.set_single_color: the robot has the LEDs 1 to %d, not %I", static_cast<int>(leds),
                      static_cast<LUAI_UACINT>(led));
  port_of<Port>(L).set(static_cast<std::size_t>(led - 1), color_at(L, 2));
  return 0;
}

template <class Port>
int set_all_colors(lua_State* L) {
  const int count = lua_gettop(L);
  if (count != 1 && count != 3) return luaL_error(L, "robot.leds.set_all_colors() expects 1 or 3 arguments");
  port_of<Port>(L).set_all(color_at(L, 1));
  return 0;
}

template <class Port, class Part>
void open_leds(lua_State* L, Interpreter&, std::size_t device) {
  add(L, device, "set_single_color", &set_single_color<Port, Part>);
  add(L, device, "set_all_colors", &set_all_colors<Port>);
}

// --- cameras ---

template <bool Actor::*kOn, bool kValue>
int switch_camera(lua_State* L) {
  expect_arguments(L, 0, kValue ? "enable()" : "disable()");
  Interpreter::of(L).actor().*kOn = kValue;
  return 0;
}

template <bool Actor::*kOn>
void open_camera(lua_State* L, Interpreter&, std::size_t device) {
  add(L, device, "enable", &switch_camera<kOn, true>);
  add(L, device, "disable", &switch_camera<kOn, false>);
}

void set_color(lua_State* L, hal::Rgb color) {
  lua_createtable(L, 0, 3);
  lua_pushinteger(L, color.r);
  lua_setfield(L, -2, "red");
  lua_pushinteger(L, color.g);
  lua_setfield(L, -2, "green");
  lua_pushinteger(L, color.b);
  lua_setfield(L, -2, "blue");
  lua_setfield(L, -2, "color");
}

void fill_omni(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& camera = *static_cast<const hal::OmnidirectionalCamera*>(port);
  const std::size_t count = in.actor().omni_on ? camera.count : 0;
  push_table(L, in, device);
  for (std::size_t i = 0; i < count; ++i) {
    lua_createtable(L, 0, 3);
    set_number(L, "distance", static_cast<double>(camera.distance_m[i]) / kM_per_cm);
    set_number(L, "angle", static_cast<double>(camera.bearing_rad[i]));
    set_color(L, camera.color(i));
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  shorten(L, in.device(device), count);
  lua_pop(L, 1);
}

void fill_perspective(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& camera = *static_cast<const hal::PerspectiveCamera*>(port);
  const std::size_t count = in.actor().perspective_on ? camera.count : 0;
  push_table(L, in, device);
  for (std::size_t i = 0; i < count; ++i) {
    lua_createtable(L, 0, 3);
    set_number(L, "x", static_cast<double>(camera.x_px[i]));
    set_number(L, "y", static_cast<double>(camera.y_px[i]));
    set_color(L, camera.color(i));
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  shorten(L, in.device(device), count);
  lua_pop(L, 1);
}

// --- the distance scanner ---

int scanner_enable(lua_State* L) {
  expect_arguments(L, 0, "robot.distance_scanner.enable()");
  auto& drive = port_of<hal::ScannerDrive>(L);
  if (drive.mode == hal::ScannerMode::Off) drive.go_to(drive.angle_rad);
  return 0;
}
int scanner_disable(lua_State* L) {
  expect_arguments(L, 0, "robot.distance_scanner.disable()");
  port_of<hal::ScannerDrive>(L).turn_off();
  return 0;
}
int scanner_set_angle(lua_State* L) {
  expect_arguments(L, 1, "robot.distance_scanner.set_angle(radians)");
  port_of<hal::ScannerDrive>(L).go_to(luaL_checknumber(L, 1));
  return 0;
}
int scanner_set_rpm(lua_State* L) {
  expect_arguments(L, 1, "robot.distance_scanner.set_rpm(rpm)");
  port_of<hal::ScannerDrive>(L).turn(luaL_checknumber(L, 1) * kTwoPi / 60.0);
  return 0;
}

void open_scanner_drive(lua_State* L, Interpreter&, std::size_t device) {
  add(L, device, "enable", &scanner_enable);
  add(L, device, "disable", &scanner_disable);
  add(L, device, "set_angle", &scanner_set_angle);
  add(L, device, "set_rpm", &scanner_set_rpm);
}

void fill_scanner(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& scanner = *static_cast<const hal::DistanceScanner*>(port);
  push_table(L, in, device);
  for (const bool near : {true, false}) {
    lua_newtable(L);
    lua_Integer n = 0;
    for (std::size_t head = 0; head < hal::DistanceScanner::kHeads; ++head) {
      if (hal::DistanceScanner::is_short(head) != near) continue;
      for (std::size_t sample = 0; sample < scanner.samples; ++sample) {
        const double distance = scanner.too_near(head, sample) ? -1.0
                                : scanner.sees_nothing(head, sample)
                                    ? -2.0
                                    : static_cast<double>(scanner.distance(head, sample)) / kM_per_cm;
        lua_createtable(L, 0, 2);
        set_number(L, "angle", static_cast<double>(scanner.angle(head, sample)));
        set_number(L, "distance", distance);
        lua_rawseti(L, -2, ++n);
      }
    }
    lua_pushstring(L, near ? "short_range" : "long_range");
    lua_insert(L, -2);
    lua_rawset(L, -3);
  }
  lua_pop(L, 1);
}

// --- turret, gripper ---

int turret_rotation(lua_State* L) {
  expect_arguments(L, 1, "robot.turret.set_rotation(radians)");
  port_of<hal::TurretDrive>(L).go_to(luaL_checknumber(L, 1));
  return 0;
}
int turret_rotation_speed(lua_State* L) {
  expect_arguments(L, 1, "robot.turret.set_rotation_speed(radians per second)");
  port_of<hal::TurretDrive>(L).turn(luaL_checknumber(L, 1));
  return 0;
}
int turret_position_mode(lua_State* L) {
  expect_arguments(L, 0, "robot.turret.set_position_control_mode()");
  port_of<hal::TurretDrive>(L).mode = hal::TurretMode::Position;
  return 0;
}
int turret_speed_mode(lua_State* L) {
  expect_arguments(L, 0, "robot.turret.set_speed_control_mode()");
  port_of<hal::TurretDrive>(L).mode = hal::TurretMode::Speed;
  return 0;
}
int turret_passive_mode(lua_State* L) {
  expect_arguments(L, 0, "robot.turret.set_passive_mode()");
  port_of<hal::TurretDrive>(L).let_go();
  return 0;
}

void open_turret(lua_State* L, Interpreter&, std::size_t device) {
  add(L, device, "set_rotation", &turret_rotation);
  add(L, device, "set_rotation_speed", &turret_rotation_speed);
  add(L, device, "set_position_control_mode", &turret_position_mode);
  add(L, device, "set_speed_control_mode", &turret_speed_mode);
  add(L, device, "set_passive_mode", &turret_passive_mode);
}

void fill_turret(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  push_table(L, in, device);
  lua_pushliteral(L, "rotation");
  lua_pushnumber(L, static_cast<const hal::TurretEncoder*>(port)->angle_rad);
  lua_rawset(L, -3);
  lua_pop(L, 1);
}

template <int kSign>
int grip(lua_State* L) {
  expect_arguments(L, 0, kSign == 0 ? "robot.gripper.unlock()" : "robot.gripper.lock()");
  port_of<hal::GripperDrive>(L).aperture_rad = kSign * hal::GripperDrive::kMost_rad;
  return 0;
}

void open_gripper(lua_State* L, Interpreter&, std::size_t device) {
  add(L, device, "lock", &grip<1>);
  add(L, device, "lock_positive", &grip<1>);
  add(L, device, "lock_negative", &grip<-1>);
  add(L, device, "unlock", &grip<0>);
}

// --- flight ---

const hal::Positioning* positioning_of(lua_State* L) {
  Interpreter& in = Interpreter::of(L);
  for (std::size_t i = 0; i < in.devices().size(); ++i) {
    const hal::PortType& type = *in.devices()[i].type;
    if (type.role == hal::Role::Sensor && type.layout == hal::port_type<hal::Positioning>().layout &&
        type.name == hal::Positioning::kName)
      return static_cast<const hal::Positioning*>(in.actor().ports[i]);
  }
  luaL_error(L,
             "robot.quadrotor: a place or heading relative to the robot's needs the sensor positioning in its "
             "configuration");
  return nullptr;
}

double yaw_of(const hal::Positioning& at) noexcept {
  const auto& [w, x, y, z] = at.q_WB;
  return hal::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
}

int absolute_position(lua_State* L) {
  expect_arguments(L, 3, "robot.quadrotor.set_absolute_position(x, y, z)");
  auto& command = port_of<hal::QuadrotorPosition>(L);
  command.set(luaL_checknumber(L, 1), luaL_checknumber(L, 2), luaL_checknumber(L, 3), command.yaw_rad);
  return 0;
}
int relative_position(lua_State* L) {
  expect_arguments(L, 3, "robot.quadrotor.set_relative_position(x, y, z)");
  auto& command = port_of<hal::QuadrotorPosition>(L);
  const double x = luaL_checknumber(L, 1);
  const double y = luaL_checknumber(L, 2);
  const double z = luaL_checknumber(L, 3);
  const hal::Positioning& at = *positioning_of(L);
  const double yaw = yaw_of(at);
  command.set(at.p_WB[0] + x * hal::cos(yaw) - y * hal::sin(yaw), at.p_WB[1] + x * hal::sin(yaw) + y * hal::cos(yaw),
              at.p_WB[2] + z, command.yaw_rad);
  return 0;
}
int absolute_yaw(lua_State* L) {
  expect_arguments(L, 1, "robot.quadrotor.set_absolute_yaw(degrees)");
  port_of<hal::QuadrotorPosition>(L).yaw_rad = luaL_checknumber(L, 1) * std::numbers::pi / 180.0;
  return 0;
}
int relative_yaw(lua_State* L) {
  expect_arguments(L, 1, "robot.quadrotor.set_relative_yaw(degrees)");
  const double turn = luaL_checknumber(L, 1) * std::numbers::pi / 180.0;
  port_of<hal::QuadrotorPosition>(L).yaw_rad = yaw_of(*positioning_of(L)) + turn;
  return 0;
}

void open_flight_to(lua_State* L, Interpreter&, std::size_t device) {
  add(L, device, "set_absolute_position", &absolute_position);
  add(L, device, "set_relative_position", &relative_position);
  add(L, device, "set_absolute_yaw", &absolute_yaw);
  add(L, device, "set_relative_yaw", &relative_yaw);
}

int linear_velocity(lua_State* L) {
  const int count = lua_gettop(L);
  if (count != 2 && count != 3) return luaL_error(L, "robot.quadrotor.set_linear_velocity() expects 2 or 3 arguments");
  auto& command = port_of<hal::QuadrotorSpeed>(L);
  command.set(luaL_checknumber(L, 1), luaL_checknumber(L, 2), luaL_optnumber(L, 3, 0.0), command.yaw_rad_s);
  return 0;
}
int rotational_speed(lua_State* L) {
  expect_arguments(L, 1, "robot.quadrotor.set_rotational_speed(radians per second)");
  port_of<hal::QuadrotorSpeed>(L).yaw_rad_s = luaL_checknumber(L, 1);
  return 0;
}

void open_flight_with(lua_State* L, Interpreter&, std::size_t device) {
  add(L, device, "set_linear_velocity", &linear_velocity);
  add(L, device, "set_rotational_speed", &rotational_speed);
}

int set_pan(lua_State* L) {
  expect_arguments(L, 1, "robot.pan_tilt_camera.set_pan(radians)");
  port_of<hal::PanTiltDrive>(L).pan_rad = luaL_checknumber(L, 1);
  return 0;
}
int set_tilt(lua_State* L) {
  expect_arguments(L, 1, "robot.pan_tilt_camera.set_tilt(radians)");
  port_of<hal::PanTiltDrive>(L).tilt_rad = luaL_checknumber(L, 1);
  return 0;
}

void open_head(lua_State* L, Interpreter&, std::size_t device) {
  add(L, device, "set_pan", &set_pan);
  add(L, device, "set_tilt", &set_tilt);
}

// --- place, battery ---

void fill_positioning(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& at = *static_cast<const hal::Positioning*>(port);
  push_table(L, in, device);
  lua_pushliteral(L, "position");
  for (const double x : at.p_WB) lua_pushnumber(L, x);
  make_vector(L, "tandem.vector3", 3);
  lua_rawset(L, -3);
  lua_pushliteral(L, "orientation");
  for (const double x : at.q_WB) lua_pushnumber(L, x);
  make_vector(L, "tandem.orientation", 4);
  lua_rawset(L, -3);
  lua_pop(L, 1);
}

void fill_battery(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  push_table(L, in, device);
  lua_pushliteral(L, "available_charge");
  lua_pushnumber(L, static_cast<double>(static_cast<const hal::Battery*>(port)->charge));
  lua_rawset(L, -3);
  lua_pushliteral(L, "time_left");  // what drains it is not known to the robot
  lua_pushnumber(L, std::numeric_limits<double>::infinity());
  lua_rawset(L, -3);
  lua_pop(L, 1);
}

template <class Port>
DeviceApi api(const char* table, void (*open)(lua_State*, Interpreter&, std::size_t),
              void (*fill)(lua_State*, Interpreter&, std::size_t, const void*) = nullptr, bool ring = false) {
  const hal::PortType& type = hal::port_type<Port>();
  return {type.role, Port::kName, table, type.layout, open, fill, ring};
}

}  // namespace

std::span<const DeviceApi> device_apis() {
  static const std::array all = {
      api<hal::WheelSpeeds>("wheels", &open_wheels),
      api<hal::WheelEncoders>("wheels", nullptr, &fill_wheels),
      api<hal::Proximity>("proximity", &open_proximity, &fill_proximity, true),
      api<hal::Light>("light", &open_light, &fill_light, true),
      api<hal::Ground>("ground", nullptr, &fill_ground),
      api<hal::BaseGround>("base_ground", nullptr, &fill_ground_ring<hal::BaseGroundPart>),
      api<hal::MotorGround>("motor_ground", nullptr, &fill_ground_ring<hal::MotorGroundPart>),
      api<hal::RangeAndBearing>("range_and_bearing", nullptr, &fill_hearing),
      api<hal::RangeAndBearingSend>("range_and_bearing", &open_sending),
      api<hal::RingLeds>("leds", &open_leds<hal::RingLeds, hal::LedsPart>),
      api<hal::UpperRingLeds>("upper_leds", &open_leds<hal::UpperRingLeds, hal::UpperLedsPart>),
      api<hal::OmnidirectionalCamera>("colored_blob_omnidirectional_camera", &open_camera<&Actor::omni_on>, &fill_omni),
      api<hal::PerspectiveCamera>("colored_blob_perspective_camera", &open_camera<&Actor::perspective_on>,
                                  &fill_perspective),
      api<hal::ScannerDrive>("distance_scanner", &open_scanner_drive),
      api<hal::DistanceScanner>("distance_scanner", nullptr, &fill_scanner),
      api<hal::TurretDrive>("turret", &open_turret),
      api<hal::TurretEncoder>("turret", nullptr, &fill_turret),
      api<hal::GripperDrive>("gripper", &open_gripper),
      api<hal::QuadrotorPosition>("quadrotor", &open_flight_to),
      api<hal::QuadrotorSpeed>("quadrotor", &open_flight_with),
      api<hal::PanTiltDrive>("pan_tilt_camera", &open_head),
      api<hal::Positioning>("positioning", nullptr, &fill_positioning),
      api<hal::Battery>("battery", nullptr, &fill_battery)};
  return all;
}

}  // namespace tandem::controllers::lua
