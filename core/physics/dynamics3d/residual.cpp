#include "core/physics/dynamics3d/residual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tandem::core {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();

/// Of bodies that ODE does not move: 0.
double inverse_mass(dBodyID body) noexcept {
  if (body == nullptr || dBodyIsKinematic(body) != 0 || dBodyIsEnabled(body) == 0) return 0.0;
  dMass mass;
  dBodyGetMass(body, &mass);
  return 1.0 / mass.mass;
}

Vector3 vector_of(const dReal* v) noexcept {
  return {v[0], v[1], v[2]};
}

double together_kg(dBodyID a, dBodyID b) noexcept {
  const double inverse = inverse_mass(a) + inverse_mass(b);
  return inverse > 0.0 ? 1.0 / inverse : kAny;
}

Vector3 from_body(dBodyID body, const Vector3& p_m) noexcept {
  const dReal* at = dBodyGetPosition(body);
  return {p_m[0] - at[0], p_m[1] - at[1], p_m[2] - at[2]};
}

Vector3 velocity_of(dBodyID body, const Vector3& arm) noexcept {
  const dReal* v = dBodyGetLinearVel(body);
  const dReal* w = dBodyGetAngularVel(body);
  return {v[0] + w[1] * arm[2] - w[2] * arm[1], v[1] + w[2] * arm[0] - w[0] * arm[2],
          v[2] + w[0] * arm[1] - w[1] * arm[0]};
}

Vector3 in_world(dBodyID body, const Vector3& v) noexcept {
  const dReal* r = dBodyGetRotation(body);
  return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[4] * v[0] + r[5] * v[1] + r[6] * v[2],
          r[8] * v[0] + r[9] * v[1] + r[10] * v[2]};
}

}  // namespace

void Residual::begin(const Settings& settings) noexcept {
  settings_ = settings;
  contacts_.clear();
  rows_.clear();
  holds_.clear();
  bodies_.clear();
  lasting_.clear();
  used_ = 0;
}

/// ODE keeps a body's number, plus one, while the sub-step lasts.
std::uint32_t Residual::number_of(dBodyID body) {
  const auto kept = reinterpret_cast<std::uintptr_t>(dBodyGetData(body));
  if (kept != 0) return static_cast<std::uint32_t>(kept - 1);
  const auto number = static_cast<std::uint32_t>(bodies_.size());
  dBodySetData(body, reinterpret_cast<void*>(static_cast<std::uintptr_t>(number) + 1));
  bodies_.push_back({});
  bodies_.back().body = body;
  bodies_.back().island = number;
  return number;
}

std::uint32_t Residual::island_of(std::uint32_t number) noexcept {
  while (bodies_[number].island != number) {
    bodies_[number].island = bodies_[bodies_[number].island].island;
    number = bodies_[number].island;
  }
  return number;
}

void Residual::add_body(dBodyID body) {
  Body& here = bodies_[number_of(body)];
  here.moves = true;
  here.p_m = vector_of(dBodyGetPosition(body));
  here.v_m_s = vector_of(dBodyGetLinearVel(body));
  here.w_rad_s = vector_of(dBodyGetAngularVel(body));
  here.force_N = vector_of(dBodyGetForce(body));
  here.torque_Nm = vector_of(dBodyGetTorque(body));
  std::copy_n(dBodyGetQuaternion(body), 4, here.turn);
}

/// ODE connects bodies through any other, also one that it does not move.
void Residual::connect(Pair& pair) {
  pair.mass_kg = together_kg(pair.a, pair.b);
  pair.number = number_of(pair.a);
  if (pair.b == nullptr) return;
  const std::uint32_t one = island_of(pair.number);
  const std::uint32_t other = island_of(number_of(pair.b));
  bodies_[std::max(one, other)].island = std::min(one, other);
}

dJointFeedback* Residual::listen(dJointID joint, bool lasts) {
  if (used_ == forces_.size()) forces_.push_back(std::make_unique<dJointFeedback>());
  dJointFeedback* const force = forces_[used_++].get();
  dJointSetFeedback(joint, force);
  if (lasts) lasting_.push_back(joint);
  return force;
}

