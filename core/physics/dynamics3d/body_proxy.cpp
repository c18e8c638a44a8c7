#include "core/physics/dynamics3d/body_proxy.hpp"

#include <algorithm>
#include <cmath>

#include "core/physics/wheels.hpp"

namespace tandem::core {
namespace {

constexpr double kUpright = 0.9999;   // cosine of the lean up to which a body counts as upright
constexpr double kStiff_kg_m2 = 1e6;  // moment of inertia about axes that a light body cannot turn about
constexpr double kSameHeading = 1e-9;
constexpr double kWheelShare = 0.05;  // of a robot's mass, in each wheel

Vector3 from(const dReal* v) noexcept {
  return {v[0], v[1], v[2]};
}

/// The heading that a turn gives: of the body's x axis seen from above.
std::array<double, 2> heading_of(const std::array<double, 4>& q) noexcept {
  const double c = 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]);
  const double s = 2.0 * (q[1] * q[2] + q[0] * q[3]);
  const double l = std::sqrt(c * c + s * s);
  if (l < kSameHeading) return {1.0, 0.0};
  return {c / l, s / l};
}

/// One turn after another.
std::array<double, 4> product(const std::array<double, 4>& a, const std::array<double, 4>& b) noexcept {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

OdeBody make_body(dWorldID world, const dMass& mass) {
  OdeBody body(dBodyCreate(world));
  dBodySetMass(body.get(), &mass);
  dBodySetAutoDisableFlag(body.get(), 0);
  dBodySetFiniteRotationMode(body.get(), 1);
  return body;
}

void give_wheels(BodyProxy& proxy, dWorldID world) {
  const hal::RobotKind& kind = *proxy.kind;
  const hal::DifferentialDrive& wheels = *proxy.drive;
  dMass mass;
  dMassSetCylinderTotal(&mass, (1.0 - 2.0 * kWheelShare) * proxy.mass_kg, 3, kind.body.radius_m, kind.body.height_m);
  proxy.body = make_body(world, mass);
  for (std::size_t side = 0; side < 2; ++side) {
    dMassSetCylinderTotal(&mass, kWheelShare * proxy.mass_kg, 2, wheels.wheel_radius_m, 0.1 * wheels.wheel_radius_m);
    proxy.wheels[side] = make_body(world, mass);
    const double y = (side == 0 ? 0.5 : -0.5) * wheels.wheel_base_m;
    dBodySetPosition(proxy.body.get(), 0.0, 0.0, 0.0);
    dBodySetPosition(proxy.wheels[side].get(), 0.0, y, 0.0);
    proxy.axles[side] = OdeJoint(dJointCreateHinge(world, nullptr));
    const dJointID axle = proxy.axles[side].get();
    dJointAttach(axle, proxy.wheels[side].get(), proxy.body.get());
    dJointSetHingeAnchor(axle, 0.0, y, 0.0);
    dJointSetHingeAxis(axle, 0.0, 1.0, 0.0);
    dJointSetHingeParam(axle, dParamFMax, 0.5 * wheels.force_N * wheels.wheel_radius_m);
  }
}

void put_in_ode(BodyProxy& proxy, const BodyState& at) {
  std::array<double, 4> q = at.q_WB;
  const auto [c, s] = heading_of(q);
  if (std::fabs(c - at.cos_h) > kSameHeading || std::fabs(s - at.sin_h) > kSameHeading)  // the heading alone was set
    q = product(upright_turn(c * at.cos_h + s * at.sin_h, c * at.sin_h - s * at.cos_h), q);
  const dBodyID body = proxy.body.get();
  dBodySetPosition(body, at.x_m, at.y_m, at.z_m + proxy.origin_m);
  dBodySetQuaternion(body, q.data());
  dBodySetLinearVel(body, at.v_m_s[0], at.v_m_s[1], at.v_m_s[2]);
  dBodySetAngularVel(body, at.w_rad_s[0], at.w_rad_s[1], at.w_rad_s[2]);
  if (proxy.sort != Sort::Wheels) return;
  const dReal* r = dBodyGetRotation(body);
  for (std::size_t side = 0; side < 2; ++side) {
    const double y = (side == 0 ? 0.5 : -0.5) * proxy.drive->wheel_base_m;
    const Vector3 arm{r[1] * y, r[5] * y, r[9] * y};
    const dReal* w = dBodyGetAngularVel(body);
    const Vector3 v{at.v_m_s[0] + w[1] * arm[2] - w[2] * arm[1], at.v_m_s[1] + w[2] * arm[0] - w[0] * arm[2],
                    at.v_m_s[2] + w[0] * arm[1] - w[1] * arm[0]};
    const double spin = (v[0] * r[0] + v[1] * r[4] + v[2] * r[8]) / proxy.drive->wheel_radius_m;  // it rolls
    const dBodyID wheel = proxy.wheels[side].get();
    dBodySetPosition(wheel, at.x_m + arm[0], at.y_m + arm[1], at.z_m + proxy.origin_m + arm[2]);
    dBodySetQuaternion(wheel, dBodyGetQuaternion(body));
    dBodySetLinearVel(wheel, v[0], v[1], v[2]);
    dBodySetAngularVel(wheel, w[0] + spin * r[1], w[1] + spin * r[5], w[2] + spin * r[9]);
  }
}

}  // namespace

