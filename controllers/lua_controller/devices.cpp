#include "controllers/lua_controller/devices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "controllers/lua_controller/rings.hpp"
#include "hal/device/argos_readings.hpp"
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
#include "hal/named_colors.hpp"

namespace tandem::controllers::lua {
namespace {

using hal::QuadrotorPosition, hal::QuadrotorSpeed, hal::ScannerDrive, hal::TurretDrive, hal::PanTiltDrive;
using hal::WheelSpeeds, hal::GripperDrive;

using hal::argos::kM_per_cm;
constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// The port that a function acts on: its first upvalue is the device's number.
template <class Port>
Port& port_of(lua_State* L) {
  const auto device = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(1)));
  return *static_cast<Port*>(Interpreter::of(L).actor().ports[device]);
}

/// Does what the table of functions says with the numbers that it is called with. Upvalues: device, place in the table.
int call_function(lua_State* L) {
  Interpreter& in = Interpreter::of(L);
  const auto number = static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(1)));
  const DeviceFunction& f =
      in.device(number).api->functions[static_cast<std::size_t>(lua_tointeger(L, lua_upvalueindex(2)))];
  const int given = lua_gettop(L);
  if (f.least == f.most)
    expect_arguments(L, f.least, f.call);
  else if (given < f.least || given > f.most)
    return luaL_error(L, "%s expects %d or %d arguments", f.call, f.least, f.most);
  std::array<double, 3> x{};
  for (int i = 0; i < given; ++i)
    x[static_cast<std::size_t>(i)] = i < f.least ? luaL_checknumber(L, i + 1) : luaL_optnumber(L, i + 1, 0.0);
  f.act(L, in.actor().ports[number], x.data());
  return 0;
}

/// A function of so many numbers. `Act`: what it does with the port and them.
template <class Port, class Act>
constexpr DeviceFunction takes(const char* name, const char* call, int least, int most, Act) {
  return {name, nullptr, call, least, most, [](lua_State* L, void* port, const double* x) {
            if constexpr (std::is_invocable_v<Act, Port&, const double*, lua_State*>)
              Act{}(*static_cast<Port*>(port), x, L);
            else
              Act{}(*static_cast<Port*>(port), x);
          }};
}
template <class Port, class Act>
constexpr DeviceFunction takes(const char* name, const char* call, int count, Act act) {
  return takes<Port>(name, call, count, count, act);
}

void set_number(lua_State* L, const char* name, double value) {
  lua_pushnumber(L, value);
  lua_setfield(L, -2, name);
}

void push_table(lua_State* L, Interpreter& in, std::size_t device) {
  lua_rawgeti(L, LUA_REGISTRYINDEX, in.device(device).table);
}

