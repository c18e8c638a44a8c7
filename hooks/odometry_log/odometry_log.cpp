#include "hooks/odometry_log/odometry_log.hpp"

#include <cmath>
#include <stdexcept>

#include "hal/angle.hpp"
#include "hal/device/wheels.hpp"
#include "hal/unit.hpp"

namespace tandem::hooks {
namespace {

/// A pose given in the frame of another, in W.
core::Pose in_world(const core::Pose& frame, const hal::Odometry& in) {
  return core::Pose::at(frame.x_m + frame.cos_h * in.x_m - frame.sin_h * in.y_m,
                        frame.y_m + frame.sin_h * in.x_m + frame.cos_h * in.y_m,
                        hal::wrapped(frame.heading_rad() + in.heading_rad));
}

std::ostream& operator<<(std::ostream& out, const core::Pose& pose) {
  return out << hal::format_number(pose.x_m) << ',' << hal::format_number(pose.y_m) << ','
             << hal::format_number(pose.heading_rad());
}

}  // namespace

void OdometryLog::check() const {
  if (!out_)
    throw std::runtime_error(params_.output + ": cannot be written; is there such a folder, and room on the disk?");
}

void OdometryLog::before_run(core::HookContext& context) {
  for (std::size_t i = 0; i < context.space.robot_count(); ++i) {
    const core::RobotId robot = context.space.robot(i);
    starts_[context.space.robot_name(robot)] = context.space.pose(robot);
  }
  if (params_.output.empty()) return;
  out_.open(params_.output);
  out_ << "time_s,id,x_m,y_m,heading_rad,odometry_x_m,odometry_y_m,odometry_heading_rad\n";
  check();
}

void OdometryLog::after_step(core::HookContext& context) {
  if ((context.tick + 1) % params_.every != 0) return;
  const double time_s = static_cast<double>(context.tick + 1) / static_cast<double>(context.ticks_per_second);
  const core::Space& space = context.space;
  double robots = 0.0, x_m = 0.0, y_m = 0.0, error_m = 0.0;
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const core::RobotId robot = space.robot(i);
    const auto* odometry = space.port<hal::Odometry>(robot);
    const auto start = starts_.find(space.robot_name(robot));
    if (odometry == nullptr || odometry->validity != hal::Validity::Fresh || start == starts_.end()) continue;
    const core::Pose pose = space.pose(robot);
    const core::Pose believed = in_world(start->second, *odometry);
    robots += 1.0;
    x_m += pose.x_m;
    y_m += pose.y_m;
    error_m += std::hypot(pose.x_m - believed.x_m, pose.y_m - believed.y_m);
    if (out_.is_open())
      out_ << hal::format_number(time_s) << ',' << start->first << ',' << pose << ',' << believed << '\n';
  }
  if (robots == 0.0) return;
  context.measures.set("x_m", x_m / robots);
  context.measures.set("y_m", y_m / robots);
  context.measures.set("odometry_error_m", error_m / robots);
}

void OdometryLog::after_run(core::HookContext&) {
  if (!out_.is_open()) return;
  out_.flush();
  check();
}

}  // namespace tandem::hooks