bool BodyState::finite() const noexcept {
  double sum = x_m + y_m + z_m + cos_h + sin_h;
  for (const double q : q_WB) sum += q;
  for (std::size_t i = 0; i < 3; ++i) sum += v_m_s[i] + w_rad_s[i];
  return std::isfinite(sum);
}

std::array<double, 2> Turn::of(double cos_h, double sin_h, double angle_rad) noexcept {
  if (angle_rad != angle_rad_) {
    const double a = angle_rad_ = angle_rad;
    if (std::fabs(a) < 0.5) {  // by series, exact to 1e-13: what a robot turns in a sub-step
      const double a2 = a * a;
      sin_ = a * (1.0 - a2 * (1.0 / 6 - a2 * (1.0 / 120 - a2 * (1.0 / 5040 - a2 * (1.0 / 362880 - a2 / 39916800.0)))));
      cos_ = 1.0 - a2 * (0.5 - a2 * (1.0 / 24 - a2 * (1.0 / 720 - a2 * (1.0 / 40320 - a2 / 3628800.0))));
    } else {
      cos_ = std::cos(a);
      sin_ = std::sin(a);
    }
    sin_ += 0.0;  // -0 counts as the 0 that it is equal to
  }
  const double x = cos_h * cos_ - sin_h * sin_;
  const double y = sin_h * cos_ + cos_h * sin_;
  const double k = 1.5 - 0.5 * (x * x + y * y);  // one Newton step keeps it a unit vector
  return {x * k, y * k};
}

std::array<double, 4> upright_turn(double cos_h, double sin_h) noexcept {
  // Half angles [Abramowitz 1964, 4.3.20], by the half that loses no digits.
  if (cos_h >= 0.0) {
    const double c = std::sqrt(0.5 * (1.0 + cos_h));
    return {c, 0.0, 0.0, 0.5 * sin_h / c};
  }
  const double s = std::copysign(std::sqrt(0.5 * (1.0 - cos_h)), sin_h);
  return {0.5 * sin_h / s, 0.0, 0.0, s};
}

BodyState stored_state(const SpaceStores& stores, BodyKey key) noexcept {
  const std::size_t i = key.index();
  const Motion& m = key.is_object() ? stores.object_motion[i] : stores.bodies.motion[i];
  BodyState at;
  if (key.is_object()) {
    const Object& o = stores.objects[i];
    at = {o.x_m, o.y_m, m.z_m, o.cos_h, o.sin_h, m.q_WB, m.v_m_s, m.w_rad_s};
  } else {
    const Bodies& b = stores.bodies;
    at = {b.x_m[i], b.y_m[i], m.z_m, b.cos_h[i], b.sin_h[i], m.q_WB, m.v_m_s, m.w_rad_s};
  }
  return at;
}

