// Devices as ARGoS' scripts know them: tables below `robot`, in ARGoS' units.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "controllers/lua_controller/interpreter.hpp"
#include "hal/port.hpp"

namespace tandem::controllers::lua {

/// What ARGoS' scripts have of one port.
struct DeviceApi {
  hal::Role role = hal::Role::Sensor;
  std::string_view port;
  const char* table = nullptr;  ///< below `robot`
  std::uint64_t layout = 0;     ///< of the port as this plug-in knows it
  /// Adds functions and constant fields to the table, which is on the top of the stack.
  void (*open)(lua_State* state, Interpreter& in, std::size_t device) = nullptr;
  /// Writes the readings into it; null for actuators.
  void (*fill)(lua_State* state, Interpreter& in, std::size_t device, const void* port) = nullptr;
  bool ring = false;  ///< `open` gets the table of readings, which scripts get as it is; else that of functions
};

std::span<const DeviceApi> device_apis();

/// `robot.sensors` and `robot.actuators`, on the table `robot` at the top of the stack: every port, field by field, in
/// SI.
void open_ports(lua_State* state, Interpreter& in);

/// Opens the libraries that scripts have into the table at the top of the stack.
void open_libraries(lua_State* state, Interpreter& in);
/// `robot.random`, on the table `robot` at the top of the stack.
void open_random(lua_State* state);

/// Pushes a text for the value: as tostring, but tables and functions are told by the number in which this robot first
/// asked for one.
void push_text(lua_State* state, int index);

/// Raises an error unless the script gave so many arguments; `call` is how it is written.
void expect_arguments(lua_State* state, int count, const char* call);

}  // namespace tandem::controllers::lua
