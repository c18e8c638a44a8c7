// A hook: counts the robots that have been east of a line, and ends the run when all have.
#include <any>
#include <set>

#include "core/hook/hook.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem;

class Doorman final : public core::Hook {
 public:
  struct Params {
    double line_m = 0.5;
    void describe(hal::ParamVisitor& v) {
      v.number("line", line_m, hal::unit::m, hal::kAny, "Where the line is: x in the arena.");
    }
  };
  explicit Doorman(const Params& params) : params_(params) {}

  void after_step(core::HookContext& run) override {
    for (std::size_t i = 0; i < run.space.robot_count(); ++i) {
      const core::RobotId robot = run.space.robot(i);
      if (run.space.pose(robot).x_m > params_.line_m) passed_.insert(run.space.robot_name(robot));
    }
    run.measures.set("passed", static_cast<double>(passed_.size()));
  }
  bool is_done(core::HookContext& run) override { return passed_.size() == run.space.robot_count(); }

  // What later calls depend on, for checkpoints.
  std::any save() const override { return passed_; }
  void restore(const std::any& saved) override { passed_ = std::any_cast<const std::set<std::string>&>(saved); }

 private:
  Params params_;
  std::set<std::string> passed_;
};

void register_all(hal::Registrar& registrar) {
  registrar.add(core::hook_type<Doorman>("doorman", "Counts the robots that pass a line."));
}

}  // namespace

TANDEM_PLUGIN(register_all)