/// Makes the table of a device a list of `count` entries. `push(i)` leaves entry i, from 0, on the top.
template <class Push>
void fill_list(lua_State* L, Interpreter& in, std::size_t device, std::size_t count, Push&& push) {
  push_table(L, in, device);
  for (std::size_t i = 0; i < count; ++i) {
    push(i);
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  Device& d = in.device(device);
  for (std::size_t i = count; i < d.entries; ++i) {
    lua_pushnil(L);
    lua_rawseti(L, -2, static_cast<lua_Integer>(i) + 1);
  }
  d.entries = count;
  lua_pop(L, 1);
}

/// Calls one of the constructors in vectors.hpp with the numbers on the top.
void make_vector(lua_State* L, const char* maker, int numbers) {
  lua_getfield(L, LUA_REGISTRYINDEX, maker);
  lua_insert(L, -(numbers + 1));
  lua_call(L, numbers, 1);
}

// --- wheels ---

/// Called in every tick, so with nothing between.
int set_velocity(lua_State* L) {
  expect_arguments(L, 2, "robot.wheels.set_velocity(left, right)");
  const double left = luaL_checknumber(L, 1);
  port_of<WheelSpeeds>(L).set(left * kM_per_cm, luaL_checknumber(L, 2) * kM_per_cm);
  return 0;
}
constexpr std::array kWheels = {DeviceFunction{"set_velocity", &set_velocity}};

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

// --- ground ---

void fill_ground(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& ground = *static_cast<const hal::Ground*>(port);
  fill_list(L, in, device, ground.count,
            [&](std::size_t i) { lua_pushnumber(L, static_cast<double>(ground.reflectance[i])); });
}

template <class Part>
void fill_ground_ring(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& ground = *static_cast<const hal::Ground*>(port);
  const Part* const part = in.kind().part<Part>();
  const std::size_t count = part == nullptr ? 0 : std::min<std::size_t>(ground.count, part->mounts.size());
  fill_list(L, in, device, count, [&](std::size_t i) {
    lua_createtable(L, 0, 2);
    set_number(L, "value", static_cast<double>(ground.reflectance[i]));
    lua_pushnumber(L, part->mounts[i].x_m / kM_per_cm);
    lua_pushnumber(L, part->mounts[i].y_m / kM_per_cm);
    make_vector(L, "tandem.vector2", 2);
    lua_setfield(L, -2, "offset");
  });
}

// --- range and bearing ---

std::uint8_t byte_at(lua_State* L, int index, int argument) {
  const double value = lua_type(L, index) == LUA_TNUMBER ? lua_tonumber(L, index) : -1.0;
  if (Interpreter::of(L).script().argos && lua_type(L, index) == LUA_TNUMBER && std::isfinite(value)) {
    const double wrapped = std::fmod(std::trunc(value), 256.0);
    return static_cast<std::uint8_t>(wrapped < 0.0 ? wrapped + 256.0 : wrapped);
  }
  if (!(value >= 0.0 && value < 256.0)) luaL_argerror(L, argument, "a byte is a number from 0 to 255");
  return static_cast<std::uint8_t>(value);
}

template <class Port>
int set_data(lua_State* L) {
  auto& message = port_of<Port>(L);
  const std::size_t size = hal::message_bytes(Interpreter::of(L).kind(), message.payload.size());
  if (lua_gettop(L) == 1) {
    luaL_checktype(L, 1, LUA_TTABLE);
    if (static_cast<std::size_t>(luaL_len(L, 1)) != size)
      return luaL_error(L, "robot.range_and_bearing.set_data(array) expects an array of %d numbers",
                        static_cast<int>(size));
    decltype(message.payload) bytes{};
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

template <class Port>
constexpr std::array kSending = {
    DeviceFunction{"set_data", &set_data<Port>},
    takes<Port>("clear_data", "robot.range_and_bearing.clear_data()", 0, [](auto& d, auto*) { d.payload.fill(0); })};

template <class Port>
void fill_hearing(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& heard = *static_cast<const Port*>(port);
  in.tell_dropped(heard.dropped, "messages");
  fill_list(L, in, device, heard.count, [&](std::size_t i) {
    lua_createtable(L, 0, 4);
    set_number(L, "range", static_cast<double>(heard.range_m[i]) / kM_per_cm);
    set_number(L, "horizontal_bearing", static_cast<double>(heard.bearing_rad[i]));
    set_number(L, "vertical_bearing", static_cast<double>(heard.elevation_rad[i]));
    const std::size_t size = std::min<std::size_t>(heard.size[i], Port::kPayload);
    lua_createtable(L, static_cast<int>(size), 0);
    for (std::size_t k = 0; k < size; ++k) {
      lua_pushinteger(L, heard.message(i)[k]);
      lua_rawseti(L, -2, static_cast<lua_Integer>(k) + 1);
    }
    lua_setfield(L, -2, "data");
  });
}

// --- colours ---

/// The colour that the arguments from `first` on tell: a name, "r,g,b", or three numbers.
hal::Rgb color_at(lua_State* L, int first) {
  if (lua_type(L, first) == LUA_TSTRING) {
    const std::string_view text = lua_tostring(L, first);
    if (const auto color = hal::parse_color(text)) return *color;
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
constexpr std::array kLeds = {DeviceFunction{"set_single_color", &set_single_color<Port, Part>},
                              DeviceFunction{"set_all_colors", &set_all_colors<Port>}};

// --- cameras ---

template <class Port, bool Actor::*kOn>
constexpr std::array kCamera = {
    takes<Port>("enable", "enable()", 0,
                [](auto&, const double*, lua_State* L) { Interpreter::of(L).actor().*kOn = true; }),
    takes<Port>("disable", "disable()", 0,
                [](auto&, const double*, lua_State* L) { Interpreter::of(L).actor().*kOn = false; })};

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

template <class Port>
void fill_omni(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& camera = *static_cast<const Port*>(port);
  in.tell_dropped(camera.dropped, "blobs");
  fill_list(L, in, device, in.actor().omni_on ? camera.count : 0, [&](std::size_t i) {
    lua_createtable(L, 0, 3);
    set_number(L, "distance", static_cast<double>(camera.distance_m[i]) / kM_per_cm);
    set_number(L, "angle", static_cast<double>(camera.bearing_rad[i]));
    set_color(L, camera.color(i));
  });
}

template <class Port>
void fill_perspective(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& camera = *static_cast<const Port*>(port);
  in.tell_dropped(camera.dropped, "blobs");
  fill_list(L, in, device, in.actor().perspective_on ? camera.count : 0, [&](std::size_t i) {
    lua_createtable(L, 0, 3);
    set_number(L, "x", static_cast<double>(camera.x_px[i]));
    set_number(L, "y", static_cast<double>(camera.y_px[i]));
    set_color(L, camera.color(i));
  });
}

// --- the distance scanner ---

constexpr std::array kScanner = {
    takes<ScannerDrive>("enable", "robot.distance_scanner.enable()", 0,
                        [](auto& d, auto*) {
                          if (d.mode == hal::ScannerMode::Off) d.go_to(d.angle_rad);
                        }),
    takes<ScannerDrive>("disable", "robot.distance_scanner.disable()", 0, [](auto& d, auto*) { d.turn_off(); }),
    takes<ScannerDrive>("set_angle", "robot.distance_scanner.set_angle(radians)", 1,
                        [](auto& d, auto* x) { d.go_to(x[0]); }),
    takes<ScannerDrive>("set_rpm", "robot.distance_scanner.set_rpm(rpm)", 1,
                        [](auto& d, auto* x) { d.turn(x[0] * kTwoPi / 60.0); })};

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

constexpr std::array kTurret = {
    takes<TurretDrive>("set_rotation", "robot.turret.set_rotation(radians)", 1,
                       [](auto& d, auto* x) { d.go_to(x[0]); }),
    takes<TurretDrive>("set_rotation_speed", "robot.turret.set_rotation_speed(radians per second)", 1,
                       [](auto& d, auto* x) { d.turn(x[0]); }),
    takes<TurretDrive>("set_position_control_mode", "robot.turret.set_position_control_mode()", 0,
                       [](auto& d, auto*) { d.mode = hal::TurretMode::Position; }),
    takes<TurretDrive>("set_speed_control_mode", "robot.turret.set_speed_control_mode()", 0,
                       [](auto& d, auto*) { d.mode = hal::TurretMode::Speed; }),
    takes<TurretDrive>("set_passive_mode", "robot.turret.set_passive_mode()", 0, [](auto& d, auto*) { d.let_go(); })};

void fill_turret(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  push_table(L, in, device);
  set_number(L, "rotation", static_cast<const hal::TurretEncoder*>(port)->angle_rad);
  lua_pop(L, 1);
}

template <int kSign>
constexpr DeviceFunction grip(const char* name, const char* call) {
  return takes<GripperDrive>(name, call, 0,
                             [](auto& d, auto*) { d.aperture_rad = kSign * hal::GripperDrive::kMost_rad; });
}
constexpr std::array kGripper = {
    grip<1>("lock", "robot.gripper.lock()"), grip<1>("lock_positive", "robot.gripper.lock()"),
    grip<-1>("lock_negative", "robot.gripper.lock()"), grip<0>("unlock", "robot.gripper.unlock()")};

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

constexpr std::array kFlightTo = {
    takes<QuadrotorPosition>("set_absolute_position", "robot.quadrotor.set_absolute_position(x, y, z)", 3,
                             [](auto& d, auto* x) { d.set(x[0], x[1], x[2], d.yaw_rad); }),
    takes<QuadrotorPosition>("set_relative_position", "robot.quadrotor.set_relative_position(x, y, z)", 3,
                             [](auto& d, auto* x, lua_State* L) {
                               const auto p_WT = hal::argos::from_body(*positioning_of(L), {x[0], x[1], x[2]});
                               d.set(p_WT[0], p_WT[1], p_WT[2], d.yaw_rad);
                             }),
    takes<QuadrotorPosition>("set_absolute_yaw", "robot.quadrotor.set_absolute_yaw(degrees)", 1,
                             [](auto& d, auto* x) { d.yaw_rad = x[0] * std::numbers::pi / 180.0; }),
    takes<QuadrotorPosition>("set_relative_yaw", "robot.quadrotor.set_relative_yaw(degrees)", 1,
                             [](auto& d, auto* x, lua_State* L) {
                               const double turn = x[0] * std::numbers::pi / 180.0;
                               d.yaw_rad = hal::argos::yaw_of(*positioning_of(L)) + turn;
                             })};

constexpr std::array kFlightWith = {
    takes<QuadrotorSpeed>("set_linear_velocity", "robot.quadrotor.set_linear_velocity()", 2, 3,
                          [](auto& d, auto* x) { d.set(x[0], x[1], x[2], d.yaw_rad_s); }),
    takes<QuadrotorSpeed>("set_rotational_speed", "robot.quadrotor.set_rotational_speed(radians per second)", 1,
                          [](auto& d, auto* x) { d.yaw_rad_s = x[0]; })};

constexpr std::array kHead = {takes<PanTiltDrive>("set_pan", "robot.pan_tilt_camera.set_pan(radians)", 1,
                                                  [](auto& d, auto* x) { d.pan_rad = x[0]; }),
                              takes<PanTiltDrive>("set_tilt", "robot.pan_tilt_camera.set_tilt(radians)", 1,
                                                  [](auto& d, auto* x) { d.tilt_rad = x[0]; })};

// --- place, battery ---

void fill_positioning(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  const auto& at = *static_cast<const hal::Positioning*>(port);
  push_table(L, in, device);
  for (const double x : at.p_WB) lua_pushnumber(L, x);
  make_vector(L, "tandem.vector3", 3);
  lua_setfield(L, -2, "position");
  for (const double x : at.q_WB) lua_pushnumber(L, x);
  make_vector(L, "tandem.orientation", 4);
  lua_setfield(L, -2, "orientation");
  lua_pop(L, 1);
}

void fill_battery(lua_State* L, Interpreter& in, std::size_t device, const void* port) {
  push_table(L, in, device);
  set_number(L, "available_charge", static_cast<double>(static_cast<const hal::Battery*>(port)->charge));
  set_number(L, "time_left", std::numeric_limits<double>::infinity());  // what drains it is not known to the robot
  lua_pop(L, 1);
}

using Fill = void (*)(lua_State*, Interpreter&, std::size_t, const void*);
using Open = void (*)(lua_State*, Interpreter&, std::size_t);
template <class Port>
DeviceApi api(const char* table, std::span<const DeviceFunction> functions, Fill fill = nullptr,
              Open open_ring = nullptr) {
  const hal::PortType& type = hal::port_type<Port>();
  return {type.role, Port::kName, table, type.layout, functions, fill, open_ring};
}

template <class Port>
DeviceApi omni_api() {
  return api<Port>("colored_blob_omnidirectional_camera", kCamera<Port, &Actor::omni_on>, &fill_omni<Port>);
}
template <class Port>
DeviceApi perspective_api() {
  return api<Port>("colored_blob_perspective_camera", kCamera<Port, &Actor::perspective_on>, &fill_perspective<Port>);
}

}  // namespace

void open_functions(lua_State* L, const DeviceApi& api, std::size_t device) {
  for (std::size_t i = 0; i < api.functions.size(); ++i) {
    lua_pushinteger(L, static_cast<lua_Integer>(device));
    lua_pushinteger(L, static_cast<lua_Integer>(i));
    lua_pushcclosure(L, api.functions[i].own != nullptr ? api.functions[i].own : &call_function, 2);
    lua_setfield(L, -2, api.functions[i].name);
  }
}

std::span<const DeviceApi> device_apis() {
  using namespace hal;
  static const std::array all = {api<WheelSpeeds>("wheels", kWheels),
                                 api<WheelEncoders>("wheels", {}, &fill_wheels),
                                 api<Proximity>("proximity", {}, &fill_proximity, &open_proximity),
                                 api<Light>("light", {}, &fill_light, &open_light),
                                 api<Ground>("ground", {}, &fill_ground),
                                 api<BaseGround>("base_ground", {}, &fill_ground_ring<BaseGroundPart>),
                                 api<MotorGround>("motor_ground", {}, &fill_ground_ring<MotorGroundPart>),
                                 api<RangeAndBearing>("range_and_bearing", {}, &fill_hearing<RangeAndBearing>),
                                 api<RangeAndBearingSend>("range_and_bearing", kSending<RangeAndBearingSend>),
                                 api<RangeAndBearingMany>("range_and_bearing", {}, &fill_hearing<RangeAndBearingMany>),
                                 api<RangeAndBearingLongSend>("range_and_bearing", kSending<RangeAndBearingLongSend>),
                                 api<RingLeds>("leds", kLeds<RingLeds, LedsPart>),
                                 api<UpperRingLeds>("upper_leds", kLeds<UpperRingLeds, UpperLedsPart>),
                                 omni_api<OmnidirectionalCamera>(),
                                 omni_api<OmnidirectionalCameraMany>(),
                                 perspective_api<PerspectiveCamera>(),
                                 perspective_api<PerspectiveCameraMany>(),
                                 api<ScannerDrive>("distance_scanner", kScanner),
                                 api<DistanceScanner>("distance_scanner", {}, &fill_scanner),
                                 api<TurretDrive>("turret", kTurret),
                                 api<TurretEncoder>("turret", {}, &fill_turret),
                                 api<GripperDrive>("gripper", kGripper),
                                 api<QuadrotorPosition>("quadrotor", kFlightTo),
                                 api<QuadrotorSpeed>("quadrotor", kFlightWith),
                                 api<PanTiltDrive>("pan_tilt_camera", kHead),
                                 api<Positioning>("positioning", {}, &fill_positioning),
                                 api<Battery>("battery", {}, &fill_battery)};
  return all;
}

}  // namespace tandem::controllers::lua
