#include "core/physics/dynamics3d/contacts.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::core {
namespace {

constexpr double kNear_m = 5e-4;         // gaps that count as contacts even of bodies at rest
constexpr double kCarriesUpTo_m = 2e-4;  // gaps of bodies at rest that do not keep them from being carried
constexpr double kSkin_m = 2e-3;         // around bodies that lean, for ODE's finders see overlaps only
constexpr double kSlides_m_s = 1e-6;
constexpr double kCarries = 0.7;        // vertical share of a normal from which on a body stands on what it touches
constexpr double kCasterLift_m = 1e-4;  // wheels, not casters, carry the weight
constexpr double kCasterPlace = 0.8;    // of the radius, ahead of and behind the axle
constexpr double kLeans = 0.99;         // cosine from which on a chassis may touch the floor by its rims

/// A point of a body's frame in W.
Vector3 in_world(const dReal* p, const dReal* r, double x, double y, double z) noexcept {
  return {p[0] + r[0] * x + r[1] * y + r[2] * z, p[1] + r[4] * x + r[5] * y + r[6] * z,
          p[2] + r[8] * x + r[9] * y + r[10] * z};
}

/// Along which friction acts first: against the sliding, so that it is Coulomb's in every direction; any direction
/// when nothing slides.
Vector3 first_direction(const Vector3& normal, const Vector3& slip, bool level) noexcept {
  if (!level) {
    const double along = dot(slip, normal);
    Vector3 d{slip[0] - along * normal[0], slip[1] - along * normal[1], slip[2] - along * normal[2]};
    const double size = std::sqrt(dot(d, d));
    if (size > kSlides_m_s) return {d[0] / size, d[1] / size, d[2] / size};
  }
  const double size = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1]);
  if (size > 0.1) return {-normal[1] / size, normal[0] / size, 0.0};
  const double other = std::sqrt(normal[0] * normal[0] + normal[2] * normal[2]);
  return {normal[2] / other, 0.0, -normal[0] / other};
}

bool on_floor(const BodyProxy& proxy) noexcept {
  return proxy.sort == Sort::Wheels || (proxy.sort == Sort::Base && !proxy.aloft);
}

bool moves(const BodyProxy* proxy) noexcept {
  return proxy != nullptr && !proxy->external;
}

}  // namespace

void Contacts::touch(BodyProxy& a, BodyProxy* b) {
  const auto take = [&](BodyProxy& proxy, const BodyProxy* other) {
    if (!proxy.light()) return;
    give_body(proxy, world_);
    proxy.touched = true;
    proxy.engaged = proxy.engaged || (proxy.sort == Sort::Base && !proxy.external && moves(other));
  };
  take(a, b);
  if (b != nullptr) take(*b, &a);
}

void Contacts::note_support(BodyProxy& a, BodyProxy* b, const Touch& at, const Grip& grip) {
  if (a.robot() || (b != nullptr && b->robot())) {
    a.driven = true;
    if (b != nullptr) b->driven = true;
    return;
  }
  if (b != nullptr) {
    BodyProxy& top = top_of_heap(a);
    BodyProxy& other = top_of_heap(*b);
    if (&top != &other) other.heap = &top;
  }
  if (at.depth_m > -kCarriesUpTo_m)
    supports_.push_back({&a, b, at.p_m, at.normal, std::min(grip.along, grip.across), at.depth_m});
}

void Contacts::add(BodyProxy& a, BodyProxy* b, const Touch& at, const Grip& grip) {
  touch(a, b);
  note_support(a, b, at, grip);
  if (at.normal[2] > kCarries) a.standing = true;
  if (b != nullptr && at.normal[2] < -kCarries) b->standing = true;
  Vector3 slip = velocity_at(a, at.p_m);
  if (b != nullptr) {
    const Vector3 v = velocity_at(*b, at.p_m);
    for (std::size_t i = 0; i < 3; ++i) slip[i] -= v[i];
  }
  join(a.body.get(), b == nullptr ? nullptr : b->body.get(), at, grip, first_direction(at.normal, slip, grip.level));
}

