// Controllers written in Lua, with the functions and tables of ARGoS' Lua scripts: docs/lua.md.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "controllers/lua_controller/interpreter.hpp"
#include "hal/controller.hpp"

namespace tandem::controllers::lua {

class Interpreters;

/// A robot under a script. Robots whose controllers lie beside each other share an interpreter, and each has variables
/// of its own there. A copy keeps what the variables were; it puts them back when it is stepped.
class LuaController final : public hal::Controller {
 public:
  struct Params {
    Params();
    std::string script;
    std::string written;  ///< the same, as it stands in the file
    bool strict = false;
    bool argos = false;     ///< numbers and readings exactly as ARGoS' scripts get them
    bool allow_io = false;  ///< files, clock and environment are the script's, too
    std::int64_t most_instructions = 100'000'000;
    std::int64_t most_memory_MiB = 16;
    std::vector<hal::NamedText> others;
    std::shared_ptr<Interpreters> interpreters;  ///< of all robots that are made with these
    void describe(hal::ParamVisitor& v);
  };

  LuaController(hal::Robot& robot, const Params& params);
  LuaController(const LuaController& other);
  LuaController& operator=(const LuaController&) = delete;
  ~LuaController() override;

  /// @throws std::runtime_error: an error of the script, with its line
  void step() override;
  bool reset(hal::Robot& robot) override;
  /// The script's files, to be changed while the run goes on (hal/source_files.hpp).
  void controls(hal::Controls& controls) override;

  /// hal::ControllerType::step_row, an interpreter at a time.
  static std::size_t step_row(std::byte* first, std::size_t stride, std::size_t begin, std::size_t count,
                              const std::uint8_t* halted, hal::StepFault& fault);

 private:
  /// What a controller and its copies have in common.
  struct Shared {
    std::shared_ptr<Interpreter> interpreter;
    Variables variables;
    LuaController* active = nullptr;  ///< whose values the variables have
    int copies = 1;
  };
  struct Row;

  void activate();
  void take(hal::Robot& robot);
  void start_outputs();
  void begin_anew(const std::vector<hal::SourceFile>& files);
  void leave() noexcept;
  void finalize(Interpreter& in, Shared& shared) noexcept;

  std::shared_ptr<Interpreters> interpreters_;
  std::shared_ptr<Shared> shared_;
  int kept_ = LUA_NOREF;  // the variables' values, while it is not active
  Account account_;       // the same
  Actor actor_;
  hal::Random first_random_{0};  // as it was before the script took any
};

}  // namespace tandem::controllers::lua
