#include "core/physics/particle3d/solid.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::core::particle3d {
namespace {

constexpr double kTouch_m = 1e-9;  // as deep as this is beside
constexpr int kRounds = 8;         // of pushing out, before a body in a wedge stays where it was
constexpr double kMostPieces = 1000.0;

void lose_speed_towards(Mover& body, double nx, double ny) noexcept {
  const double inwards = body.vx_m_s * nx + body.vy_m_s * ny;
  if (inwards >= 0.0) return;
  body.vx_m_s -= inwards * nx;
  body.vy_m_s -= inwards * ny;
}

bool at_height_of(const Object& object, const Mover& body) noexcept {
  return body.z_m < object.z_high_m - kTouch_m && body.z_m + body.height_m > object.z_low_m + kTouch_m;
}

}  // namespace

/// Something that a body is in: how far out, and where to. `object` is null for a wall.
struct Solid::Meeting {
  const Object* object;
  double nx, ny;
  double depth_m;
};

template <class Visit>
void Solid::each_meeting(const Mover& body, Visit&& visit) const noexcept {
  for (const std::uint32_t k : stores_.static_index.near(body.x_m, body.y_m)) {
    const Object& object = stores_.objects[k];
    if (!at_height_of(object, body)) continue;
    Meeting m{&object, 0.0, 0.0, 0.0};
    m.depth_m = body.radius_m - signed_distance(object, body.x_m, body.y_m, m.nx, m.ny);
    if (m.depth_m > kTouch_m) visit(m);
  }
  for (std::size_t i = 0; i < region_.sides.size(); ++i) {
    const RegionSide& a = region_.sides[i];
    if (!a.wall) continue;
    const RegionSide& b = region_.sides[(i + 1) % region_.sides.size()];
    double qx = 0.0;
    double qy = 0.0;
    const double d = distance_to_segment(body.x_m, body.y_m, a.x_m, a.y_m, b.x_m, b.y_m, qx, qy);
    if (d >= body.radius_m - kTouch_m) continue;
    const bool at_end = (qx == a.x_m && qy == a.y_m) || (qx == b.x_m && qy == b.y_m);
    Meeting m{nullptr, 0.0, 0.0, 0.0};
    if (at_end && d > 0.0) {
      m = {nullptr, (body.x_m - qx) / d, (body.y_m - qy) / d, body.radius_m - d};
    } else {  // towards the inside, which lies to the left, from whichever side the body's middle is on
      const double length = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
      m.nx = -(b.y_m - a.y_m) / length;
      m.ny = (b.x_m - a.x_m) / length;
      m.depth_m = body.radius_m - ((body.x_m - a.x_m) * m.nx + (body.y_m - a.y_m) * m.ny);
    }
    visit(m);
  }
}

bool Solid::near(const Mover& body, double way_m) const noexcept {
  Mover wider = body;
  wider.radius_m += way_m;
  wider.z_m -= way_m;
  wider.height_m += 2.0 * way_m;
  if (!stores_.static_index.empty() && stores_.static_index.reach() < wider.radius_m) return true;
  return inside_something(wider);
}

bool Solid::inside_something(const Mover& body) const noexcept {
  bool found = false;
  each_meeting(body, [&found](const Meeting&) { found = true; });
  return found;
}

bool Solid::carries(const Mover& body) const noexcept {
  for (const std::uint32_t k : stores_.static_index.near(body.x_m, body.y_m)) {
    const Object& object = stores_.objects[k];
    double nx = 0.0;
    double ny = 0.0;
    if (std::fabs(body.z_m - object.z_high_m) <= kTouch_m &&
        signed_distance(object, body.x_m, body.y_m, nx, ny) < body.radius_m - kTouch_m)
      return true;
  }
  return false;
}

void Solid::keep_between(Mover& body) const noexcept {
  const double ceiling = std::max(ceiling_m() - body.height_m, ground_m());
  if (body.z_m > ceiling) {
    body.z_m = ceiling;
    body.vz_m_s = std::min(body.vz_m_s, 0.0);
  }
  if (body.z_m <= ground_m()) {
    body.z_m = ground_m();
    body.vz_m_s = std::max(body.vz_m_s, 0.0);
    body.landed = true;
  }
}

void Solid::stop_short(Mover& body, double x_m, double y_m, double z_m) const noexcept {
  keep_between(body);
  for (int round = 0; round < kRounds; ++round) {
    bool met = false;
    // One after the other, each from where the one before left it.
    each_meeting(body, [&](const Meeting& m) {
      met = true;
      if (m.object != nullptr && z_m >= m.object->z_high_m - kTouch_m) {
        body.z_m = m.object->z_high_m;
        body.vz_m_s = std::max(body.vz_m_s, 0.0);
        body.landed = true;
      } else if (m.object != nullptr && z_m + body.height_m <= m.object->z_low_m + kTouch_m) {
        body.z_m = m.object->z_low_m - body.height_m;
        body.vz_m_s = std::min(body.vz_m_s, 0.0);
      } else {
        body.x_m += m.nx * m.depth_m;
        body.y_m += m.ny * m.depth_m;
        lose_speed_towards(body, m.nx, m.ny);
      }
    });
    if (!met) return;
  }
  if (!inside_something(body)) return;
  // In a wedge: back to where it was free, if it was.
  Mover before = body;
  before.x_m = x_m;
  before.y_m = y_m;
  before.z_m = z_m;
  if (inside_something(before)) return;
  before.vx_m_s = before.vy_m_s = before.vz_m_s = 0.0;
  body = before;
}

void Solid::stop(Mover& body, double x_m, double y_m, double z_m) const noexcept {
  // In pieces that jump over nothing, nor to the far side of a thin thing.
  const double dx = body.x_m - x_m;
  const double dy = body.y_m - y_m;
  const double dz = body.z_m - z_m;
  double piece_m = 0.5 * std::min(body.radius_m, body.height_m);
  if (!stores_.static_index.empty())
    piece_m = std::max(std::min(piece_m, stores_.static_index.reach() - body.radius_m), 1e-3);
  const double pieces = std::ceil(std::sqrt(dx * dx + dy * dy + dz * dz) / piece_m);
  const int count = static_cast<int>(std::clamp(pieces, 1.0, kMostPieces));
  body.x_m = x_m;
  body.y_m = y_m;
  body.z_m = z_m;
  for (int i = 0; i < count; ++i) {
    const double from_x = body.x_m;
    const double from_y = body.y_m;
    const double from_z = body.z_m;
    body.x_m += dx / count;
    body.y_m += dy / count;
    body.z_m += dz / count;
    stop_short(body, from_x, from_y, from_z);
  }
}

}  // namespace tandem::core::particle3d