void Residual::add_contact(dJointID joint, dBodyID a, dBodyID b, const dContact& contact) {
  Contact& c = contacts_.emplace_back();
  c.pair.a = a;
  c.pair.b = b;
  for (std::size_t i = 0; i < 3; ++i) {
    c.p_m[i] = contact.geom.pos[i];
    c.normal[i] = contact.geom.normal[i];
    c.first[i] = contact.fdir1[i];
  }
  c.second = cross(c.normal, c.first);
  const double parting_m_s = settings_.erp / settings_.dt_s * contact.geom.depth + contact.surface.motionN;
  c.target_m_s = std::min(parting_m_s, settings_.most_parting_m_s);
  c.along = contact.surface.mu;
  c.across = contact.surface.mu2;
  c.force = listen(joint, false);
}

void Residual::add_axle(dJointID axle, dBodyID wheel, dBodyID chassis, double radius_m, double rim_m_s,
                        double most_Nm) {
  dVector3 at{};
  dVector3 on_chassis{};
  dVector3 axis{};
  dJointGetHingeAnchor(axle, at);
  dJointGetHingeAnchor2(axle, on_chassis);
  dJointGetHingeAxis(axle, axis);
  const Vector3 along{axis[0], axis[1], axis[2]};
  Hold& hold = holds_.emplace_back();
  hold.pair.a = wheel;
  hold.pair.b = chassis;
  const Vector3 lacks{on_chassis[0] - at[0], on_chassis[1] - at[1], on_chassis[2] - at[2]};
  hold.pair.arm_a = from_body(wheel, {at[0], at[1], at[2]});
  hold.pair.arm_b = from_body(chassis, {on_chassis[0], on_chassis[1], on_chassis[2]});
  for (std::size_t i = 0; i < 3; ++i) hold.target_m_s[i] = settings_.erp / settings_.dt_s * lacks[i];
  Row& motor = rows_.emplace_back();
  motor.pair.a = wheel;
  motor.pair.b = chassis;
  motor.along = along;
  motor.lever_m = radius_m;
  motor.target_m_s = rim_m_s;
  motor.most_N = most_Nm / radius_m;
  motor.force = listen(axle, true);
}

void Residual::add_push(dJointID motor, dBodyID body, const Vector3& ahead, double forward_m_s, double leftward_m_s,
                        double most_N) {
  const dJointFeedback* const force = listen(motor, true);
  for (const bool left : {false, true}) {
    Row& row = rows_.emplace_back();
    row.pair.a = body;
    row.along = left ? Vector3{-ahead[1], ahead[0], 0.0} : ahead;
    row.target_m_s = left ? leftward_m_s : forward_m_s;
    row.most_N = most_N;
    row.force = force;
  }
}

void Residual::add_turn(dJointID motor, dBodyID body, double rate_rad_s, double lever_m, double most_Nm) {
  Row& row = rows_.emplace_back();
  row.pair.a = body;
  row.along = {0.0, 0.0, 1.0};
  row.lever_m = lever_m;
  row.target_m_s = rate_rad_s * lever_m;
  row.most_N = most_Nm / lever_m;
  row.force = listen(motor, true);
}

void Residual::add_hold(dBodyID a, dBodyID b, const Vector3& at_a, const Vector3& at_b, const Vector3& free) {
  Hold& hold = holds_.emplace_back();
  hold.pair.a = a;
  hold.pair.b = b;
  hold.pair.arm_a = in_world(a, at_a);
  hold.pair.arm_b = in_world(b, at_b);
  hold.free = in_world(a, free);
  const dReal* p_a = dBodyGetPosition(a);
  const dReal* p_b = dBodyGetPosition(b);
  for (std::size_t i = 0; i < 3; ++i)
    hold.target_m_s[i] = settings_.erp / settings_.dt_s * (p_b[i] + hold.pair.arm_b[i] - p_a[i] - hold.pair.arm_a[i]);
}

void Residual::prepare() {
  for (Contact& c : contacts_) {
    connect(c.pair);
    c.pair.arm_a = from_body(c.pair.a, c.p_m);
    if (c.pair.b != nullptr) c.pair.arm_b = from_body(c.pair.b, c.p_m);
  }
  for (Row& row : rows_) connect(row.pair);
  for (Hold& hold : holds_) connect(hold.pair);
}

Vector3 Residual::relative_velocity(const Pair& pair) noexcept {
  Vector3 u = velocity_of(pair.a, pair.arm_a);
  if (pair.b == nullptr) return u;
  const Vector3 of_b = velocity_of(pair.b, pair.arm_b);
  for (std::size_t i = 0; i < 3; ++i) u[i] -= of_b[i];
  return u;
}