BodyState state_of(const BodyProxy& proxy) noexcept {
  BodyState at;
  if (proxy.light()) {
    return {proxy.p_m[0], proxy.p_m[1],
            proxy.p_m[2], proxy.cos_h,
            proxy.sin_h,  upright_turn(proxy.cos_h, proxy.sin_h),
            proxy.v_m_s,  {0.0, 0.0, proxy.w_rad_s}};
  }
  const dBodyID body = proxy.body.get();
  const dReal* p = dBodyGetPosition(body);
  const dReal* q = dBodyGetQuaternion(body);
  at.x_m = p[0];
  at.y_m = p[1];
  at.z_m = p[2] - proxy.origin_m;
  at.q_WB = {q[0], q[1], q[2], q[3]};
  const auto [c, s] = heading_of(at.q_WB);
  at.cos_h = c;
  at.sin_h = s;
  at.v_m_s = from(dBodyGetLinearVel(body));
  at.w_rad_s = from(dBodyGetAngularVel(body));
  return at;
}

void know_kind(BodyProxy& proxy, const SpaceStores& stores) {
  proxy.kind = &stores.kind_of_row(proxy.key.index());
  proxy.flight = proxy.kind->flight();
  if (proxy.flight == nullptr) proxy.drive = &wheels_of(*proxy.kind);
}

void make_proxy(BodyProxy& proxy, const SpaceStores& stores, BodyKey key, Sort sort, dWorldID world) {
  proxy.key = key;
  proxy.sort = sort;
  Prism& prism = proxy.prism;
  if (key.is_object()) {
    const Object& o = stores.objects[key.index()];
    proxy.mass_kg = o.mass_kg;
    proxy.height_m = o.z_high_m - o.z_low_m;
    proxy.origin_m = 0.5 * proxy.height_m;
    prism.round = o.kind == Object::Kind::Cylinder;
    prism.radius_m = o.radius_m;
    prism.half_x_m = o.half_x_m;
    prism.half_y_m = o.half_y_m;
    dMass mass;
    if (prism.round)
      dMassSetCylinderTotal(&mass, o.mass_kg, 3, o.radius_m, proxy.height_m);
    else
      dMassSetBoxTotal(&mass, o.mass_kg, 2.0 * o.half_x_m, 2.0 * o.half_y_m, proxy.height_m);
    proxy.body = make_body(world, mass);
    return;
  }
  know_kind(proxy, stores);
  proxy.mass_kg = proxy.kind->body.mass_kg;
  proxy.height_m = proxy.kind->body.height_m;
  proxy.origin_m = sort == Sort::Wheels ? proxy.drive->wheel_radius_m : 0.5 * proxy.height_m;
  prism.radius_m = static_cast<double>(stores.bodies.radius_m[key.index()]);
  if (sort == Sort::Wheels) give_wheels(proxy, world);
  if (sort == Sort::Rotors) {
    const double inertia = proxy.flight->inertia_kg_m2;
    dMass mass;
    dMassSetParameters(&mass, proxy.mass_kg, 0.0, 0.0, 0.0, inertia, inertia, inertia, 0.0, 0.0, 0.0);
    proxy.body = make_body(world, mass);
  }
}

void end_proxy(BodyProxy& proxy) noexcept {
  for (OdeJoint* joint : {&proxy.axles[0], &proxy.axles[1], &proxy.push, &proxy.turn}) joint->destroy();
  for (OdeBody* body : {&proxy.wheels[0], &proxy.wheels[1], &proxy.body}) body->destroy();
  proxy.geom = OdeGeom();
}

void put(BodyProxy& proxy, const BodyState& at) {
  if (!proxy.light()) {
    put_in_ode(proxy, at);
    return;
  }
  proxy.p_m = {at.x_m, at.y_m, at.z_m};
  proxy.v_m_s = at.v_m_s;
  proxy.w_rad_s = at.w_rad_s[2];
  proxy.cos_h = at.cos_h;
  proxy.sin_h = at.sin_h;
  proxy.standing = false;
}

void give_body(BodyProxy& proxy, dWorldID world) {
  if (proxy.body) return;
  dMass mass;
  const double r = proxy.prism.radius_m;
  dMassSetParameters(&mass, proxy.mass_kg, 0.0, 0.0, 0.0, kStiff_kg_m2, kStiff_kg_m2, 0.5 * proxy.mass_kg * r * r, 0.0,
                     0.0, 0.0);
  proxy.body = make_body(world, mass);
  dBodySetGravityMode(proxy.body.get(), 0);
  dBodySetGyroscopicMode(proxy.body.get(), 0);
  dBodyDisable(proxy.body.get());
}

