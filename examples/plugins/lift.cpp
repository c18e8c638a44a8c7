// A robot that lifts boxes: an actuator with a command, its limit, state that is kept for every robot, a joint by
// which physics holds what is lifted, and what is seen of it.
#include <algorithm>
#include <cmath>

#include "core/device/coupling.hpp"
#include "core/device/describe.hpp"
#include "core/space/joint.hpp"
#include "hal/device/wheels.hpp"
#include "hal/elementary.hpp"
#include "hal/plugin.hpp"

namespace {

using namespace tandem;

// --- what the robot is built with, and what its controller commands ---

constexpr std::uint32_t kNothing = 0xFFFF'FFFFU;  // is lifted

struct LiftPart {
  static constexpr std::string_view kName = "lift";
  static constexpr std::string_view kDoc = "A fork in front that lifts boxes.";
  double reach_m = 0.0, height_m = 0.0, speed_m_s = 0.0, force_N = 0.0;
  std::string source = {};
  void describe(hal::ParamVisitor& v) {
    v.number("reach", reach_m, hal::unit::m, hal::kNotNegative, "Of the fork before the body's rim.");
    v.number("height", height_m, hal::unit::m, hal::kNotNegative, "To which it lifts.");
    v.number("speed", speed_m_s, hal::unit::m_s, hal::kNotNegative, "With which it lifts.");
    v.number("force", force_N, hal::unit::none, hal::kNotNegative, "That it lifts with, in N.");
    v.text("source", source, "Where these figures come from.");
  }
  /// The window, pictures, films and records show this: a fork, dark while it holds something, which slides upwards.
  void appear(const hal::RobotKind& kind, hal::Appearance& look) const {
    const double rim_m = kind.body.radius_m;
    look.joints.push_back({.name = "lift", .slides = true, .by = {"lift", "target"}});
    look.links.push_back({.name = "fork",
                          .shape = "fork",
                          .low_m = {0.8 * rim_m, -0.5 * rim_m, 0.0},
                          .high_m = {rim_m + reach_m, 0.5 * rim_m, 0.02},
                          .on = "lift",
                          .held = {"lift", "joint", 0, true, kNothing}});
  }
};

/// Safe value: down, which lets go.
struct LiftDrive : hal::Command {
  static constexpr std::string_view kName = "lift";
  static constexpr std::string_view kDoc = "How high the fork is to be. Above 0 it holds the box before it; 0 lets go.";
  double height_m = 0.0;

  using LimitedBy = LiftPart;
  hal::Limited limit(const LiftPart& part) noexcept {
    if (height_m >= 0.0 && height_m <= part.height_m) return hal::kPassed;
    if (!std::isfinite(height_m)) {
      *this = {};
      return hal::kNotFinite;
    }
    height_m = std::clamp(height_m, 0.0, part.height_m);
    return hal::kClamped;
  }
  void describe(hal::FieldList& f) const {
    f.add("height", height_m, hal::unit::m, hal::Frame::None, hal::Fusion::Real, "of the fork above where it rests");
  }
};

// --- what the simulation keeps for each robot: part of checkpoints and fingerprints ---

struct LiftState {
  static constexpr std::string_view kName = "lift";
  static constexpr std::string_view kDoc = "What lifts were told, and what they hold.";
  double target_m = 0.0;
  std::uint32_t joint = kNothing;  // of SpaceStores::joints
  std::uint32_t generation = 0;    // of that joint: a name that differs from run to run, so it is no state
  double from_m = 0.0;             // where the box's base was when it was taken
  void describe(hal::FieldList& f) const {
    f.add("target", target_m, hal::unit::m, "height that was commanded");
    f.add("joint", joint, hal::unit::none, "number of the joint to what is held");
    f.add("from", from_m, hal::unit::m, "height of the box when it was taken");
  }
};

class LiftActuator final : public core::Actuator {
 public:
  explicit LiftActuator(LiftState* lifts) : lifts_(lifts) {}
  void act(const core::DeviceContext& context, core::SpaceStores&, const void* ports) noexcept override {
    const auto* const drives = static_cast<const LiftDrive*>(ports);
    for (std::size_t i = 0; i < context.block.used; ++i)
      lifts_[i].target_m = core::obeys(context, i) ? drives[i].height_m : 0.0;
  }

 private:
  LiftState* lifts_;
};

// --- what ties it to the bodies: runs once a tick, over all robots in the order of their rows ---

class Lifting final : public core::Coupling {
 public:
  explicit Lifting(core::Columns& columns) : lifts_(columns.of<LiftState>()) {}

  void before_physics(core::SpaceStores& stores, double tick_s) override {
    if (lifts_.empty()) return;
    for (std::size_t block = 0; block < stores.blocks.size(); ++block) {
      LiftState* const lifts = lifts_.of_block(block);
      if (lifts == nullptr) continue;
      for (std::size_t i = 0; i < stores.blocks[block].used; ++i)
        treat(stores, stores.blocks[block].first_row + i, lifts[i], tick_s);
    }
  }

 private:
  static void treat(core::SpaceStores& stores, std::size_t row, LiftState& lift, double tick_s) {
    core::Joint* joint = lift.joint < stores.joints.size() ? &stores.joints[lift.joint] : nullptr;
    if (joint != nullptr && !(joint->alive && joint->generation == lift.generation)) joint = nullptr;  // a hook's doing
    const bool holds = lift.target_m > 0.0 && (stores.bodies.flags[row] & core::kAlive) != 0;
    if (joint != nullptr && !holds) {
      joint->alive = false;
      joint = nullptr;
    }
    if (joint == nullptr) lift.joint = kNothing;
    if (joint == nullptr && holds) joint = take(stores, row, lift);
    if (joint == nullptr) return;
    const double most_m_s = stores.kind_of_row(row).part<LiftPart>()->speed_m_s;
    const double now_m = stores.objects[joint->b.index()].z_low_m - lift.from_m;
    joint->form.motor_speed = std::clamp((lift.target_m - now_m) / tick_s, -most_m_s, most_m_s);
  }

