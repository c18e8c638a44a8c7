// Logs robots' odometry beside their true poses.
#pragma once
#include <fstream>
#include <map>
#include <string>

#include "core/hook/hook.hpp"
#include "core/space/space.hpp"
#include "hal/params.hpp"

namespace tandem::hooks {

/// Writes a CSV file with a line for each robot whose controller takes odometry:
/// `time_s,id,x_m,y_m,heading_rad,odometry_x_m,odometry_y_m,odometry_heading_rad`, all in W: the odometry is laid on
/// the robot's pose at the start of the run. Robots that come later have no lines. After a checkpoint is restored,
/// lines go on at its time.
class OdometryLog final : public core::Hook {
 public:
  struct Params {
    std::string output;
    std::int64_t every = 1;
    void describe(hal::ParamVisitor& v) {
      v.text("output", output, "CSV file to write; empty: none.");
      v.integer("every", every, {1, 1e12}, "Ticks between lines of a robot, and between measures.");
    }
  };

  explicit OdometryLog(const Params& params) : params_(params) {}

  /// @throws std::runtime_error when the file cannot be written; so does after_run
  void before_run(core::HookContext& context) override;
  void after_step(core::HookContext& context) override;
  void after_run(core::HookContext& context) override;

 private:
  void check() const;

  Params params_;
  std::ofstream out_;
  std::map<std::string, core::Pose> starts_;  // by name
};

}  // namespace tandem::hooks
