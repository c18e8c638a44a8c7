#include "core/physics/particle3d/particle3d.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/physics/crowd_passes.hpp"
#include "core/physics/near_pairs.hpp"
#include "core/physics/particle3d/solid.hpp"
#include "core/physics/wheels.hpp"
#include "hal/angle.hpp"

namespace tandem::core {
namespace {

using particle3d::Mover;
using particle3d::Solid;

constexpr double kHop = 0.5;         // of one sub-step at full speed, in body radii
constexpr double kSlack_m = 0.02;    // that others may push a body in a tick
constexpr double kResponse_s = 0.2;  // in which a robot near its target closes in on it
constexpr double kBrakeShare = 0.7;  // of the acceleration that braking counts on: the rest is for the way across
constexpr double kOnGround_m = 1e-9;
constexpr double kFastest_m_s = 1000.0;  // faster ones are an error of whoever set their speed
constexpr double kFarthest_m = 1e7;
constexpr std::array<std::string_view, 2> kFlights = {"point_mass", "exact"};

struct Params {
  std::int64_t iterations = 5;
  double gravity_m_s2 = 9.81;
  double drag_per_s = 0.4;
  std::string flight = "point_mass";
  void describe(hal::ParamVisitor& v) {
    v.integer(
        "iterations", iterations, {1, 1000},
        "Sub-steps of a tick, at least; in each, contacts are resolved once. More where bodies would jump over one "
        "another.");
    v.number("gravity", gravity_m_s2, hal::unit::m_s2, {0.0, 1000.0}, "What pulls down those that do not fly.");
    // 0.4 /s: between the 0.54 and 0.39 /s identified for a small quadrotor's axes [Faessler et al. 2018,
    // "Differential flatness of quadrotor dynamics subject to rotor drag", IEEE RA-L 3(2)].
    v.number("drag", drag_per_s, hal::unit::none, {0.0, 1000.0},
             "Deceleration by the air for each m/s of a body's speed, in 1/s; robots that drive have none.");
    v.choice(
        "flight", flight, kFlights,
        "point_mass: what flies has limits of speed and acceleration, and the air slows it down. exact: it has any "
        "velocity up to its limit at once, and flies straight to its place; the cheapest.");
  }
};

/// Exact motion over one sub-step under constant acceleration a and drag -k v.
struct SubStep {
  double h_s;
  double keeps;   ///< share of the speed that is left
  double coasts;  ///< way for each m/s of speed, in s; also speed for each m/s^2 of acceleration
  double gains;   ///< way for each m/s^2, in s^2

  SubStep(double h, double k) : h_s(h) {
    const double kh = k * h;
    keeps = std::exp(-kh);
    coasts = kh > 0.0 ? -std::expm1(-kh) / k : h;
    gains = kh > 1e-4 ? (h - coasts) / k : h * h * (0.5 - kh * (1.0 / 6 - kh / 24));
  }
};

/// Bodies of the tick, one array a quantity, in the order of their keys.
struct Particles {
  std::vector<std::uint32_t> row;
  std::vector<double> x, y, z, vx, vy, vz, c, s;
  std::vector<double> from_x, from_y, from_z;      // at the tick's start
  std::vector<double> step_x, step_y, step_z;      // at the sub-step's start, of those that may meet something
  std::vector<double> push_x, push_y, push_z;      // away from others, in this sub-step
  std::vector<double> goal_x, goal_y, goal_z;      // place or velocity
  std::vector<double> to_place, thrust;            // 1 or 0
  std::vector<double> low, high;                   // of the base
  std::vector<double> free_x, free_y, free_z;      // deceleration of those without a goal: gravity less thrust
  std::vector<double> turn;                        // in this tick
  std::vector<double> ahead, aside, cos_d, sin_d;  // of wheels, in each sub-step
  std::vector<double> radius, height, hop;
  std::vector<std::uint8_t> owned, fixed, flies, falls;

  std::size_t size() const noexcept { return row.size(); }
  void resize(std::size_t n) {
    row.resize(n);
    for (auto* a :
         {&x,      &y,      &z,      &vx,     &vy,     &vz,     &c,      &s,      &from_x,   &from_y, &from_z, &step_x,
          &step_y, &step_z, &push_x, &push_y, &push_z, &goal_x, &goal_y, &goal_z, &to_place, &thrust, &low,    &high,
          &free_x, &free_y, &free_z, &turn,   &ahead,  &aside,  &cos_d,  &sin_d,  &radius,   &height, &hop})
      a->resize(n);
    for (auto* a : {&owned, &fixed, &flies, &falls}) a->resize(n);
  }
};

/// Neighbouring bodies of one kind.
struct Run {
  std::size_t begin, end;
  const hal::RobotKind* kind;
  const hal::Quadrotor* flight;  ///< null: they do not fly
};

class Particle3d final : public Solver {
 public:
  explicit Particle3d(const Params& params) : params_(params), exact_(params.flight == "exact") {}