  /// Joins the robot with the first movable box before its fork; null where there is none.
  static core::Joint* take(core::SpaceStores& stores, std::size_t row, LiftState& lift) {
    const core::Bodies& b = stores.bodies;
    const LiftPart& part = *stores.kind_of_row(row).part<LiftPart>();
    const double reach_m = stores.kind_of_row(row).body.radius_m + part.reach_m;
    const double x_m = b.x_m[row] + reach_m * b.cos_h[row], y_m = b.y_m[row] + reach_m * b.sin_h[row];
    for (std::size_t number = 0; number < stores.objects.size(); ++number) {
      const core::Object& box = stores.objects[number];
      if (!box.alive || !box.movable || box.kind != core::Object::Kind::Box) continue;
      const double dx = x_m - box.x_m, dy = y_m - box.y_m;  // of the fork's tip, from the box
      const double along_m = box.cos_h * dx + box.sin_h * dy, aside_m = box.cos_h * dy - box.sin_h * dx;
      if (std::fabs(along_m) > box.half_x_m || std::fabs(aside_m) > box.half_y_m) continue;
      const auto free =
          std::find_if(stores.joints.begin(), stores.joints.end(), [](const auto& j) { return !j.alive; });
      lift.joint = static_cast<std::uint32_t>(free - stores.joints.begin());
      if (free == stores.joints.end()) stores.joints.emplace_back();
      core::Joint& joint = stores.joints[lift.joint];
      joint = {};
      joint.alive = true;
      joint.generation = lift.generation = ++stores.joint_generations;
      joint.a = core::BodyKey::robot(row);
      joint.b = core::BodyKey::object(number);
      joint.ax_m = reach_m;
      joint.bx_m = along_m;
      joint.by_m = aside_m;
      joint.heading_rad = hal::atan2(box.sin_h * b.cos_h[row] - box.cos_h * b.sin_h[row],
                                     box.cos_h * b.cos_h[row] + box.sin_h * b.sin_h[row]);
      joint.form = {.kind = core::JointKind::Sliding,
                    .axis = {0.0, 0.0, 1.0},
                    .limited = true,
                    .low = 0.0,
                    .high = part.height_m,
                    .motor_most = part.force_N};
      lift.from_m = box.z_low_m;
      stores.bodies_changed = true;  // robot and box belong to one region from now on
      return &joint;
    }
    return nullptr;
  }

  core::Column<LiftState> lifts_;
};

constexpr core::CouplingType kLifting{
    "lifting", "Lifts take hold of the box before them and raise it.",
    [](core::Columns& columns) -> std::unique_ptr<core::Coupling> { return std::make_unique<Lifting>(columns); }};

// --- a robot with a lift, and a controller that carries what is before it ---

class Carry final : public hal::Controller {
 public:
  explicit Carry(hal::Robot& robot) : lift_(robot.actuator<LiftDrive>()), wheels_(robot.actuator<hal::WheelSpeeds>()) {}
  void step() override {
    ++step_;
    lift_.height_m = step_ < 80 ? 0.05 : 0.0;  // lift, drive a way, put down, go back
    const double speed_m_s = step_ < 20 ? 0.0 : step_ < 70 ? 0.1 : step_ < 90 ? 0.0 : -0.05;
    wheels_.set(speed_m_s, speed_m_s);
  }

 private:
  LiftDrive& lift_;
  hal::WheelSpeeds& wheels_;
  int step_ = 0;
};

hal::RobotKind porter() {
  hal::RobotKind kind;
  kind.name = "porter";
  kind.summary = "A robot on wheels with a lift.";
  kind.body = {.radius_m = 0.15, .height_m = 0.2, .mass_kg = 5.0, .source = "the drawing of its frame"};
  kind.locomotion = hal::DifferentialDrive{.wheel_radius_m = 0.05,
                                           .wheel_base_m = 0.25,
                                           .max_speed_m_s = 0.5,
                                           .force_N = 20.0,
                                           .torque_Nm = 2.0,
                                           .source = "data sheet of its motors"};
  kind.add(LiftPart{.reach_m = 0.05, .height_m = 0.1, .speed_m_s = 0.05, .force_N = 30.0, .source = "its data sheet"});
  return kind;
}

void register_all(hal::Registrar& registrar) {
  static const hal::RobotKind robot = porter();
  static const core::DeviceType device = [] {
    struct None {
      void describe(hal::ParamVisitor&) {}
    };
    const auto make = [](const core::Element& element, core::Problems& problems,
                         const core::DeviceSetup&) -> core::BlockFactory<core::Actuator> {
      core::read_options<None>(element, problems);
      return {
          [](const core::BlockColumns& columns) { return std::make_unique<LiftActuator>(columns.find<LiftState>()); },
          {core::keeps<LiftState>()}};
    };
    core::DeviceType type =
        core::actuator_type(LiftDrive::kName, "default", "Takes hold of the box before it, and raises it.",
                            &core::has<LiftPart>, make, &core::describe_options<None>);
    type.joints = core::bit(core::JointKind::Sliding);  // robots with a lift need an engine that has such
    return type;
  }();
  registrar.add(hal::part_type<LiftPart>());
  registrar.add(hal::port_type<LiftDrive>());
  registrar.add(device);
  registrar.add(kLifting);
  registrar.add(robot);
  registrar.add_controller<Carry>("carry", "Carries the box before it a way, and puts it down.");
}

}  // namespace

TANDEM_PLUGIN(register_all)
