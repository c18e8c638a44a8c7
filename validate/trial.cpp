#include "validate/trial.hpp"

#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "core/sim/world.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/wheels.hpp"
#include "library/open_world.hpp"

namespace tandem::validate {
namespace {

struct Place {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, heading_rad = 0.0;
};

double between(const Place& a, const Place& b) {
  return std::hypot(a.x_m - b.x_m, a.y_m - b.y_m, a.z_m - b.z_m);
}

/// A turn as the nearest one to a turn before: headings have no jump.
double nearest_turn(double heading_rad, double before_rad) {
  return before_rad + std::remainder(heading_rad - before_rad, 2.0 * M_PI);
}

class Trial {
 public:
  Trial(const Scene& scene, core::World& world) : scene_(scene), world_(world), space_(world.space()) {}

  hal::Result<double> run() {
    world_.start();
    for (const Push& push : scene_.pushes) {
      const auto pushed = space_.set_object_velocity(space_.find_object(push.id), {push.velocity_m_s, {}});
      if (!pushed.ok()) return pushed.error();
    }
    begin_ = last_ = since_ = place();
    const auto per_second = static_cast<double>(world_.ticks_per_second());
    const auto ticks = static_cast<hal::Tick>(std::llround(scene_.seconds * per_second));
    const auto since = static_cast<hal::Tick>(std::llround(figure("since") * per_second));
    for (hal::Tick tick = 0; tick < ticks; ++tick) {
      command(static_cast<double>(tick) / per_second);
      world_.step();
      if (world_.state() == core::RunState::Failed) return hal::Error{world_.failure()};
      look();
      if (tick + 1 == since) since_ = last_;
    }
    world_.finish();
    return measured();
  }

 private:
  double figure(const std::string& name) const { return scene_.given.has(name) ? scene_.given(name) : 0.0; }

  Place place() const {
    if (scene_.of == "*") return {};
    if (const core::RobotId robot = space_.find_robot(scene_.of); space_.contains(robot)) {
      const core::Pose pose = space_.pose(robot);
      return {pose.x_m, pose.y_m, pose.z_m, pose.heading_rad()};
    }
    for (const core::Object& object : space_.objects())
      if (object.id == scene_.of)
        return {object.x_m, object.y_m, object.z_low_m, std::atan2(object.sin_h, object.cos_h)};
    return {NAN, NAN, NAN, NAN};
  }

  /// What is written before a step counts in it.
  void command(double time_s) {
    for (const Drive& drive : scene_.drives) {
      auto* const wheels = space_.port<hal::WheelSpeeds>(space_.find_robot(drive.id));
      if (time_s < drive.until_s - 1e-9)
        wheels->set(drive.left_m_s, drive.right_m_s);
      else
        wheels->set(0.0, 0.0);
    }
    for (const Flight& flight : scene_.flights) fly(flight, time_s);
    if (scene_.gather_m_s <= 0.0) return;
    for (std::size_t i = 0; i < space_.robot_count(); ++i) gather(space_.robot(i));
  }

  void fly(const Flight& flight, double time_s) {
    const core::RobotId robot = space_.find_robot(flight.id);
    const auto& v = flight.velocity_m_s;
    if (flight.to_m)
      space_.port<hal::QuadrotorPosition>(robot)->set((*flight.to_m)[0], (*flight.to_m)[1], (*flight.to_m)[2], 0.0);
    else if (flight.thrust)
      space_.port<hal::QuadrotorAttitude>(robot)->set(0.0, flight.pitch_rad, 0.0, *flight.thrust);
    else if (time_s < flight.until_s - 1e-9)
      space_.port<hal::QuadrotorSpeed>(robot)->set(v[0], v[1], v[2], flight.turn_rad_s);
    else
      *space_.port<hal::QuadrotorSpeed>(robot) = {};
  }

  void gather(core::RobotId robot) {
    const core::Pose pose = space_.pose(robot);
    const double off_rad = std::remainder(std::atan2(-pose.y_m, -pose.x_m) - pose.heading_rad(), 2.0 * M_PI);
    const double turn = std::clamp(off_rad, -1.0, 1.0);
    const double most = scene_.gather_m_s;
    space_.port<hal::WheelSpeeds>(robot)->set(most * std::min(1.0, 1.0 - turn), most * std::min(1.0, 1.0 + turn));
  }

  void look() {
    Place now = place();
    now.heading_rad = nearest_turn(now.heading_rad, last_.heading_rad);
    last_ = now;
    if (scene_.measure != "overlap") return;
    for (std::size_t a = 0; a < space_.robot_count(); ++a)
      for (std::size_t b = 0; b < a; ++b) look_at(space_.robot(a), space_.robot(b));
  }

  void look_at(core::RobotId a, core::RobotId b) {
    const core::Pose pa = space_.pose(a), pb = space_.pose(b);
    const double body_m = space_.kind(a).body.radius_m + space_.kind(b).body.radius_m;
    deepest_ = std::max(deepest_, 1.0 - std::hypot(pa.x_m - pb.x_m, pa.y_m - pb.y_m) / body_m);
  }

  hal::Result<double> measured() const {
    const std::string& m = scene_.measure;
    if (m == "z") return last_.z_m;
    if (m == "risen") return last_.z_m - begin_.z_m;
    if (m == "ahead") return last_.x_m - begin_.x_m;
    if (m == "way" || m == "threshold") return between(last_, begin_);
    if (m == "way_since") return between(last_, since_);
    if (m == "turned") return last_.heading_rad - begin_.heading_rad;
    if (m == "turned_since") return last_.heading_rad - since_.heading_rad;
    if (m == "overlap") return deepest_;
    if (m == "off_arc") return off_arc();
    return hal::Error{"nothing measures '" + m + "'"};
  }

  /// From where steady wheels lead from the place at `since`.
  double off_arc() const {
    const PlanarPlace arc_B = arc(figure("left"), figure("right"), figure("base"), scene_.seconds - figure("since"));
    const double c = std::cos(since_.heading_rad), s = std::sin(since_.heading_rad);
    return std::hypot(since_.x_m + c * arc_B.x_m - s * arc_B.y_m - last_.x_m,
                      since_.y_m + s * arc_B.x_m + c * arc_B.y_m - last_.y_m);
  }

  const Scene& scene_;
  core::World& world_;
  core::Space& space_;
  Place begin_, since_, last_;
  double deepest_ = 0.0;
};

hal::Result<double> run_once(const Scene& scene, const Series& series, double value,
                             const std::vector<std::string>& parameters) {
  auto opened =
      library::open_world({.file = scene.name, .text = experiment_of(scene, series, value), .parameters = parameters});
  if (!opened.ok()) return opened.error();
  return Trial(scene, opened.value()->world()).run();
}

/// The largest value of the setting with which the body still moves, to a thousandth of it.
hal::Result<double> bisect(const Scene& scene, const Series& series, double value) {
  double low = scene.bisect->low, high = scene.bisect->high;
  while (high - low > 1e-3 * high) {
    const double middle = 0.5 * (low + high);
    const auto way = run_once(scene, series, value, {fmt::format("{}={}", scene.bisect->path, middle)});
    if (!way.ok()) return way.error();
    (way.value() > scene.bisect->moved_m ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

hal::Result<double> measure(const Scene& scene, const Series& series, double value) {
  return scene.bisect ? bisect(scene, series, value) : run_once(scene, series, value, {});
}

}  // namespace tandem::validate
