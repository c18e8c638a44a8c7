// A Lua interpreter that the robots of one block share, each with variables of its own.
//
// The script is compiled once. It is run once a robot, with an environment of that robot's, so that globals, and the
// locals of the file, are each robot's own, while the code, the libraries and the table `robot` are there once: they
// stay in the cache from one robot's step to the next. The tables below `robot` are filled with a robot's readings just
// before its turn. Assigning a new field to a shared table keeps it for that robot alone.
#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <pthread.h>
#include <string>
#include <string_view>
#include <vector>

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
  bool strict = false;
  std::int64_t most_instructions = 0;  ///< of one call
  std::vector<hal::NamedText> params;  ///< robot.params

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
};

class Interpreter {
 public:
  /// @throws std::runtime_error: the script does not compile
  Interpreter(std::shared_ptr<const Script> script, const hal::RobotKind& kind,
              const std::vector<hal::ListedDevice>& devices);
  ~Interpreter();
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  /// Held by whoever calls anything below.
  std::mutex& lock() noexcept { return lock_; }

  const std::vector<Device>& devices() const noexcept { return devices_; }
  const hal::RobotKind& kind() const noexcept { return kind_; }
  const Script& script() const noexcept { return *script_; }
  const std::shared_ptr<const Script>& shared_script() const noexcept { return script_; }

  /// Runs the script for a new robot, and its `init`. @throws std::runtime_error
  Variables begin(Actor& actor);
  /// Calls a function of the script without arguments; false where it has none. @throws std::runtime_error
  bool call(Actor& actor, const Variables& variables, const char* function);
  bool has(const Variables& variables, const char* function);
  void end(const Variables& variables) noexcept;

  /// One after the other, `next(job, …)` names a robot and its variables, until it says null; their `step` is called.
  /// Empty: all were; else what went wrong with the last that was named.
  struct Turn {
    Actor* actor = nullptr;
    const Variables* variables = nullptr;
  };
  std::string step(Turn (*next)(void* job), void* job) noexcept;

  /// Everything that a robot's functions can change, as it is now; to be given back with `forget`.
  /// @throws std::runtime_error: something cannot be kept
  int keep(const Variables& variables);
  /// Puts that back. @throws std::runtime_error
  void put_back(int kept);
  int share(int kept);
  void forget(int kept) noexcept;

  // For functions that scripts call.
  static Interpreter& of(lua_State* state) noexcept { return **static_cast<Interpreter**>(lua_getextraspace(state)); }
  Actor& actor() noexcept { return *actor_; }
  Device& device(std::size_t index) noexcept { return devices_[index]; }
  bool filling() const noexcept { return filling_; }
  /// Pushes the table of what is the present robot's own.
  void push_own(lua_State* state) noexcept { lua_rawgeti(state, LUA_REGISTRYINDEX, variables_->own); }
  void push_globals(lua_State* state) noexcept { lua_rawgeti(state, LUA_REGISTRYINDEX, variables_->globals); }
  /// Pushes the compiled chunk of a text, which takes its environment as its only argument, or an error message.
  bool compile(lua_State* state, std::string_view text, const char* name) noexcept;
  /// Makes the table on the top one that robots share (see above).
  void make_shared(lua_State* state) noexcept;
  /// Which thread of the script runs: the watchdog sets its hook there.
  lua_State* running() const noexcept { return running_; }
  void set_running(lua_State* state) noexcept { running_ = state; }
  /// Whether the present call has had all its instructions.
  bool overtime() const noexcept { return overtime_; }
  int no_end(lua_State* state);  // raises the error of that, at the place whose text is on the top

  /// The watchdog's, on its own thread: makes the call count its instructions that has lasted since the last look.
  void look() noexcept;

 private:
  class Call;  // marks that a script runs
  static void count(lua_State* state, lua_Debug* where);
  static void on_signal(int) noexcept;
  static int protected_step(lua_State* state);
  static int protected_setup(lua_State* state);
  static int protected_begin(lua_State* state);
  static int protected_keep(lua_State* state);
  static int protected_put_back(lua_State* state);
  static int message(lua_State* state);

  void setup(lua_State* state);
  void check_shared(lua_State* state);
  void disarm() noexcept;
  void fill(lua_State* state);
  std::string taken_message();
  std::vector<std::string> shared_names();
  void protect(lua_CFunction function, void* argument);

  std::shared_ptr<const Script> script_;
  const hal::RobotKind& kind_;
  std::vector<Device> devices_;
  std::vector<std::size_t> filled_;  // numbers of the devices that have readings
  Memory memory_;
  lua_State* state_ = nullptr;
  std::mutex lock_;

  Actor* actor_ = nullptr;
  const Variables* variables_ = nullptr;
  bool filling_ = false;
  int chunk_ = LUA_NOREF, globals_meta_ = LUA_NOREF, shared_meta_ = LUA_NOREF, shared_ = LUA_NOREF,
      pristine_ = LUA_NOREF, direct_ = LUA_NOREF, common_ = LUA_NOREF;

  // The watchdog's.
  lua_State* running_ = nullptr;
  std::atomic<bool> armed_{false};  // instructions are counted
  bool overtime_ = false;
  std::int64_t counted_ = 0;
  std::atomic<std::uint64_t> turns_{0};
  std::uint64_t turns_seen_ = 0;
  std::mutex busy_lock_;
  bool busy_ = false;
  pthread_t thread_{};
};

}  // namespace tandem::controllers::lua