  void load(const SolverContext& context) override;
  void advance(const SolverContext& context) override;

 private:
  void load_body(const SolverContext& context, std::size_t i, std::uint32_t row, bool owned);
  void load_flight(const SpaceStores& stores, std::size_t i, double tick_s);
  void load_attitude(const FlightCommand& f, std::size_t i, double tick_s);
  void plan_wheels(std::size_t i, double left_m_s, double right_m_s, double base_m, double h_s) noexcept;
  void find_meetings(const Solid& solid);

  void fly(const Run& run, const SubStep& step) noexcept;
  void fly_exactly(const Run& run, double h_s) noexcept;
  void roll(const Run& run) noexcept;
  void fall(const SubStep& step) noexcept;
  void apart(std::size_t i, std::size_t k) noexcept;
  void push(const std::vector<std::uint32_t>& who) noexcept;
  double move(const Solid& solid, const std::vector<std::uint32_t>& who) noexcept;
  void settle(const Solid& solid);
  void write_back(SpaceStores& stores, double tick_s);
  void write(SpaceStores& stores, std::size_t i, double tick_s) noexcept;

  Params params_;
  bool exact_;
  int steps_ = 1;
  Particles p_;
  std::vector<Run> runs_;
  std::vector<std::uint32_t> falling_;  // those with wheels that hang in the air
  std::vector<std::uint32_t> active_;   // those that may meet others or solid things in this tick
  std::vector<std::uint8_t> solid_near_;
  NearPairs pairs_;
  CrowdPasses crowd_;
  bool crowded_ = false;                                 // some are deep in one another: the crowd is told how deep
  double deepest_ = 0.0;                                 // overlap that was found when pushes were computed last
  double deepest_driving_ = 0.0, deepest_flying_ = 0.0;  // of two that drive, of others; the same
};

/// Enough that no robot jumps over another at full speed. From all kinds in the run: who is near changes nothing.
int sub_steps(const SpaceStores& stores, std::int64_t least, double tick_s) noexcept {
  double most = static_cast<double>(least);
  for (const RobotGroup& group : stores.groups) {
    if (group.kind == nullptr) continue;
    const hal::RobotKind& kind = *group.kind;
    const double speed = kind.top_speed_m_s();
    most = std::max(most, std::ceil(speed * tick_s / (kHop * kind.body.radius_m)));
  }
  return static_cast<int>(most);
}

// --- before the tick ---

/// What is wrong with a body that the stores hold; null when nothing is.
const char* flaw_of(const SpaceStores& s, std::uint32_t row) noexcept {
  const Bodies& b = s.bodies;
  const Motion& m = b.motion[row];
  if (!std::isfinite(b.x_m[row]) || !std::isfinite(b.y_m[row]) || !std::isfinite(m.z_m))
    return "has a position that is not a number";
  if (!std::isfinite(b.cos_h[row]) || !std::isfinite(b.sin_h[row])) return "has a heading that is not a number";
  if (!std::isfinite(m.v_m_s[0]) || !std::isfinite(m.v_m_s[1]) || !std::isfinite(m.v_m_s[2]))
    return "has a speed that is not a number";
  const double speed = std::hypot(m.v_m_s[0], m.v_m_s[1], m.v_m_s[2]);
  if (!std::isfinite(b.left_m_s[row]) || !std::isfinite(b.right_m_s[row]))
    return "is commanded a wheel speed that is not a number";
  const FlightCommand& f = s.command_of(row);
  if (!std::isfinite(f.target[0]) || !std::isfinite(f.target[1]) || !std::isfinite(f.target[2]) ||
      !std::isfinite(f.yaw))
    return "is commanded a flight that is not a number";
  if (speed > kFastest_m_s) return "is faster than 1000 m/s";
  if (std::fabs(b.x_m[row]) > kFarthest_m || std::fabs(b.y_m[row]) > kFarthest_m || std::fabs(m.z_m) > kFarthest_m)
    return "is farther than 10000 km away";
  return nullptr;
}

void Particle3d::load(const SolverContext& context) {
  const SpaceStores& stores = context.stores;
  const Region& region = context.region;
  steps_ = sub_steps(stores, params_.iterations, context.tick_s);
  p_.resize(region.owned.size() + region.mirrored.size());
  std::size_t count = 0;
  runs_.clear();
  falling_.clear();
  auto own = region.owned.begin();
  auto mirror = region.mirrored.begin();
  while (own != region.owned.end() || mirror != region.mirrored.end()) {
    const bool owned = mirror == region.mirrored.end() || (own != region.owned.end() && own->value < mirror->value);
    const BodyKey key = owned ? *own++ : *mirror++;
    if (key.is_object()) continue;  // this engine moves none
    const auto row = static_cast<std::uint32_t>(key.index());
    if (const char* flaw = flaw_of(stores, row); flaw != nullptr) {
      if (owned) trouble.push_back({key, flaw});
      continue;
    }
    load_body(context, count++, row, owned);
  }
  p_.resize(count);
}

void Particle3d::load_body(const SolverContext& context, std::size_t i, std::uint32_t row, bool owned) {
  const SpaceStores& stores = context.stores;
  const Bodies& b = stores.bodies;
  const Motion& m = b.motion[row];
  const hal::RobotKind& kind = stores.kind_of_row(row);
  if (runs_.empty() || runs_.back().kind != &kind) runs_.push_back({i, i, &kind, kind.flight()});
  runs_.back().end = i + 1;
  const hal::Quadrotor* const flight = runs_.back().flight;

  const bool fixed = stores.led_or_held(row);
  p_.row[i] = row;
  p_.owned[i] = owned ? 1 : 0;
  p_.fixed[i] = fixed ? 1 : 0;
  p_.flies[i] = flight != nullptr ? 1 : 0;
  p_.falls[i] = 0;
  p_.radius[i] = kind.body.radius_m;
  p_.height[i] = kind.body.height_m;
  p_.x[i] = p_.from_x[i] = b.x_m[row];
  p_.y[i] = p_.from_y[i] = b.y_m[row];
  p_.z[i] = p_.from_z[i] = m.z_m;
  p_.c[i] = b.cos_h[row];
  p_.s[i] = b.sin_h[row];
  p_.vx[i] = fixed ? 0.0 : m.v_m_s[0];
  p_.vy[i] = fixed ? 0.0 : m.v_m_s[1];
  p_.vz[i] = fixed ? 0.0 : m.v_m_s[2];
  p_.goal_x[i] = p_.goal_y[i] = p_.goal_z[i] = 0.0;
  p_.to_place[i] = 0.0;
  p_.thrust[i] = 1.0;  // without a goal: stays where it is
  p_.free_x[i] = p_.free_y[i] = 0.0;
  p_.free_z[i] = params_.gravity_m_s2;
  p_.turn[i] = 0.0;
  p_.ahead[i] = p_.aside[i] = p_.sin_d[i] = 0.0;
  p_.cos_d[i] = 1.0;
  const Solid solid(stores, context.region);
  p_.low[i] = fixed ? m.z_m : solid.ground_m();
  p_.high[i] = fixed ? m.z_m : std::max(solid.ground_m(), solid.ceiling_m() - kind.body.height_m);
  p_.hop[i] = 0.0;
  if (fixed) return;

  const double speed = std::sqrt(p_.vx[i] * p_.vx[i] + p_.vy[i] * p_.vy[i] + p_.vz[i] * p_.vz[i]);
  double fastest = 0.0;
  if (flight != nullptr) {
    load_flight(stores, i, context.tick_s);
    const double freely = std::hypot(p_.free_x[i], p_.free_y[i], p_.free_z[i]);
    fastest = exact_ && p_.thrust[i] > 0.0
                  ? flight->max_speed_m_s
                  : speed + context.tick_s *
                                std::max(freely * (1.0 - p_.thrust[i]), flight->max_acceleration_m_s2 * p_.thrust[i]);
  } else {
    Mover body;
    body.x_m = p_.x[i];
    body.y_m = p_.y[i];
    body.z_m = p_.z[i];
    body.radius_m = p_.radius[i];
    body.height_m = p_.height[i];
    if (p_.z[i] > p_.low[i] + kOnGround_m && !solid.carries(body)) {
      p_.falls[i] = 1;
      falling_.push_back(static_cast<std::uint32_t>(i));
      fastest = speed + params_.gravity_m_s2 * context.tick_s;
    } else {
      p_.z[i] = p_.from_z[i] = std::max(p_.z[i], p_.low[i]);
      plan_wheels(i, b.left_m_s[row], b.right_m_s[row], wheels_of(kind).wheel_base_m, context.tick_s / steps_);
      fastest = std::max(std::fabs(b.left_m_s[row]), std::fabs(b.right_m_s[row]));
    }
  }
  p_.hop[i] = fastest * context.tick_s + kSlack_m;
}

void Particle3d::load_flight(const SpaceStores& stores, std::size_t i, double tick_s) {
  const hal::Quadrotor& flight = *runs_.back().flight;
  const FlightCommand& f = stores.command_of(p_.row[i]);
  if (f.mode == FlightCommand::Mode::None) {
    p_.thrust[i] = 0.0;
    return;
  }
  const double most = flight.max_turn_rad_s * tick_s;
  double wanted = f.yaw * tick_s;
  if (f.mode == FlightCommand::Mode::Attitude) {
    load_attitude(f, i, tick_s);
  } else {
    p_.goal_x[i] = f.target[0];
    p_.goal_y[i] = f.target[1];
    p_.goal_z[i] = f.target[2];
  }
  if (f.mode == FlightCommand::Mode::Position) {
    p_.to_place[i] = 1.0;
    p_.goal_z[i] = std::clamp(f.target[2], p_.low[i], p_.high[i]);  // no thrust is lost on ground and ceiling
    wanted = hal::turn_between(std::atan2(p_.s[i], p_.c[i]), f.yaw);
  }
  p_.turn[i] = std::clamp(wanted, -most, most);
}

/// Thrust along the axis of a body that leans as told at once: no goal, but an acceleration. When that would make it
/// faster than its kind says, the velocity that is left of it is a goal instead.
void Particle3d::load_attitude(const FlightCommand& f, std::size_t i, double tick_s) {
  const hal::Quadrotor& flight = *runs_.back().flight;
  const double sin_roll = std::sin(f.target[0]);
  const double cos_roll = std::cos(f.target[0]);
  const double sin_pitch = std::sin(f.target[1]);
  const double cos_pitch = std::cos(f.target[1]);
  const double lift = std::clamp(f.target[2], 0.0, flight.max_thrust) * params_.gravity_m_s2;
  const double ahead = lift * sin_pitch * cos_roll;
  const double aside = lift * -sin_roll;
  p_.free_x[i] = -(p_.c[i] * ahead - p_.s[i] * aside);
  p_.free_y[i] = -(p_.s[i] * ahead + p_.c[i] * aside);
  p_.free_z[i] = params_.gravity_m_s2 - lift * cos_pitch * cos_roll;
  p_.thrust[i] = 0.0;
  const double vx = p_.vx[i] - p_.free_x[i] * tick_s;
  const double vy = p_.vy[i] - p_.free_y[i] * tick_s;
  const double vz = p_.vz[i] - p_.free_z[i] * tick_s;
  const double speed = std::sqrt(vx * vx + vy * vy + vz * vz);
  if (speed <= flight.max_speed_m_s) return;
  const double part = flight.max_speed_m_s / speed;
  p_.goal_x[i] = part * vx;
  p_.goal_y[i] = part * vy;
  p_.goal_z[i] = part * vz;
  p_.thrust[i] = 1.0;
}

/// The chord of the arc that a sub-step rolls along, in the frame of the heading before it.
void Particle3d::plan_wheels(std::size_t i, double left_m_s, double right_m_s, double base_m, double h_s) noexcept {
  const double way = 0.5 * (left_m_s + right_m_s) * h_s;
  const double d = (right_m_s - left_m_s) * h_s / base_m;
  p_.turn[i] = d * steps_;
  p_.ahead[i] = way;
  if (d == 0.0) return;
  const double sin_half = std::sin(0.5 * d);
  p_.sin_d[i] = std::sin(d);
  p_.cos_d[i] = std::cos(d);
  p_.ahead[i] = way * p_.sin_d[i] / d;
  p_.aside[i] = way * 2.0 * sin_half * sin_half / d;
}

// --- the tick ---

void Particle3d::advance(const SolverContext& context) {
  const Solid solid(context.stores, context.region);
  const SubStep step(context.tick_s / steps_, params_.drag_per_s);
  find_meetings(solid);
  for (int n = 0; n < steps_; ++n) {
    for (const std::uint32_t i : active_) {
      p_.step_x[i] = p_.x[i];
      p_.step_y[i] = p_.y[i];
      p_.step_z[i] = p_.z[i];
    }
    for (const Run& run : runs_) {
      if (run.flight != nullptr && exact_)
        fly_exactly(run, step.h_s);
      else if (run.flight != nullptr)
        fly(run, step);
      else
        roll(run);
    }
    fall(step);
    push(active_);
    move(solid, active_);
  }
  if (deepest_ > 0.0) push(active_);  // how deep they are now
  if (deepest_ > CrowdPasses::kDeep) settle(solid);
  overlap = deepest_driving_;
  accuracy.overlap = std::max(accuracy.overlap, deepest_flying_);
  write_back(context.stores, context.tick_s);
}

void Particle3d::find_meetings(const Solid& solid) {
  pairs_.find({p_.x, p_.y, p_.z, p_.radius, p_.height, p_.hop});
  active_.clear();
  active_.reserve(p_.row.capacity());  // doubles with the arrays of bodies
  solid_near_.reserve(p_.row.capacity());
  crowd_.reserve(p_.row.capacity());
  solid_near_.assign(p_.size(), 0);
  for (std::size_t i = 0; i < p_.size(); ++i) {
    if (p_.fixed[i] != 0) continue;
    Mover body;
    body.x_m = p_.x[i];
    body.y_m = p_.y[i];
    body.z_m = p_.z[i];
    body.radius_m = p_.radius[i];
    body.height_m = p_.height[i];
    solid_near_[i] = solid.near(body, p_.hop[i]) ? 1 : 0;
    if (solid_near_[i] != 0 || !pairs_.of(i).empty()) active_.push_back(static_cast<std::uint32_t>(i));
  }
}

/// Thrust accelerates towards the wanted velocity, as much as leads there by the sub-step's end if the robot can. What
/// comes out lies between the old velocity, slowed by drag, and the wanted one: never faster than allowed.
void Particle3d::fly(const Run& run, const SubStep& step) noexcept {
  const double fastest = run.flight->max_speed_m_s;
  const double most = run.flight->max_acceleration_m_s2 * step.coasts;
  const double brake = kBrakeShare * run.flight->max_acceleration_m_s2;
  const double response = std::max(kResponse_s, 3.0 * step.h_s);
  const double response2 = response * response;
  const double per_speed = step.gains / step.coasts;
  double* __restrict x = p_.x.data();
  double* __restrict y = p_.y.data();
  double* __restrict z = p_.z.data();
  double* __restrict vx = p_.vx.data();
  double* __restrict vy = p_.vy.data();
  double* __restrict vz = p_.vz.data();
  const double* __restrict gx = p_.goal_x.data();
  const double* __restrict gy = p_.goal_y.data();
  const double* __restrict gz = p_.goal_z.data();
  const double* __restrict to_place = p_.to_place.data();
  const double* __restrict thrust = p_.thrust.data();
  const double* __restrict free_x = p_.free_x.data();
  const double* __restrict free_y = p_.free_y.data();
  const double* __restrict free_z = p_.free_z.data();
  const double* __restrict low = p_.low.data();
  const double* __restrict high = p_.high.data();
  for (std::size_t i = run.begin; i < run.end; ++i) {
    // The way to go, or the velocity to have.
    const double wx = gx[i] - to_place[i] * x[i];
    const double wy = gy[i] - to_place[i] * y[i];
    const double wz = gz[i] - to_place[i] * z[i];
    const double w = std::sqrt(wx * wx + wy * wy + wz * wz);
    // As fast as it can still stop: v response + v^2 / (2 brake) = way.
    const double closing = 2.0 / (response + std::sqrt(response2 + 2.0 * w / brake));
    const double per_want = to_place[i] > 0.0 ? closing : 1.0;
    const double f = w * per_want > fastest ? fastest / w : per_want;
    const double slow_x = step.keeps * vx[i];
    const double slow_y = step.keeps * vy[i];
    const double slow_z = step.keeps * vz[i];
    double ax = wx * f - slow_x;
    double ay = wy * f - slow_y;
    double az = wz * f - slow_z;
    const double a = std::sqrt(ax * ax + ay * ay + az * az);
    const double share = thrust[i] * (a > most ? most / a : 1.0);
    const double freely = (1.0 - thrust[i]) * step.coasts;
    ax = ax * share - freely * free_x[i];
    ay = ay * share - freely * free_y[i];
    az = az * share - freely * free_z[i];
    x[i] += step.coasts * vx[i] + per_speed * ax;
    y[i] += step.coasts * vy[i] + per_speed * ay;
    const double unbounded_z = z[i] + (step.coasts * vz[i] + per_speed * az);
    const double down = unbounded_z < high[i] ? unbounded_z : high[i];
    const double new_z = down > low[i] ? down : low[i];
    const double new_vz = slow_z + az;
    const double keeps_going = thrust[i] > 0.0 || new_z > low[i] ? 1.0 : 0.0;  // who landed lies still
    const bool against = (new_z < unbounded_z && new_vz > 0.0) || (new_z > unbounded_z && new_vz < 0.0);
    z[i] = new_z;
    vx[i] = keeps_going * (slow_x + ax);
    vy[i] = keeps_going * (slow_y + ay);
    vz[i] = against ? 0.0 : new_vz;
  }
}

/// Velocities are there at once; those without a goal fall, or follow their thrust.
void Particle3d::fly_exactly(const Run& run, double h_s) noexcept {
  const double fastest = run.flight->max_speed_m_s;
  for (std::size_t i = run.begin; i < run.end; ++i) {
    if (p_.fixed[i] != 0) continue;
    if (p_.thrust[i] > 0.0) {
      const double per_want = p_.to_place[i] > 0.0 ? 1.0 / h_s : 1.0;
      const double wx = (p_.goal_x[i] - p_.to_place[i] * p_.x[i]) * per_want;
      const double wy = (p_.goal_y[i] - p_.to_place[i] * p_.y[i]) * per_want;
      const double wz = (p_.goal_z[i] - p_.to_place[i] * p_.z[i]) * per_want;
      const double w = std::sqrt(wx * wx + wy * wy + wz * wz);
      const double f = w > fastest ? fastest / w : 1.0;
      p_.vx[i] = wx * f;
      p_.vy[i] = wy * f;
      p_.vz[i] = wz * f;
    } else {
      p_.vx[i] -= p_.free_x[i] * h_s;
      p_.vy[i] -= p_.free_y[i] * h_s;
      p_.vz[i] -= p_.free_z[i] * h_s;
    }
    p_.x[i] += p_.vx[i] * h_s;
    p_.y[i] += p_.vy[i] * h_s;
    const double free_z = p_.z[i] + p_.vz[i] * h_s;
    p_.z[i] = std::max(p_.low[i], std::min(free_z, p_.high[i]));
    if ((p_.z[i] < free_z && p_.vz[i] > 0.0) || (p_.z[i] > free_z && p_.vz[i] < 0.0)) p_.vz[i] = 0.0;
    if (p_.thrust[i] == 0.0 && p_.z[i] <= p_.low[i]) p_.vx[i] = p_.vy[i] = p_.vz[i] = 0.0;  // who landed lies still
  }
}

void Particle3d::roll(const Run& run) noexcept {
  double* __restrict x = p_.x.data();
  double* __restrict y = p_.y.data();
  double* __restrict c = p_.c.data();
  double* __restrict s = p_.s.data();
  const double* __restrict ahead = p_.ahead.data();
  const double* __restrict aside = p_.aside.data();
  const double* __restrict cos_d = p_.cos_d.data();
  const double* __restrict sin_d = p_.sin_d.data();
  for (std::size_t i = run.begin; i < run.end; ++i) {
    x[i] += c[i] * ahead[i] - s[i] * aside[i];
    y[i] += s[i] * ahead[i] + c[i] * aside[i];
    const double c1 = c[i] * cos_d[i] - s[i] * sin_d[i];
    const double s1 = s[i] * cos_d[i] + c[i] * sin_d[i];
    const double k = 1.5 - 0.5 * (c1 * c1 + s1 * s1);  // one Newton step keeps the heading a unit vector
    c[i] = c1 * k;
    s[i] = s1 * k;
  }
}

void Particle3d::fall(const SubStep& step) noexcept {
  for (const std::uint32_t i : falling_) {
    p_.x[i] += step.coasts * p_.vx[i];
    p_.y[i] += step.coasts * p_.vy[i];
    p_.z[i] += step.coasts * p_.vz[i] - step.gains * params_.gravity_m_s2;
    p_.vx[i] *= step.keeps;
    p_.vy[i] *= step.keeps;
    p_.vz[i] = step.keeps * p_.vz[i] - step.coasts * params_.gravity_m_s2;
    if (p_.z[i] > p_.low[i]) continue;
    p_.z[i] = p_.low[i];
    p_.vx[i] = p_.vy[i] = p_.vz[i] = 0.0;
  }
}

// --- contacts ---

/// Adds to the push of `i` what its overlap with `k` asks of it.
void Particle3d::apart(std::size_t i, std::size_t k) noexcept {
  const double dx = p_.x[i] - p_.x[k];
  const double dy = p_.y[i] - p_.y[k];
  const double touch = p_.radius[i] + p_.radius[k];
  const double d2 = dx * dx + dy * dy;
  if (d2 >= touch * touch) return;
  const double above = p_.z[k] + p_.height[k] - p_.z[i];  // up to where i stands on k
  const double below = p_.z[i] + p_.height[i] - p_.z[k];  // down to where it hangs below
  if (above <= 0.0 || below <= 0.0) return;
  const double d = std::sqrt(d2);
  const double depth = touch - d;
  const double high = std::min(above, below);
  const bool both_drive = p_.flies[i] == 0 && p_.flies[k] == 0;
  const bool beside = both_drive || depth <= high;
  const double deep = CrowdPasses::overlap(beside ? depth : high, p_.radius[i], p_.radius[k]);
  deepest_ = std::max(deepest_, deep);
  double& of_these = both_drive ? deepest_driving_ : deepest_flying_;
  of_these = std::max(of_these, deep);
  if (crowded_) crowd_.note(static_cast<std::uint32_t>(i), deep);
  if (beside) {
    const double share = depth * (p_.fixed[k] != 0 ? 1.0 : 0.5);
    p_.push_x[i] += d > 0.0 ? dx / d * share : (i < k ? -share : share);  // two on one spot part along x
    p_.push_y[i] += d > 0.0 ? dy / d * share : 0.0;
    return;
  }
  if (p_.flies[i] == 0) return;  // wheels keep to what they stand on
  const double share = p_.fixed[k] != 0 || p_.flies[k] == 0 ? 1.0 : 0.5;
  const bool up = above < below || (above == below && i > k);
  p_.push_z[i] += up ? above * share : -below * share;
}

/// Crowds, for which a pass a sub-step is not enough.
void Particle3d::settle(const Solid& solid) {
  for (std::size_t i = 0; i < p_.size(); ++i) {
    if (!std::isfinite(p_.x[i] + p_.y[i] + p_.z[i])) return;  // told of after the tick
  }
  crowded_ = true;
  deepest_ = crowd_.settle(
      p_.size(),
      [&](bool back) -> const std::vector<std::uint32_t>& {
        for (std::size_t i = 0; i < p_.size(); ++i)
          p_.hop[i] = CrowdPasses::kSlack_m +
                      (back ? std::hypot(p_.x[i] - p_.from_x[i], p_.y[i] - p_.from_y[i], p_.z[i] - p_.from_z[i]) : 0.0);
        find_meetings(solid);
        for (const std::uint32_t i : active_) {
          p_.step_x[i] = p_.x[i];
          p_.step_y[i] = p_.y[i];
          p_.step_z[i] = p_.z[i];
        }
        return active_;
      },
      [&](const std::vector<std::uint32_t>& who) { push(who); },
      [&](const std::vector<std::uint32_t>& who) { return move(solid, who); },
      [&](std::uint32_t i, double share) {
        p_.x[i] = p_.from_x[i] + share * (p_.x[i] - p_.from_x[i]);
        p_.y[i] = p_.from_y[i] + share * (p_.y[i] - p_.from_y[i]);
        p_.z[i] = p_.from_z[i] + share * (p_.z[i] - p_.from_z[i]);
      },
      [&](std::uint32_t i) { return pairs_.of(i); });
  crowded_ = false;
}

/// Computes what these are pushed by, from where all are.
void Particle3d::push(const std::vector<std::uint32_t>& who) noexcept {
  deepest_ = deepest_driving_ = deepest_flying_ = 0.0;
  for (const std::uint32_t i : who) {
    p_.push_x[i] = p_.push_y[i] = p_.push_z[i] = 0.0;
    for (const std::uint32_t k : pairs_.of(i)) apart(i, k);
  }
}

/// Moves these by their pushes and out of what is solid. @returns the longest way.
double Particle3d::move(const Solid& solid, const std::vector<std::uint32_t>& who) noexcept {
  double longest2 = 0.0;
  for (const std::uint32_t i : who) {
    const double px = p_.push_x[i];
    const double py = p_.push_y[i];
    const double pz = p_.push_z[i];
    const double p2 = px * px + py * py + pz * pz;
    if (p2 == 0.0 && solid_near_[i] == 0) continue;
    Mover body{p_.x[i] + px, p_.y[i] + py, p_.z[i] + pz, p_.vx[i], p_.vy[i],
               p_.vz[i],     p_.radius[i], p_.height[i], false};
    if (p2 > 0.0) {
      const double against = (body.vx_m_s * px + body.vy_m_s * py + body.vz_m_s * pz) / p2;
      if (against < 0.0) {
        body.vx_m_s -= against * px;
        body.vy_m_s -= against * py;
        body.vz_m_s -= against * pz;
      }
    }
    solid.stop(body, p_.step_x[i], p_.step_y[i], p_.step_z[i]);
    const double dx = body.x_m - p_.x[i];
    const double dy = body.y_m - p_.y[i];
    const double dz = body.z_m - p_.z[i];
    longest2 = std::max(longest2, dx * dx + dy * dy + dz * dz);
    p_.x[i] = body.x_m;
    p_.y[i] = body.y_m;
    p_.z[i] = body.z_m;
    const bool lies = body.landed && (p_.falls[i] != 0 || p_.thrust[i] == 0.0);
    p_.vx[i] = lies ? 0.0 : body.vx_m_s;
    p_.vy[i] = lies ? 0.0 : body.vy_m_s;
    p_.vz[i] = lies ? 0.0 : body.vz_m_s;
  }
  return std::sqrt(longest2);
}

// --- after the tick ---

/// The quaternion of a heading. Its w is not negative.
std::array<double, 4> upright(double cos_h, double sin_h) noexcept {
  if (cos_h >= 0.0) {
    const double w = std::sqrt(0.5 * (1.0 + cos_h));
    return {w, 0.0, 0.0, 0.5 * sin_h / w};
  }
  const double z = std::copysign(std::sqrt(0.5 * (1.0 - cos_h)), sin_h);
  return {0.5 * sin_h / z, 0.0, 0.0, z};
}

void Particle3d::write_back(SpaceStores& stores, double tick_s) {
  for (std::size_t i = 0; i < p_.size(); ++i) {
    if (p_.owned[i] == 0 || p_.fixed[i] != 0) continue;
    if (p_.flies[i] != 0 && p_.turn[i] != 0.0) {
      const double cos_d = std::cos(p_.turn[i]);
      const double sin_d = std::sin(p_.turn[i]);
      const double c = p_.c[i] * cos_d - p_.s[i] * sin_d;
      const double s = p_.s[i] * cos_d + p_.c[i] * sin_d;
      const double k = 1.5 - 0.5 * (c * c + s * s);
      p_.c[i] = c * k;
      p_.s[i] = s * k;
    }
    const double all = p_.x[i] + p_.y[i] + p_.z[i] + p_.vx[i] + p_.vy[i] + p_.vz[i] + p_.c[i] + p_.s[i];
    if (!std::isfinite(all)) {
      trouble.push_back({BodyKey::robot(p_.row[i]), "came to a position or speed that is not a number"});
      continue;
    }
    write(stores, i, tick_s);
  }
}

void Particle3d::write(SpaceStores& stores, std::size_t i, double tick_s) noexcept {
  Bodies& b = stores.bodies;
  const std::uint32_t row = p_.row[i];
  Motion& m = b.motion[row];
  b.x_m[row] = p_.x[i];
  b.y_m[row] = p_.y[i];
  if (p_.c[i] != b.cos_h[row] || p_.s[i] != b.sin_h[row]) m.q_WB = upright(p_.c[i], p_.s[i]);
  b.cos_h[row] = p_.c[i];
  b.sin_h[row] = p_.s[i];
  m.z_m = p_.z[i];
  m.w_rad_s = {0.0, 0.0, p_.turn[i] / tick_s};
  if (p_.flies[i] != 0 || p_.falls[i] != 0) {
    m.v_m_s = {p_.vx[i], p_.vy[i], p_.vz[i]};
  } else {
    m.v_m_s = {(p_.x[i] - p_.from_x[i]) / tick_s, (p_.y[i] - p_.from_y[i]) / tick_s, 0.0};
  }
  if (p_.flies[i] != 0) return;
  b.left_m[row] += b.left_m_s[row] * tick_s;
  b.right_m[row] += b.right_m_s[row] * tick_s;
}

std::shared_ptr<const void> read(const Element& options, Problems& problems) {
  return std::make_shared<Params>(read_settings<Params>(options, problems, {"id", "regions"}, {"boundaries"}));
}

}  // namespace

const EngineType& particle3d_type() {
  static const EngineType type = [] {
    EngineType t;
    t.kind = "particle3d";
    t.argos_name = "pointmass3d";
    t.summary = "Point masses in space with drag and limits of speed and acceleration: robots that fly.";
    t.traits = {.plane = false, .air = true};
    t.read = &read;
    t.describe = [](hal::ParamVisitor& visitor) { Params{}.describe(visitor); };
    t.gravity = [](const void* params) { return static_cast<const Params*>(params)->gravity_m_s2; };
    t.make = &make_solvers;
    t.make_solver = [](const std::shared_ptr<const void>& params, const SpaceStores&, const Region&,
                       double) -> std::unique_ptr<Solver> {
      return std::make_unique<Particle3d>(*static_cast<const Params*>(params.get()));
    };
    return t;
  }();
  return type;
}

}  // namespace tandem::core
