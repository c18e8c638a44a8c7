#include "core/physics/dynamics3d/dynamics3d.hpp"

#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "core/physics/dynamics3d/world3d.hpp"

namespace tandem::core {
namespace {

constexpr double kSubStep_s = 0.02;        // at most, unless the file says otherwise
constexpr double kRotorSubStep_s = 0.005;  // … of robots with rotors: a sixth of their lag
constexpr double kGround = 1.49 / 9.81;    // friction of the ground: what dynamics2d's grips a kg with [ARGoS 3]
constexpr double kAmongObjects = 1.0;      // … of objects on one another
constexpr std::array<std::string_view, 2> kDrives = {"base", "wheels"};
constexpr std::array<std::string_view, 2> kFlights = {"thrust", "rotors"};

struct Gravity {
  double g_m_s2 = 9.81;
  void describe(hal::ParamVisitor& v) {
    v.number("g", g_m_s2, hal::unit::m_s2, {0.0, 1000.0}, "Acceleration of free fall.");
  }
};

struct FloorParams {
  double friction = -1.0;
  double height_m = 0.0;
  void describe(hal::ParamVisitor& v) {
    v.number("friction", friction, hal::unit::none, {-1.0, 100.0},
             "Coulomb's coefficient of objects on the floor. Negative: default_friction.");
    v.number("height", height_m, hal::unit::m, {-1e6, 1e6}, "Where the floor is.");
  }
};

struct Params {
  std::int64_t iterations = 0;
  double default_friction = -1.0;
  double robot_friction = 0.1;
  double wheel_friction = 1.0;
  std::string drive = "base";
  std::string flight = "thrust";
  std::int64_t solver_iterations = 0;
  double solver_error_m_s = 0.0;
  double erp = 0.2;
  double cfm = 1e-10;
  Gravity gravity;
  FloorParams floor;

  void describe(hal::ParamVisitor& v) {
    v.integer("iterations", iterations, {0, 1000},
              "Sub-steps a tick. 0: as few as last 20 ms at most; 5 ms with flight=\"rotors\".");
    v.number("default_friction", default_friction, hal::unit::none, {-1.0, 100.0},
             "Coulomb's coefficient between objects that touch, and of objects on the floor unless <floor> says "
             "otherwise. Negative: 1 between objects, and on the floor what the ground of dynamics2d has: 1.49 N a kg, "
             "which is a coefficient of 0.152.");
    v.number("robot_friction", robot_friction, hal::unit::none, {0.0, 100.0},
             "Coulomb's coefficient between a robot's side and whatever it touches.");
    v.number("wheel_friction", wheel_friction, hal::unit::none, {0.0, 100.0},
             "Coulomb's coefficient of wheels that turn on the floor.");
    v.choice("drive", drive, kDrives,
             "base: a robot on the ground is an upright cylinder, driven over the floor with the force of its wheels. "
             "wheels: it stands on two wheels that turn, and slips and tips as these let it; some 20 times slower.");
    v.choice("flight", flight, kFlights,
             "thrust: a robot that flies is an upright cylinder with a thrust of limited strength in any direction. "
             "rotors: it is a body that leans, with four rotors that lag behind; some 10 times slower.");
    v.integer("solver_iterations", solver_iterations, {0, 10000},
              "ODE's passes over all constraints, a sub-step, to begin with. 0: 30; 240 with drive=\"wheels\".");
    v.number("solver_error", solver_error_m_s, hal::unit::m_s, {0.0, 100.0},
             "Bodies whose velocities are farther off than this from what contacts, joints and drives ask for are "
             "solved again, with three times as many passes, up to 2,500. 0: 10 mm/s; 1 mm/s with drive=\"wheels\".");
    v.number("erp", erp, hal::unit::none, {0.0, 1.0}, "Share of an overlap that ODE takes back in a sub-step.");
    v.number("cfm", cfm, hal::unit::none, {0.0, 1.0}, "How far ODE lets constraints give way, per newton, in m/s.");
    v.group("gravity", gravity, "Gravity.");
    v.group("floor", floor, "The floor.");
  }
};

std::shared_ptr<const void> read(const Element& options, Problems& problems) {
  return std::make_shared<Params>(read_settings<Params>(options, problems, {"id", "regions"}, {"boundaries"}));
}

World3dSettings settings_for(const Params& params, double tick_s) {
  World3dSettings settings;
  settings.wheels = params.drive == "wheels";
  settings.rotors = params.flight == "rotors";
  const double longest_s = settings.rotors ? kRotorSubStep_s : kSubStep_s;
  settings.sub_steps = params.iterations > 0
                           ? params.iterations
                           : std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(tick_s / longest_s - 1e-6)));
  settings.gravity_m_s2 = params.gravity.g_m_s2;
  settings.surfaces.floor_m = params.floor.height_m;
  const auto given = [](double coefficient, double otherwise) { return coefficient < 0.0 ? otherwise : coefficient; };
  settings.surfaces.floor_friction = given(params.floor.friction, given(params.default_friction, kGround));
  settings.surfaces.object_friction = given(params.default_friction, kAmongObjects);
  settings.surfaces.wheel_friction = params.wheel_friction;
  settings.surfaces.robot_friction = params.robot_friction;
  settings.solver_iterations = params.solver_iterations > 0 ? params.solver_iterations : settings.wheels ? 240 : 30;
  settings.solver_error_m_s = params.solver_error_m_s > 0.0 ? params.solver_error_m_s : settings.wheels ? 1e-3 : 1e-2;
  settings.erp = params.erp;
  settings.cfm = params.cfm;
  return settings;
}

}  // namespace

namespace {

constexpr double kThinnest_m = 1e-4;

std::string unfit(const Object& o) {
  const bool round = o.kind == Object::Kind::Cylinder;
  return beyond_limits(
      "dynamics3d", o,
      {2.0 * (round ? o.radius_m : o.half_x_m), 2.0 * (round ? o.radius_m : o.half_y_m), o.z_high_m - o.z_low_m},
      kThinnest_m);
}

}  // namespace

const EngineType& dynamics3d_type() {
  static const EngineType type = [] {
    EngineType t;
    t.kind = "dynamics3d";
    t.summary = "Masses, forces, friction and gravity in space, on ODE.";
    t.traits = {.plane = false, .forces = true, .joints = kEveryJoint};
    t.read = &read;
    t.describe = [](hal::ParamVisitor& visitor) { Params{}.describe(visitor); };
    t.gravity = [](const void* params) { return static_cast<const Params*>(params)->gravity.g_m_s2; };
    t.unfit = &unfit;
    t.make = &make_solvers;
    t.make_solver = [](const std::shared_ptr<const void>& params, const SpaceStores&, const Region&,
                       double tick_s) -> std::unique_ptr<Solver> {
      return std::make_unique<World3d>(settings_for(*static_cast<const Params*>(params.get()), tick_s));
    };
    return t;
  }();
  return type;
}

}  // namespace tandem::core
