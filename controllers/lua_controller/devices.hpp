// Devices as ARGoS' scripts know them: tables below `robot`, in ARGoS' units.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "controllers/lua_controller/interpreter.hpp"
#include "hal/port.hpp"

namespace tandem::controllers::lua {

/// A function below a device's table. Upvalues: the device's number, its own place among the functions.
struct DeviceFunction {
  const char* name;
  lua_CFunction own = nullptr;  ///< null: one of numbers, as follows
  const char* call = nullptr;   ///< how it is written
  int least = 0, most = 0;      ///< numbers that it takes
  void (*act)(lua_State* state, void* port, const double* numbers) = nullptr;
};

/// What ARGoS' scripts have of one port.
struct DeviceApi {
  hal::Role role = hal::Role::Sensor;
  std::string_view port;
  const char* table = nullptr;  ///< below `robot`
  std::uint64_t layout = 0;     ///< of the port as this plug-in knows it
  std::span<const DeviceFunction> functions = {};
  /// Writes the readings into it; null for actuators.
  void (*fill)(lua_State* state, Interpreter& in, std::size_t device, const void* port) = nullptr;
  /// Null, or prepares the table of readings, on the top of the stack, which scripts get as it is.
  void (*open_ring)(lua_State* state, Interpreter& in, std::size_t device) = nullptr;
};

/// Adds the functions to the table on the top of the stack.
void open_functions(lua_State* state, const DeviceApi& api, std::size_t device);

std::span<const DeviceApi> device_apis();

/// `robot.sensors` and `robot.actuators`, on the table `robot` at the top of the stack: every port, field by field, in
/// SI.
void open_ports(lua_State* state, Interpreter& in);

/// Opens the libraries that scripts have into the table at the top of the stack.
void open_libraries(lua_State* state, Interpreter& in);
/// `require` and its kin; io, os and package, as far as allowed: into the table at the top of the stack.
void open_code(lua_State* state);
void open_outside(lua_State* state, Interpreter& in);
/// What it has of its own: elementary functions and random numbers, in the table of math on the top of the stack.
void open_math(lua_State* state);
/// `pairs` and `next`; `table.sort`: into the table on the top of the stack.
void open_order(lua_State* state);
void open_sort(lua_State* state);
/// `robot.random`, on the table `robot` at the top of the stack.
void open_random(lua_State* state);

/// Pushes a text for the value: as tostring, but tables and functions are told by the number in which this robot first
/// asked for one.
void push_text(lua_State* state, int index);

/// Raises an error unless the script gave so many arguments; `call` is how it is written.
void expect_arguments(lua_State* state, int count, const char* call);

}  // namespace tandem::controllers::lua
