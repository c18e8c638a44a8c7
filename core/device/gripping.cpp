// Gripping: joints between robots and what is before their claws, and turrets that carry a load.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/device/coupling.hpp"
#include "core/space/mechanisms.hpp"
#include "core/space/sight.hpp"
#include "hal/angle.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/turret.hpp"

namespace tandem::core {
namespace {

constexpr double kThere_rad = 0.005;  // a turret this near to its target has arrived
constexpr double kUpright = 0.95;     // cosine of the tilt from which claws find no hold

/// Where a body is, for gripping.
struct Place {
  double x_m, y_m, cos_h, sin_h;
  double low_m;  ///< of its base
};

Place place_of(const SpaceStores& s, BodyKey body) noexcept {
  const std::size_t i = body.index();
  if (body.is_object()) {
    const Object& o = s.objects[i];
    return {o.x_m, o.y_m, o.cos_h, o.sin_h, o.z_low_m};
  }
  return {s.bodies.x_m[i], s.bodies.y_m[i], s.bodies.cos_h[i], s.bodies.sin_h[i], s.base_m(i)};
}

std::uint16_t region_of(const SpaceStores& s, BodyKey body) noexcept {
  return body.is_object() ? s.object_region[body.index()] : s.bodies.region[body.index()];
}

/// Whether the body's engine can hold it.
bool in_joints(const SpaceStores& s, BodyKey body) noexcept {
  const std::uint16_t region = region_of(s, body);
  return region != kNoRegion && (s.regions[region].joints & kJointsOfGrips) == kJointsOfGrips;
}

bool upright(const SpaceStores& s, BodyKey body) noexcept {
  const std::uint16_t region = region_of(s, body);
  if (region == kNoRegion || s.regions[region].plane) return true;
  const auto& q = body.is_object() ? s.object_motion[body.index()].q_WB : s.bodies.motion[body.index()].q_WB;
  return 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]) >= kUpright;
}

/// Heading of b relative to a.
double turn_between(const Place& a, const Place& b) noexcept {
  return std::atan2(b.sin_h * a.cos_h - b.cos_h * a.sin_h, b.cos_h * a.cos_h + b.sin_h * a.sin_h);
}

constexpr double kMisses = std::numeric_limits<double>::infinity();

/// How far along the ray from (0, 0) with unit direction (dx, dy) a disc begins.
double along_to_disc(double cx, double cy, double radius, double dx, double dy) noexcept {
  const double along = cx * dx + cy * dy;
  const double aside = cx * dy - cy * dx;
  const double half2 = radius * radius - aside * aside;
  if (half2 <= 0.0) return kMisses;
  const double half = std::sqrt(half2);
  return along + half <= 0.0 ? kMisses : std::max(0.0, along - half);
}

