// Where Lua's library is led elsewhere by the linker's option --wrap (CMakeLists.txt). Debian's library keeps these
// functions to itself; their declarations are those of Lua 5.4.
#include "controllers/lua_controller/interpreter.hpp"

using tandem::controllers::lua::Interpreter;

extern "C" {
struct global_State;

int __real_luaG_traceexec(lua_State* state, const std::uint32_t* instruction);
int __wrap_luaG_traceexec(lua_State* state, const std::uint32_t* instruction);
void __real_luaE_setdebt(global_State* all, std::ptrdiff_t debt);
void __wrap_luaE_setdebt(global_State* all, std::ptrdiff_t debt);
void __wrap_luaD_shrinkstack(lua_State* state);
unsigned __wrap_luaS_hash(const char* text, std::size_t size, unsigned seed);
const void* __real_luaT_gettm(void* metatable, int event, void* name);
const void* __wrap_luaT_gettm(void* metatable, int event, void* name);

/// The machine looks for a hook. 0: it need not look again before the next loop, call or return.
int __wrap_luaG_traceexec(lua_State* state, const std::uint32_t* instruction) {
  Interpreter& in = Interpreter::of(state);
  if (--in.steps().left >= 0) return 0;
  lua_sethook(state, &Interpreter::look, LUA_MASKCOUNT, 1);
  (void)__real_luaG_traceexec(state, instruction);  // calls the hook, in which anything may be done
  return 0;
}

/// What is allocated asks for no collection: it would make the machine look once more. The interpreter collects.
void __wrap_luaE_setdebt(global_State* all, std::ptrdiff_t) {
  __real_luaE_setdebt(all, PTRDIFF_MIN / 2);
}

/// The collector leaves stacks as long as they are, so that what a coroutine allocates does not depend on when it came.
void __wrap_luaD_shrinkstack(lua_State*) {}

/// Fields of metatables. When memory is collected is not the same in every run, so that no script may see it: entries
/// of weak tables stay, and scripts' __gc are called at the end of their robot (Interpreter::finalize_last). Only
/// functions of Lua's own library, which close files, are called by the collector.
const void* __wrap_luaT_gettm(void* metatable, int event, void* name) {
  constexpr int kGc = 2, kMode = 3;                   // in Lua 5.4
  constexpr unsigned char kFunctionOfLibrary = 0x16;  // … the type of a function in C without upvalues
  if (event == kMode) return nullptr;
  const void* const found = __real_luaT_gettm(metatable, event, name);
  if (event != kGc || found == nullptr) return found;
  return static_cast<const unsigned char*>(found)[8] == kFunctionOfLibrary ? found : nullptr;
}

/// The seed of the hashes of texts, which else is an address and the time: then `#t` of a list with holes differs.
unsigned __wrap_luaS_hash(const char*, std::size_t, unsigned) {
  return 0x9E3779B9U;
}
}