void Contacts::join(dBodyID a, dBodyID b, const Touch& at, const Grip& grip, const Vector3& first) {
  dContact contact{};
  contact.surface.mode = dContactMotionN | dContactApprox1_1 | dContactApprox1_2 | dContactMu2 | dContactFDir1;
  contact.surface.motionN = at.depth_m < 0.0 ? at.depth_m / dt_s_ : 0.0;
  contact.surface.mu = grip.along;
  contact.surface.mu2 = grip.across;
  contact.geom.depth = std::max(at.depth_m, 0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    contact.geom.pos[i] = at.p_m[i];
    contact.geom.normal[i] = at.normal[i];
    contact.fdir1[i] = first[i];
  }
  const dJointID joint = dJointCreateContact(world_, group_.get(), &contact);
  dJointAttach(joint, a, b);
  residual_->add_contact(joint, a, b, contact);
}

void Contacts::lean(BodyProxy& a, BodyProxy* b, dGeomID geom_b, const Prism& prism_b, const Grip& grip) {
  if (a.prism.low_m > prism_b.high_m + 2.0 * kSkin_m || prism_b.low_m > a.prism.high_m + 2.0 * kSkin_m) return;
  std::array<dContactGeom, kMostTouches> found{};
  const int count = dCollide(geom_of(a, kSkin_m), geom_b, kMostTouches, found.data(), sizeof(dContactGeom));
  for (int i = 0; i < count; ++i) {
    const dContactGeom& g = found[static_cast<std::size_t>(i)];
    add(a, b, {{g.pos[0], g.pos[1], g.pos[2]}, {g.normal[0], g.normal[1], g.normal[2]}, g.depth - 2.0 * kSkin_m}, grip);
  }
}

void Contacts::between(BodyProxy& a, BodyProxy& b, const Surfaces& surfaces) {
  const bool robot = a.robot() || b.robot();
  const Grip side{surfaces.robot_friction, 0.0, true};
  const Grip any{surfaces.object_friction, surfaces.object_friction, false};
  if (!a.prism.upright || !b.prism.upright || !(a.prism.round || b.prism.round)) {
    lean(a, &b, geom_of(b, kSkin_m), b.prism, robot ? side : any);
    return;
  }
  Touches touches;
  const TouchQuery query{kNear_m + a.hop_m + b.hop_m, on_floor(a) && on_floor(b), !robot,
                         static_cast<double>(a.key.value)};
  const std::size_t count = find_touches(a.prism, b.prism, query, touches);
  for (std::size_t i = 0; i < count; ++i) {
    if (a.robot() && b.robot()) {
      double& deepest = a.drive != nullptr && b.drive != nullptr ? overlap_ : overlap_in_flight_;
      deepest = std::max(deepest, touches[i].depth_m / (2.0 * std::min(a.prism.radius_m, b.prism.radius_m)));
    }
    add(a, &b, touches[i], robot && touches[i].normal[2] == 0.0 ? side : any);
  }
}

void Contacts::with_still(BodyProxy& a, Still& still, const Surfaces& surfaces) {
  const Grip side{surfaces.robot_friction, 0.0, true};
  const Grip any{surfaces.object_friction, surfaces.object_friction, false};
  if (!a.prism.upright || !still.prism.upright || !(a.prism.round || still.prism.round)) {
    if (!still.geom) {
      still.geom = make_geom(still.prism, still.height_m, kSkin_m);
      dMatrix3 r;
      if (still.prism.upright)
        dRFromAxisAndAngle(r, 0.0, 0.0, 1.0, std::atan2(still.prism.sin_h, still.prism.cos_h));
      else
        dRfromQ(r, still.q_W.data());
      dGeomSetRotation(still.geom.get(), r);
      dGeomSetPosition(still.geom.get(), still.prism.x_m, still.prism.y_m,
                       0.5 * (still.prism.low_m + still.prism.high_m));
    }
    lean(a, nullptr, still.geom.get(), still.prism, a.robot() ? side : any);
    return;
  }
  Touches touches;
  const TouchQuery query{kNear_m + a.hop_m, still.wall, !a.robot(), 0.0};
  const std::size_t count = find_touches(a.prism, still.prism, query, touches);
  for (std::size_t i = 0; i < count; ++i) {
    const bool rolls = a.sort == Sort::Base && touches[i].normal[2] > kCarries;  // its drive is its friction
    const bool beside = a.robot() && touches[i].normal[2] == 0.0;
    add(a, nullptr, touches[i], rolls ? Grip{} : beside ? side : any);
  }
}

