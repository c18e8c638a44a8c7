// A hook that notes its calls on the floor of the test: in the name of a file that the test gives.
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "core/loop/hook.hpp"
#include "core/space/space.hpp"

namespace {

using namespace tandem;

class Diary final : public core::Hook {
 public:
  struct Params {
    std::string path;
    std::int64_t done_at = -1;
    std::int64_t throw_at = -1;
    bool shift = false;
    void describe(hal::ParamVisitor& v) {
      v.text("path", path, "File to write the calls to.");
      v.integer("done_at", done_at, hal::kAny, "Ends the run before this tick.");
      v.integer("throw_at", throw_at, hal::kAny, "Throws before this tick.");
      v.flag("shift", shift, "Moves the first robot by 1 m in y before tick 2.");
    }
  };
  explicit Diary(const Params& params) : params_(params), out_(params.path) {}
  void before_run(core::HookContext& c) override { out_ << "before_run " << c.space.robot_count() << "\n"; }
  void before_step(core::HookContext& c) override {
    if (c.tick == params_.throw_at) throw std::runtime_error("no more");
    if (params_.shift && c.tick == 2) {
      core::Pose pose = c.space.pose(c.space.robot(0));
      pose.y_m += 1.0;
      c.space.set_pose(c.space.robot(0), pose);
    }
    out_ << "before_step " << c.tick << "\n";
  }
  void after_step(core::HookContext& c) override { out_ << "after_step " << c.tick << "\n"; }
  bool is_done(core::HookContext& c) override { return c.tick == params_.done_at; }
  void after_run(core::HookContext& c) override { out_ << "after_run " << c.tick << "\n"; }
  double floor(double x_m, double /*y_m*/) override { return x_m > 0.0 ? 1.0 : 0.0; }

 private:
  Params params_;
  std::ofstream out_;
};

void register_all(hal::Registrar& registrar) {
  registrar.add("hook", "diary", &core::hook_type<Diary>("diary", "Writes its calls down."));
}

}  // namespace

TANDEM_PLUGIN(register_all)
