#include "hal/plugin.hpp"

#include "controllers/lua_controller/lua_controller.hpp"

namespace {
void register_all(tandem::hal::Registrar& registrar) {
  using tandem::controllers::lua::LuaController;
  static const tandem::hal::ControllerType type = [] {
    tandem::hal::ControllerType t = tandem::hal::controller_type<LuaController>(
        "lua_controller", "Does what a script in Lua says, with the tables and functions of ARGoS' scripts.");
    t.step_row = &LuaController::step_row;  // robots of a row share an interpreter
    return t;
  }();
  registrar.add(type);
}
}  // namespace

TANDEM_PLUGIN(register_all)
