// A Lua interpreter that the robots of one block share, each with variables of its own.
//
// The script is compiled once. It is run once a robot, with an environment of that robot's, so that globals, and the
// locals of the file, are each robot's own, while the code, the libraries and the readings of sensors are there once:
// they stay in the cache from one robot's step to the next. What a robot writes into a table that others have too is
// its own from then on (own_tables.hpp). What a call may take is counted by the robot (limits.hpp, memory.hpp).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "controllers/lua_controller/limits.hpp"
#include "controllers/lua_controller/lua.hpp"
#include "controllers/lua_controller/memory.hpp"
#include "hal/device_list.hpp"
#include "hal/open_params.hpp"
#include "hal/port.hpp"
#include "hal/random.hpp"
#include "hal/robot.hpp"
#include "hal/robot_log.hpp"
#include "hal/source_files.hpp"

namespace tandem::controllers::lua {

struct DeviceApi;  // devices.hpp

/// What a script is run with; the same for all robots of an interpreter.
struct Script {
  std::string path;
  std::vector<hal::SourceFile> files;  ///< itself, and modules that it names
  bool strict = false, argos = false, allow_io = false;
  std::int64_t most_instructions = 0;  ///< of one call: Steps
  std::uint64_t most_memory =
      0;  ///< bytes that a robot keeps from call to call; a call may take kMemoryOfCall times as much
  std::vector<hal::NamedText> params;  ///< robot.params

  static constexpr std::uint64_t kMemoryOfCall = 16;

  const std::string& text() const { return files.front().text; }
  /// A file by its name beneath the folder: of `files`, or of the disk. False: there is none.
  bool read(const std::string& name, std::string& found_path, std::string& found_text) const;
};

/// A device of the configuration, as this interpreter's scripts see it.
struct Device {
  const hal::PortType* type = nullptr;
  std::string written;             ///< in the file
  const DeviceApi* api = nullptr;  ///< what ARGoS calls it; null: it has the generic binding alone
  std::vector<std::size_t> order;  ///< of rings: Tandem's number of a sensor, by ARGoS' number
  int table = LUA_NOREF;           ///< its table below `robot`
  int filler = LUA_NOREF;          ///< function that takes the readings of a ring
  std::size_t entries = 0;         ///< in its list now
};

/// What the functions of a script act on: the robot whose turn it is. A value.
struct Actor {
  static constexpr std::size_t kMostDevices = 48;
  std::array<void*, kMostDevices> ports{};  ///< in the order of the interpreter's devices
  hal::Random random{0};
  std::uint64_t run_seed = 0;
  hal::RobotLog log;
  std::string id;
  double left_m = 0.0, right_m = 0.0;  ///< that the wheels had rolled before
  bool omni_on = false, perspective_on = false;
};

/// The variables of one robot in its interpreter.
struct Variables {
  int globals = LUA_NOREF;  ///< the environment of its functions
  int own = LUA_NOREF;      ///< what belongs to it besides: fields in shared tables, modules, params
  int strings = LUA_NOREF;  ///< the library of texts, where it has changed it: what "x":name() looks in
  Account account = {};
  const std::byte* hot = nullptr;  ///< where what its step uses lies together
  std::size_t hot_bytes = 0;

  /// Called a turn before: then it is in the cache.
  [[gnu::always_inline]] void prefetch() const noexcept {  // not inline, GCC leaves it out: it returns nothing
    for (std::size_t at = 0; at < hot_bytes; at += 64) __builtin_prefetch(hot + at);
  }
};

/// Of "walk.lua:12: " at the beginning of an error; 0: it names no place.
std::size_t length_of_place(std::string_view text) noexcept;

class Interpreter {
 public:
  /// @throws std::runtime_error: the script does not compile
  Interpreter(std::shared_ptr<const Script> script, const hal::RobotKind& kind,
              const std::vector<hal::ListedDevice>& devices);
  ~Interpreter();
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  /// Held by callers of anything below.
  std::mutex& lock() noexcept { return lock_; }

  const std::vector<Device>& devices() const noexcept { return devices_; }
  const hal::RobotKind& kind() const noexcept { return kind_; }
  const Script& script() const noexcept { return *script_; }
  const std::shared_ptr<const Script>& shared_script() const noexcept { return script_; }

  /// Runs the script for a new robot, and its `init`. @throws std::runtime_error
  Variables begin(Actor& actor);
  /// Calls a function of the script without arguments; false where it has none. @throws std::runtime_error
  bool call(Actor& actor, Variables& variables, const char* function);
  bool has(Variables& variables, const char* function);
  /// Calls `__gc` of the robot's last object that has such a metatable, once; false: there is none. @throws
  /// std::runtime_error
  bool finalize_last(Actor& actor, Variables& variables);
  void end(Variables& variables) noexcept;