double Residual::error(double speed_m_s, double target_m_s, double force_N, double low_N, double high_N,
                       double mass_kg) const noexcept {
  if (!(mass_kg < kAny)) return 0.0;  // neither gives way
  const double per_m_s = mass_kg / settings_.dt_s;
  const double wanted_N = force_N - per_m_s * (speed_m_s + settings_.cfm * force_N - target_m_s);
  return std::fabs(force_N - std::min(std::max(wanted_N, low_N), high_N)) / per_m_s;
}

double Residual::error_of(const Contact& c) const noexcept {
  const Vector3 u = relative_velocity(c.pair);
  const Vector3 force = vector_of(c.force->f1);
  const double pressed_N = dot(force, c.normal);
  double largest = error(dot(u, c.normal), c.target_m_s, pressed_N, 0.0, kAny, c.pair.mass_kg);
  for (const auto& [along, mu] : {std::pair{&c.first, c.along}, std::pair{&c.second, c.across}}) {
    if (mu <= 0.0) continue;
    const double most_N = mu * std::max(0.0, pressed_N);
    largest = std::max(largest, error(dot(u, *along), 0.0, dot(force, *along), -most_N, most_N, c.pair.mass_kg));
  }
  return largest;
}

double Residual::error_of(const Row& row) const noexcept {
  double force_N = 0.0;
  double speed_m_s = 0.0;
  if (row.lever_m > 0.0) {
    Vector3 spin = vector_of(dBodyGetAngularVel(row.pair.a));
    const Vector3 other = row.pair.b == nullptr ? Vector3{} : vector_of(dBodyGetAngularVel(row.pair.b));
    for (std::size_t i = 0; i < 3; ++i) spin[i] -= other[i];
    speed_m_s = dot(spin, row.along) * row.lever_m;
    force_N = dot(vector_of(row.force->t1), row.along) / row.lever_m;
  } else {
    speed_m_s = dot(relative_velocity(row.pair), row.along);
    force_N = dot(vector_of(row.force->f1), row.along);
  }
  return error(speed_m_s, row.target_m_s, force_N, -row.most_N, row.most_N, row.pair.mass_kg);
}

double Residual::error_of(const Hold& hold) noexcept {
  if (!(hold.pair.mass_kg < kAny)) return 0.0;
  Vector3 lacks = relative_velocity(hold.pair);
  for (std::size_t i = 0; i < 3; ++i) lacks[i] -= hold.target_m_s[i];
  const double freely = dot(lacks, hold.free);
  for (std::size_t i = 0; i < 3; ++i) lacks[i] -= freely * hold.free[i];
  return std::sqrt(dot(lacks, lacks));
}

template <class Constraint>
void Residual::measure_all(const std::vector<Constraint>& constraints) noexcept {
  for (const Constraint& constraint : constraints) {
    Body& island = bodies_[island_of(constraint.pair.number)];
    if (!island.waits) island.error_m_s = std::max(island.error_m_s, error_of(constraint));
  }
}

double Residual::measure() noexcept {
  for (Body& body : bodies_) {
    if (!body.waits) body.error_m_s = 0.0;
  }
  measure_all(contacts_);
  measure_all(rows_);
  measure_all(holds_);
  double largest = 0.0;
  for (const Body& body : bodies_) largest = std::max(largest, body.error_m_s);
  return largest;
}

void Residual::begin_again(double most_m_s) noexcept {
  for (Body& body : bodies_) body.waits = !(body.error_m_s > most_m_s);
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    if (!body.moves) continue;
    if (bodies_[island_of(i)].waits) {
      dBodyDisable(body.body);
      continue;
    }
    dBodySetPosition(body.body, body.p_m[0], body.p_m[1], body.p_m[2]);
    dBodySetQuaternion(body.body, body.turn);
    dBodySetLinearVel(body.body, body.v_m_s[0], body.v_m_s[1], body.v_m_s[2]);
    dBodySetAngularVel(body.body, body.w_rad_s[0], body.w_rad_s[1], body.w_rad_s[2]);
    dBodySetForce(body.body, body.force_N[0], body.force_N[1], body.force_N[2]);
    dBodySetTorque(body.body, body.torque_Nm[0], body.torque_Nm[1], body.torque_Nm[2]);
  }
}

void Residual::end() noexcept {
  for (const Body& body : bodies_) {
    if (body.moves) dBodyEnable(body.body);
    dBodySetData(body.body, nullptr);
  }
  for (const dJointID joint : lasting_) dJointSetFeedback(joint, nullptr);
}

}  // namespace tandem::core
