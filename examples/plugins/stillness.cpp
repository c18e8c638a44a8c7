// A part of a run: looks at the world after every tick, and ends the run when nothing moves any more.
#include <algorithm>
#include <vector>

#include "core/run/part_type.hpp"
#include "hal/elementary.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem;

class Stillness final : public core::RunPart {
 public:
  struct Params {
    double seconds = 5.0, within_m = 0.001;
    void describe(hal::ParamVisitor& v) {
      v.number("seconds", seconds, hal::unit::s, {0.1, 1e6}, "For how long no robot is to move.");
      v.number("within", within_m, hal::unit::m, {0.0, 1.0}, "How far a robot may be from where it stood before.");
    }
  };
  Stillness(const Params& params, core::Run&) : params_(params) {}

  std::string_view name() const override { return "stillness"; }
  core::RunTurn turn() const override { return core::RunTurn::Added; }

  bool before_tick(core::Run& run) override {
    const double still_s = hal::to_seconds(hal::time_of_tick(still_ticks_, run.world().ticks_per_second()));
    return still_s < params_.seconds;
  }
  bool after_tick(core::Run& run) override {
    const core::Space& space = run.world().space();
    const std::size_t robots = space.robot_count();
    bool still = robots == stood_.size();
    stood_.resize(robots);
    for (std::size_t i = 0; i < robots; ++i) {
      const core::Pose pose = space.pose(space.robot(i));
      still = still && hal::hypot(pose.x_m - stood_[i].x_m, pose.y_m - stood_[i].y_m) <= params_.within_m;
    }
    if (!still) {
      for (std::size_t i = 0; i < robots; ++i) stood_[i] = space.pose(space.robot(i));
    }
    still_ticks_ = still ? still_ticks_ + 1 : 0;
    return true;
  }

 private:
  Params params_;
  std::vector<core::Pose> stood_;  // when the last one moved
  hal::Tick still_ticks_ = 0;
};

void register_all(hal::Registrar& registrar) {
  static const core::RunPartType type =
      core::run_part_type<Stillness>("stillness", "Ends a run when no robot has moved for a while.");
  registrar.add(type);
}

}  // namespace

TANDEM_PLUGIN(register_all)