  /// One after the other, `next(job, …)` names a robot and its variables, until it says null; their `step` is called.
  /// Empty: all were; else what went wrong with the last that was named.
  struct Turn {
    Actor* actor = nullptr;
    Variables* variables = nullptr;
  };
  std::string step(Turn (*next)(void* job), void* job) noexcept;

  /// Everything that a robot's functions can change, as it is now; to be given back with `forget`.
  /// @throws std::runtime_error: something cannot be kept
  int keep(Variables& variables);
  /// Puts that back. @throws std::runtime_error
  void put_back(Variables& variables, int kept);
  int share(int kept);
  void forget(int kept) noexcept;

  // For functions that scripts call.
  static Interpreter& of(lua_State* state) noexcept { return **static_cast<Interpreter**>(lua_getextraspace(state)); }
  Actor& actor() noexcept { return *actor_; }
  Device& device(std::size_t index) noexcept { return devices_[index]; }
  bool filling() const noexcept { return filling_; }
  /// Warns, once, where a port had no room for `dropped` things.
  void tell_dropped(std::uint32_t dropped, const char* what);
  /// Pushes the table of what is the present robot's own.
  void push_own(lua_State* state) noexcept { lua_rawgeti(state, LUA_REGISTRYINDEX, variables_->own); }
  void push_globals(lua_State* state) noexcept { lua_rawgeti(state, LUA_REGISTRYINDEX, variables_->globals); }
  /// Pushes the compiled chunk of a text, which takes its environment as its only argument, or an error message.
  bool compile(lua_State* state, std::string_view text, const char* name) noexcept;
  /// The same for a file that all robots of the interpreter have, in the table "tandem.files" under `file`: who asks
  /// first is not charged for it.
  bool compile_for_all(lua_State* state, std::string_view text, const char* name, const char* file) noexcept;
  /// Pushes the present robot's own instance of a library, which its globals hold from then on; false where there is
  /// none of that name.
  bool push_library(lua_State* state, const char* name);
  /// A late copy of the present robot's has become a copy in full.
  void became_own(lua_State* state);

  Steps& steps() noexcept { return steps_; }
  /// Counts what a library function does; raises an error when the call has had all its steps.
  void spend(lua_State* state, std::int64_t count) {
    steps_.left -= count;
    if (steps_.left < 0) exhausted(state);
  }
  /// Raises the error of a call that is over, at the place whose text is on the top.
  int stop(lua_State* state);
  /// While `on` is false a coroutine runs.
  bool set_on_main(bool on) noexcept {
    const bool before = on_main_;
    on_main_ = on;
    memory_.set_on_main(on);
    return before;
  }
  /// Lua's hook, which is called when the steps that were granted are done.
  static void look(lua_State* state, lua_Debug* where);

 private:
  /// Marks that the interpreter is used.
  class Call {
   public:
    explicit Call(Interpreter& in) : in_(in) { in.set_on_main(true); }
    ~Call() { in_.leave(); }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

   private:
    Interpreter& in_;
  };
  static int protected_step(lua_State* state);
  static int protected_setup(lua_State* state);
  static int protected_begin(lua_State* state);
  static int protected_keep(lua_State* state);
  static int protected_put_back(lua_State* state);
  static int unknown_global(lua_State* state);

  void leave() noexcept;
  void setup(lua_State* state);
  void setup_robot(lua_State* state);
  void setup_globals(lua_State* state);
  void note_shared(lua_State* state);
  void push_robot(lua_State* state);
  void fill(lua_State* state);
  void run(lua_State* state, int arguments);
  void exhausted(lua_State* state);
  void collect(lua_State* state) noexcept;
  std::uint64_t measured(lua_State* state);
  void check_kept(lua_State* state);
  void select_strings(lua_State* state, int strings);
  void find_strings(lua_State* state, Variables& variables);
  void empty(const Variables& variables) noexcept;
  std::string taken_message();
  std::vector<std::string> shared_names();
  void protect(lua_CFunction function, void* argument);

  std::shared_ptr<const Script> script_;
  const hal::RobotKind& kind_;
  std::vector<Device> devices_;
  std::vector<std::size_t> filled_;  // numbers of the devices that have readings
  Steps steps_;
  Memory memory_{steps_};
  lua_State* state_ = nullptr;
  std::mutex lock_;

  Actor* actor_ = nullptr;
  Variables* variables_ = nullptr;
  bool filling_ = false, on_main_ = true, dropped_told_ = false;
  // Tables of originals and of what all have: libraries, parts of `robot`, functions; what else is no robot's state.
  int chunk_ = LUA_NOREF, globals_meta_ = LUA_NOREF, libraries_ = LUA_NOREF, parts_ = LUA_NOREF, shared_ = LUA_NOREF,
      direct_ = LUA_NOREF, common_ = LUA_NOREF, strings_ = LUA_NOREF;
  static constexpr int kUnknown = -100;
  int globals_of_one_ = 0;       // room for so many, in every interpreter of the script alike
  int strings_now_ = LUA_NOREF;  // whose library of texts "x":name() looks in
};

}  // namespace tandem::controllers::lua