void Contacts::with_ground(BodyProxy& a, const Surfaces& surfaces) {
  const double near_m = kNear_m + a.hop_m;
  if (a.sort == Sort::Wheels) wheels_on_floor(a, surfaces);
  const Grip grip{surfaces.floor_friction, surfaces.floor_friction, false};
  const bool stands_on_wheels = a.sort == Sort::Wheels && dBodyGetRotation(a.body.get())[10] > kLeans;
  if (!stands_on_wheels && a.prism.low_m < surfaces.floor_m + near_m) support(a, surfaces.floor_m, 1.0, grip);
  if (a.prism.high_m > surfaces.ceiling_m - near_m) support(a, surfaces.ceiling_m, -1.0, grip);
}

/// Contacts of a box's corners, or of points on a cylinder's rims, with a level plane that lies below (`up` 1) or
/// above (-1).
void Contacts::support(BodyProxy& a, double level_m, double up, const Grip& grip) {
  if (a.prism.round) {
    ends_of_cylinder(a, level_m, up, grip);
    return;
  }
  const dReal* p = dBodyGetPosition(a.body.get());
  const dReal* r = dBodyGetRotation(a.body.get());
  for (const double sz : {-0.5, 0.5}) {
    for (const double sx : {-1.0, 1.0}) {
      for (const double sy : {-1.0, 1.0}) {
        const Vector3 corner = in_world(p, r, sx * a.prism.half_x_m, sy * a.prism.half_y_m, sz * a.height_m);
        point_on_level(a, corner, level_m, up, grip);
      }
    }
  }
}

void Contacts::ends_of_cylinder(BodyProxy& a, double level_m, double up, const Grip& grip) {
  const dReal* p = dBodyGetPosition(a.body.get());
  const dReal* r = dBodyGetRotation(a.body.get());
  const double radius = a.prism.radius_m;
  // Of each end: four points of the rim, the lowest among them when it leans; else they stay where they are on it.
  double c = 1.0;
  double s = 0.0;
  const double lean = std::sqrt(r[8] * r[8] + r[9] * r[9]);
  if (!a.prism.upright && lean > 0.0) {
    c = r[8] / lean;
    s = r[9] / lean;
  }
  const double middle = 0.5 * a.height_m - a.origin_m;
  for (const double sz : {-0.5, 0.5}) {
    for (const auto& [dx, dy] : {std::array{c, s}, std::array{-s, c}, std::array{-c, -s}, std::array{s, -c}})
      point_on_level(a, in_world(p, r, radius * dx, radius * dy, middle + sz * a.height_m), level_m, up, grip);
  }
}

void Contacts::point_on_level(BodyProxy& a, const Vector3& p_m, double level_m, double up, const Grip& grip) {
  const double gap_m = up * (p_m[2] - level_m);
  if (gap_m < kNear_m + a.hop_m) add(a, nullptr, {p_m, {0.0, 0.0, up}, -gap_m}, grip);
}

void Contacts::wheels_on_floor(BodyProxy& a, const Surfaces& surfaces) {
  const dReal* p = dBodyGetPosition(a.body.get());
  const dReal* r = dBodyGetRotation(a.body.get());
  for (const double side : {-kCasterPlace, kCasterPlace}) {
    const Vector3 caster = in_world(p, r, side * a.prism.radius_m, 0.0, kCasterLift_m - a.origin_m);
    point_on_level(a, caster, surfaces.floor_m, 1.0, {});
  }
  for (const OdeBody& wheel : a.wheels) {
    const dReal* centre = dBodyGetPosition(wheel.get());
    const dReal* turn = dBodyGetRotation(wheel.get());
    const Vector3 axis{turn[1], turn[5], turn[9]};
    Vector3 ahead = cross(axis, {0.0, 0.0, 1.0});
    const double size = std::sqrt(dot(ahead, ahead));
    if (size < 0.1) continue;  // it lies on its side
    for (double& x : ahead) x /= size;
    const Vector3 down = cross(axis, ahead);  // of the disc: its lowest point lies there
    const double radius = a.drive->wheel_radius_m;
    Touch at;
    for (std::size_t i = 0; i < 3; ++i) at.p_m[i] = centre[i] + radius * down[i];
    at.normal = {0.0, 0.0, 1.0};
    at.depth_m = surfaces.floor_m - at.p_m[2];
    if (at.depth_m < -kNear_m - a.hop_m) continue;
    const Grip grip{surfaces.wheel_friction, surfaces.wheel_friction, true};
    join(wheel.get(), nullptr, at, grip, ahead);
  }
}

}  // namespace tandem::core