void update_prism(BodyProxy& proxy) {
  Prism& prism = proxy.prism;
  if (proxy.light()) {
    prism.x_m = proxy.p_m[0];
    prism.y_m = proxy.p_m[1];
    prism.low_m = proxy.p_m[2];
    prism.high_m = proxy.p_m[2] + proxy.height_m;
    prism.reach_x_m = prism.reach_y_m = prism.radius_m;
    return;
  }
  const dReal* p = dBodyGetPosition(proxy.body.get());
  const dReal* r = dBodyGetRotation(proxy.body.get());
  const double up = 0.5 * proxy.height_m - proxy.origin_m;  // from ODE's origin to the middle
  prism.x_m = p[0] + up * r[2];
  prism.y_m = p[1] + up * r[6];
  const double middle_m = p[2] + up * r[10];
  prism.upright = r[10] > kUpright;
  Vector3 reach{};
  for (std::size_t i = 0; i < 3; ++i) {
    const dReal* row = r + 4 * i;
    const double along = 0.5 * proxy.height_m * std::fabs(row[2]);
    reach[i] = along + (prism.round ? prism.radius_m * std::sqrt(std::max(0.0, 1.0 - row[2] * row[2]))
                                    : prism.half_x_m * std::fabs(row[0]) + prism.half_y_m * std::fabs(row[1]));
  }
  prism.reach_x_m = reach[0];
  prism.reach_y_m = reach[1];
  const double half_m = prism.upright ? 0.5 * proxy.height_m : reach[2];
  prism.low_m = middle_m - half_m;
  prism.high_m = middle_m + half_m;
  const double l = std::sqrt(r[0] * r[0] + r[4] * r[4]);
  if (!prism.upright || l <= 0.0) return;
  prism.cos_h = r[0] / l;
  prism.sin_h = r[4] / l;
}

Vector3 velocity_at(const BodyProxy& proxy, const Vector3& p_m) noexcept {
  if (proxy.light()) {
    const double w = proxy.next_w_rad_s;
    return {proxy.next_v_m_s[0] - w * (p_m[1] - proxy.p_m[1]), proxy.next_v_m_s[1] + w * (p_m[0] - proxy.p_m[0]),
            proxy.next_v_m_s[2]};
  }
  const dReal* c = dBodyGetPosition(proxy.body.get());
  const dReal* v = dBodyGetLinearVel(proxy.body.get());
  const dReal* w = dBodyGetAngularVel(proxy.body.get());
  const Vector3 arm{p_m[0] - c[0], p_m[1] - c[1], p_m[2] - c[2]};
  return {v[0] + w[1] * arm[2] - w[2] * arm[1], v[1] + w[2] * arm[0] - w[0] * arm[2],
          v[2] + w[0] * arm[1] - w[1] * arm[0]};
}

OdeGeom make_geom(const Prism& prism, double height_m, double skin_m) {
  const double height = height_m + 2.0 * skin_m;
  return OdeGeom::made_by([&] {
    if (prism.round) return dCreateCylinder(nullptr, prism.radius_m + skin_m, height);
    return dCreateBox(nullptr, 2.0 * (prism.half_x_m + skin_m), 2.0 * (prism.half_y_m + skin_m), height);
  });
}

dGeomID geom_of(BodyProxy& proxy, double skin_m) {
  if (!proxy.geom) proxy.geom = make_geom(proxy.prism, proxy.height_m, skin_m);
  const dGeomID geom = proxy.geom.get();
  if (proxy.light()) {
    dGeomSetPosition(geom, proxy.p_m[0], proxy.p_m[1], proxy.p_m[2] + 0.5 * proxy.height_m);
    return geom;
  }
  const dReal* p = dBodyGetPosition(proxy.body.get());
  const dReal* r = dBodyGetRotation(proxy.body.get());
  const double up = 0.5 * proxy.height_m - proxy.origin_m;
  dGeomSetPosition(geom, p[0] + up * r[2], p[1] + up * r[6], p[2] + up * r[10]);
  dGeomSetRotation(geom, r);
  return geom;
}

}  // namespace tandem::core