double along_to_box(const Object& box, double cx, double cy, double dx, double dy) noexcept {
  const double p[2] = {-(box.cos_h * cx + box.sin_h * cy), -(box.cos_h * cy - box.sin_h * cx)};
  const double v[2] = {box.cos_h * dx + box.sin_h * dy, box.cos_h * dy - box.sin_h * dx};
  const double half[2] = {box.half_x_m, box.half_y_m};
  double enter = 0.0;
  double leave = kMisses;
  for (int k = 0; k < 2; ++k) {
    if (std::fabs(v[k]) < 1e-12) {
      if (std::fabs(p[k]) > half[k]) return kMisses;
      continue;
    }
    const double a = (-half[k] - p[k]) / v[k];
    const double b = (half[k] - p[k]) / v[k];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return leave > enter ? enter : kMisses;
}

/// One look for something to hold.
struct Search {
  const SpaceStores& s;
  std::size_t row;
  Place at;
  double dx, dy;     // where the claws point, in W
  double height_m;   // of the claws
  double nearest_m;  // of what was found, from the robot's axis; at first what the claws reach
  BodyKey found{};
  bool can_hold = false;

  void offer(BodyKey body, double along_m, bool holdable) noexcept {
    if (along_m > nearest_m || (along_m == nearest_m && found < body)) return;
    nearest_m = along_m;
    found = body;
    can_hold = holdable;
  }
  void robots() noexcept {
    s.body_index.for_each_near(at.x_m, at.y_m, nearest_m + widest_body_m(s), [&](const IndexEntry& o) {
      const std::size_t other = o.row();
      const std::uint8_t flags = s.bodies.flags[other];
      if (other == row || (flags & kAlive) == 0) return;
      const hal::RobotKind& kind = s.kind_of_row(other);
      const Place there = place_of(s, BodyKey::robot(other));
      if (height_m < there.low_m || height_m > there.low_m + kind.body.height_m) return;
      const bool holdable = (flags & kExternal) == 0 && kind.part<hal::GripperPart>() != nullptr;
      const double along = along_to_disc(there.x_m - at.x_m, there.y_m - at.y_m, kind.body.radius_m, dx, dy);
      offer(BodyKey::robot(other), along, holdable);
    });
  }
  void objects() noexcept {
    s.for_each_object_near(at.x_m, at.y_m, [&](const Object& o) {
      if (!o.alive || height_m < o.z_low_m || height_m > o.z_high_m) return;
      const double cx = o.x_m - at.x_m;
      const double cy = o.y_m - at.y_m;
      const double along = o.kind == Object::Kind::Cylinder ? along_to_disc(cx, cy, o.radius_m, dx, dy)
                                                            : along_to_box(o, cx, cy, dx, dy);
      offer(BodyKey::object(static_cast<std::size_t>(&o - s.objects.data())), along, o.movable);
    });
  }
};

/// What the open claws of the robot would hold, or false.
bool find_hold(const SpaceStores& s, std::size_t row, double turret_rad, BodyKey& found, double& height_m) noexcept {
  if (s.body_index.size() == 0) return false;  // before the first tick, whose physics makes the index
  const hal::RobotKind& kind = s.kind_of_row(row);
  const hal::GripperPart& claws = *kind.part<hal::GripperPart>();
  const Place at = place_of(s, BodyKey::robot(row));
  const double c = std::cos(turret_rad);
  const double d = std::sin(turret_rad);
  Search search{s,
                row,
                at,
                at.cos_h * c - at.sin_h * d,
                at.sin_h * c + at.cos_h * d,
                at.low_m + claws.height_m,
                kind.body.radius_m + claws.reach_m};
  search.robots();
  search.objects();
  found = search.found;
  height_m = search.height_m;
  return search.can_hold && in_joints(s, search.found) && upright(s, search.found);
}

/// Slot of a new joint: one that is not in use, so that the list stays as long as the most that ever were.
std::uint32_t free_joint(SpaceStores& s) {
  const auto unused = std::find_if(s.joints.begin(), s.joints.end(), [](const Joint& j) { return !j.alive; });
  const auto number = static_cast<std::uint32_t>(unused - s.joints.begin());
  if (unused == s.joints.end()) s.joints.emplace_back();
  return number;
}

/// Joins the robot's axis with the point of the body that is there, so that what is held turns about the axis.
void take_hold(SpaceStores& s, std::size_t row, GripState& grip, BodyKey held, double height_m, double turret_rad) {
  const Place a = place_of(s, BodyKey::robot(row));
  const Place b = place_of(s, held);
  const std::uint32_t number = free_joint(s);
  Joint& joint = s.joints[number];
  const std::uint32_t generation = ++s.joint_generations;
  const double wx = a.x_m - b.x_m;
  const double wy = a.y_m - b.y_m;
  joint = {};
  joint.alive = true;
  joint.generation = generation;
  joint.a = BodyKey::robot(row);
  joint.b = held;
  joint.az_m = height_m - a.low_m;
  joint.bx_m = b.cos_h * wx + b.sin_h * wy;
  joint.by_m = b.cos_h * wy - b.sin_h * wx;
  joint.bz_m = height_m - b.low_m;
  joint.heading_rad = turn_between(a, b);
  grip.joint = number;
  grip.generation = generation;
  grip.turn_rad = hal::wrapped(turret_rad - joint.heading_rad);
  ++grip.grips;
  s.bodies_changed = true;  // both belong to one region from now on
}

/// The joint of a grip, or null when it is gone: a hook released it, or what it held went.
Joint* joint_of(SpaceStores& s, const GripState& grip) noexcept {
  if (!grip.holding() || grip.joint >= s.joints.size()) return nullptr;
  Joint& joint = s.joints[grip.joint];
  return joint.alive && joint.generation == grip.generation ? &joint : nullptr;
}

bool there(const SpaceStores& s, BodyKey body) noexcept {
  if (body.is_object()) return s.objects[body.index()].alive;
  return (s.bodies.flags[body.index()] & (kAlive | kExternal)) == kAlive;
}

/// What the turret asks of the joint.
struct Drive {
  JointKind kind = JointKind::Fixed;
  double motor_torque_Nm = 0.0;
  double motor_rad_s = 0.0;
};

Drive drive_of(const TurretState& turret, const hal::TurretPart& part, double tick_s) noexcept {
  const auto drive = [&](double rad_s) {
    const double most = part.turn_rad_s;
    return Drive{JointKind::Turning, part.torque_Nm, std::clamp(rad_s, -most, most)};
  };
  switch (turret.mode) {
    case hal::TurretMode::Passive:
      return {JointKind::Turning, 0.0, 0.0};
    case hal::TurretMode::Speed:
      return turret.target == 0.0 ? Drive{} : drive(turret.target);
    case hal::TurretMode::Position: {
      const double left_rad = hal::wrapped(turret.target - turret.angle_rad);
      return std::fabs(left_rad) < kThere_rad ? Drive{} : drive(left_rad / tick_s);
    }
    case hal::TurretMode::Off:
      break;
  }
  return {};
}

/// Makes the joint do what the turret asks. Engines take over a joint of another sort as a new one.
void drive_load(SpaceStores& s, std::size_t row, GripState& grip, const TurretState& turret, Joint& joint,
                double tick_s) noexcept {
  const Drive drive = drive_of(turret, *s.kind_of_row(row).part<hal::TurretPart>(), tick_s);
  joint.form.motor_speed = drive.motor_rad_s;
  if (joint.form.kind == drive.kind && joint.form.motor_most == drive.motor_torque_Nm) return;
  joint.form.kind = drive.kind;
  joint.form.motor_most = drive.motor_torque_Nm;
  joint.heading_rad = turn_between(place_of(s, joint.a), place_of(s, joint.b));
  grip.generation = joint.generation = ++s.joint_generations;
}

/// `turret`: null where the gripper sits on none.
void treat(SpaceStores& s, std::size_t row, GripState& grip, const TurretState* turret, double tick_s) {
  Joint* joint = joint_of(s, grip);
  if (joint == nullptr) grip.joint = GripState::kNothing;
  const BodyKey self = BodyKey::robot(row);
  if (joint != nullptr && !(grip.wants && there(s, joint->a) && there(s, joint->b) && in_joints(s, self))) {
    joint->alive = false;
    joint = nullptr;
    grip.joint = GripState::kNothing;
  }
  if (grip.wants && !grip.slips && joint == nullptr && there(s, self) && in_joints(s, self)) {
    const double turret_rad = turret == nullptr ? 0.0 : turret->angle_rad;
    BodyKey found;
    double height_m = 0.0;
    if (find_hold(s, row, turret_rad, found, height_m)) take_hold(s, row, grip, found, height_m, turret_rad);
    joint = joint_of(s, grip);
  }
  if (joint != nullptr && turret != nullptr) drive_load(s, row, grip, *turret, *joint, tick_s);
}

/// After every gripper and turret took its command: claws that opened take hold of the nearest body before them, those
/// that closed let go, and joints follow what the turrets were told.
///
/// Open claws hold the first thing that the line from the robot's rim outwards meets within the gripper's reach, at
/// the claws' height: a movable box or cylinder, or a robot whose kind has a gripper itself. They keep trying while
/// nothing is there. What they hold turns with the turret: firmly while that is off or has arrived, freely while it is
/// passive, else with the turret's motor. Robots whose pose comes from outside neither hold nor are held.
///
/// After physics, turrets that carry a load look where the load went.
class Gripping final : public Coupling {
 public:
  explicit Gripping(Columns& columns) : grips_(columns.of<GripState>()), turrets_(columns.of<TurretState>()) {}

  void before_physics(SpaceStores& stores, double tick_s) override {
    each(stores, [&](std::size_t row, GripState& grip, TurretState* turret) {
      if (grip.wants || grip.holding()) treat(stores, row, grip, turret, tick_s);
    });
  }

  void after_physics(SpaceStores& stores, double tick_s) noexcept override {
    each(stores, [&](std::size_t /*row*/, GripState& grip, TurretState* turret) {
      const Joint* joint = turret == nullptr ? nullptr : joint_of(stores, grip);
      if (joint == nullptr) return;
      const double angle_rad =
          hal::wrapped(grip.turn_rad + turn_between(place_of(stores, joint->a), place_of(stores, joint->b)));
      turret->speed_rad_s = hal::wrapped(angle_rad - turret->angle_rad) / tick_s;
      turret->angle_rad = angle_rad;
    });
  }

 private:
  template <class Visit>
  void each(SpaceStores& stores, Visit&& visit) const {
    if (grips_.empty()) return;
    for (std::size_t b = 0; b < stores.blocks.size(); ++b) {
      GripState* const grips = grips_.of_block(b);
      if (grips == nullptr) continue;
      TurretState* const turrets = turrets_.of_block(b);
      const RobotBlock& block = stores.blocks[b];
      for (std::size_t i = 0; i < block.used; ++i)
        visit(block.first_row + i, grips[i], turrets == nullptr ? nullptr : turrets + i);
    }
  }

  Column<GripState> grips_;
  Column<TurretState> turrets_;
};

}  // namespace

CouplingType gripping_type() {
  return {"gripping", "Claws take hold of what is before them; turrets turn what they hold.",
          [](Columns& columns) -> std::unique_ptr<Coupling> { return std::make_unique<Gripping>(columns); }};
}

}  // namespace tandem::core
