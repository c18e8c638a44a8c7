// Cameras against the geometry of a pinhole and of a mirror above the robot, and lines of sight by the ray caster.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <span>

#include "core/sim/world.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/leds.hpp"
#include "validate/compared.hpp"
#include "validate/sensor_tables.hpp"

namespace tandem::validate {
namespace {

using Point = std::array<double, 3>;

constexpr double kGrown_m = 0.003;  // LEDs sit on surfaces: what passes by one within 3 mm is left out
constexpr double kWidth_px = 640.0, kHeight_px = 480.0;
constexpr double kAperture_rad = M_PI / 6.0;         // from the axis of a lens to a corner of its image
constexpr double kMirror_m = 0.2887;                 // height of a foot-bot's camera that looks all around
constexpr double kCone_rad = 70.0 * M_PI / 180.0;    // from straight down to the farthest that it sees
constexpr double kShines_rad = 60.0 * M_PI / 180.0;  // an eye-bot's lower ring, from straight down
constexpr double kFootbotSees_m = 2.0, kEyebotSees_m = 3.5;

double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// An LED that shines in a colour of its own.
struct Lamp {
  Point at{};
  std::size_t owner = 0;  ///< number of its robot, from 1 on
  bool beneath = false;   ///< shines downwards, whatever its robot's body
  std::array<int, 3> rgb{};
};

std::vector<Lamp> lit(core::Space& space) {
  std::vector<Lamp> lamps;
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const core::RobotId robot = space.robot(i);
    const bool flies = space.kind(robot).name == "eye-bot";
    const core::Pose pose = space.pose(robot);
    auto* const ring = space.port<hal::RingLeds>(robot);
    const auto& mounts = space.kind(robot).part<hal::LedsPart>()->mounts;
    for (std::size_t k = 0; k < mounts.size(); ++k) {
      const hal::Mount& m = mounts[k];
      const hal::Rgb color{static_cast<std::uint8_t>(i + 1), static_cast<std::uint8_t>(k + 1), 200};
      ring->set(k, color);
      lamps.push_back({{pose.x_m + pose.cos_h * m.x_m - pose.sin_h * m.y_m,
                        pose.y_m + pose.sin_h * m.x_m + pose.cos_h * m.y_m, pose.z_m + m.z_m},
                       i + 1,
                       flies,
                       {color.r, color.g, color.b}});
    }
  }
  return lamps;
}

/// Whether nothing is between a camera of robot `own` and a lamp that shines at it.
std::optional<bool> in_sight(const Things& things, const Point& from, std::size_t own, const Lamp& lamp) {
  const Point up{from[0] - lamp.at[0], from[1] - lamp.at[1], from[2] - lamp.at[2]};
  if (lamp.beneath) {
    const double off = std::acos(-up[2] / std::sqrt(dot(up, up)));
    if (std::abs(off - kShines_rad) < 1e-6) return std::nullopt;
    if (off > kShines_rad) return false;
  }
  const auto free = [&](const Solids& solids) {
    return !blocked(solids, from, lamp.at, own, lamp.beneath ? lamp.owner : 0);
  };
  const bool is = free(things.exact);
  if (is != free(things.smaller) || is != free(things.larger)) return std::nullopt;
  return is;
}

/// A blob as a camera tells it.
struct Blob {
  std::array<double, 2> at{};
  std::array<int, 3> rgb{};
};

/// Where a light appears; outside: negative, by how much it is beyond the reach, in parts of it.
struct Appears {
  std::array<double, 2> at{};
  double room = 1.0;   ///< to the border of what is in reach: negative beyond it
  bool inside = true;  ///< Sighting::inside
};

/// A camera of a robot, its image's geometry, and what it says that it sees.
struct Eye {
  Sighting::Camera camera;
  Point from{};
  Point axis{}, top{};  ///< where a lens looks, and which way the top of its image lies
  double range_m = 0.0;
  std::vector<Blob> blobs;
  bool full = false;  ///< more were in sight than it can tell

  Appears appears(const Point& at) const {
    const Point p{at[0] - from[0], at[1] - from[1], at[2] - from[2]};
    return camera == Sighting::Camera::AllAround ? around(p) : through_lens(p);
  }

 private:
  /// Along the ground, ahead and to the left: of what is beneath it, up to where the cone meets the ground.
  Appears around(const Point& p) const {
    const double reach_m = kMirror_m * std::tan(kCone_rad), way_m = std::hypot(p[0], p[1]);
    return {{p[0] * axis[0] + p[1] * axis[1], p[1] * axis[0] - p[0] * axis[1]},
            std::min(1.0 - way_m / reach_m, -p[2]),
            true};
  }
  Appears through_lens(const Point& p) const {
    const double depth = dot(p, axis), far_m = std::sqrt(dot(p, p));
    if (depth <= 0.0) return {{}, -1.0, false};
    const double px = std::hypot(0.5 * kWidth_px, 0.5 * kHeight_px) / std::tan(kAperture_rad) / depth;
    const double x = 0.5 * kWidth_px + px * dot(p, cross(axis, top)), y = 0.5 * kHeight_px - px * dot(p, top);
    const double border = std::min({x, kWidth_px - x, y, kHeight_px - y});
    return {{x, y}, std::min(1.0 - far_m / range_m, border), border > 8.0};
  }
};

Eye all_around(const core::Space& space, std::size_t i) {
  const core::Pose pose = space.pose(space.robot(i));
  const auto& port = *space.port<hal::OmnidirectionalCamera>(space.robot(i));
  Eye eye{Sighting::Camera::AllAround,
          {pose.x_m, pose.y_m, pose.z_m + kMirror_m},
          {pose.cos_h, pose.sin_h, 0.0},
          {},
          0.0,
          {},
          port.dropped > 0};
  for (std::size_t k = 0; k < port.count; ++k) {
    const double far = static_cast<double>(port.distance_m[k]), bearing = static_cast<double>(port.bearing_rad[k]);
    const hal::Rgb c = port.color(k);
    eye.blobs.push_back({{far * std::cos(bearing), far * std::sin(bearing)}, {c.r, c.g, c.b}});
  }
  return eye;
}

Eye lens(const core::Space& space, std::size_t i) {
  const core::RobotId robot = space.robot(i);
  const core::Pose pose = space.pose(robot);
  const Point ahead{pose.cos_h, pose.sin_h, 0.0}, back{-pose.cos_h, -pose.sin_h, 0.0};
  const auto& port = *space.port<hal::PerspectiveCamera>(robot);
  const auto& part = *space.kind(robot).part<hal::CameraPart>();
  Eye eye{Sighting::Camera::Down, {pose.x_m, pose.y_m, pose.z_m}, {0.0, 0.0, -1.0}, ahead, kEyebotSees_m, {},
          port.dropped > 0};
  if (space.robot_name(robot).starts_with("front"))
    eye = {Sighting::Camera::Ahead,
           {pose.x_m + part.front.x_m * pose.cos_h, pose.y_m + part.front.x_m * pose.sin_h, pose.z_m + part.front.z_m},
           ahead,
           {0.0, 0.0, 1.0},
           kFootbotSees_m,
           {},
           port.dropped > 0};
  else if (space.robot_name(robot).starts_with("up"))
    eye = {Sighting::Camera::Up, {pose.x_m, pose.y_m, pose.z_m + part.usual.z_m},
           {0.0, 0.0, 1.0},      back,
           kFootbotSees_m,       {},
           port.dropped > 0};
  for (std::size_t k = 0; k < port.count; ++k) {
    const hal::Rgb c = port.color(k);
    eye.blobs.push_back({{static_cast<double>(port.x_px[k]), static_cast<double>(port.y_px[k])}, {c.r, c.g, c.b}});
  }
  return eye;
}

void compare(const Eye& eye, std::size_t own, const Things& things, std::span<const Lamp> lamps,
             std::vector<Sighting>& all, std::size_t& strangers) {
  std::map<std::array<int, 3>, Blob> found;
  for (const Blob& blob : eye.blobs) found[blob.rgb] = blob;
  if (found.size() != eye.blobs.size()) strangers += eye.blobs.size() - found.size();
  for (const Lamp& lamp : lamps) {
    if (lamp.owner == own) continue;
    const auto blob = found.find(lamp.rgb);
    const Appears image = eye.appears(lamp.at);
    Sighting sighting{eye.camera, false, blob != found.end(), {}, image.inside};
    if (sighting.found) {
      sighting.error = {blob->second.at[0] - image.at[0], blob->second.at[1] - image.at[1]};
      found.erase(blob);
    }
    if (image.room < -1e-6 && !sighting.found) continue;
    if (image.room > -1e-6) sighting.should = in_sight(things, eye.from, own, lamp);
    if (std::abs(image.room) <= 1e-6) sighting.should.reset();
    if (eye.full && !sighting.found) sighting.should.reset();
    all.push_back(sighting);
  }
  strangers += found.size();
}

}  // namespace

std::vector<Sighting> sightings(const std::string& implementation, std::uint64_t seed, int ticks,
                                std::size_t& strangers) {
  const auto opened = open_experiment("seen.xml", seed, {{"{camera}", implementation}});
  core::World& world = opened->world();
  core::Space& space = world.space();
  for (int tick = 0; tick < 3; ++tick) {  // colours are seen a tick after they were set
    lit(space);
    world.step();
  }
  std::vector<Sighting> all;
  for (int tick = 0; tick < ticks; ++tick) {
    const std::vector<Lamp> lamps = lit(space);
    world.step();
    const Things things(space, kGrown_m);
    for (std::size_t i = 0; i < space.robot_count(); ++i) {
      if (space.port<hal::OmnidirectionalCamera>(space.robot(i)) != nullptr)
        compare(all_around(space, i), i + 1, things, lamps, all, strangers);
      compare(lens(space, i), i + 1, things, lamps, all, strangers);
    }
  }
  return all;
}

Table camera_table(Depth depth) {
  struct Judged {
    const char* words;
    double most, scale;
    const char* unit;
    const char* contract;
    Compared presence = {}, places = {};
  };
  std::array<Judged, 4> all = {{{"all around, foot-bot", 1e-6, 1e6, "µm", "at most 1 µm"},
                                {"lens ahead, foot-bot", 1e-3, 1.0, "pixels", "at most 0.001 pixels"},
                                {"lens upwards, foot-bot", 1e-3, 1.0, "pixels", "at most 0.001 pixels"},
                                {"lens downwards, eye-bot", 1e-3, 1.0, "pixels", "at most 0.001 pixels"}}};
  const std::uint64_t worlds = depth == Depth::Short ? 3 : 40;
  std::size_t strangers = 0;
  for (std::uint64_t seed = 1; seed <= worlds; ++seed)
    for (const Sighting& s : sightings("ideal", seed, 1, strangers)) {
      Judged& judged = all[static_cast<std::size_t>(s.camera)];
      if (!s.should)
        ++judged.presence.edges;
      else
        judged.presence.add(*s.should == s.found ? 0.0 : 1.0, 0.0);
      if (s.found) judged.places.add(std::hypot(s.error[0], s.error[1]), judged.most);
    }
  Table table{
      "Cameras",
      fmt::format("{} worlds of 30 foot-bots on the floor and 12 eye-bots above them, all lit, among boxes and "
                  "cylinders. Whether a light in reach is seen, against lines of sight of the ray caster (those "
                  "that pass by an edge within 3 mm are left out); where it appears, against the geometry of a "
                  "pinhole, and of the ground beneath a mirror.",
                  worlds),
      {"camera", "readings", "largest difference"},
      {}};
  for (const Judged& j : all) {
    table.rows.push_back(compared_row(fmt::format("{}: seen or not", j.words), j.presence, 1.0, "", "equal"));
    table.rows.push_back(compared_row(fmt::format("{}: places", j.words), j.places, j.scale, j.unit, j.contract));
  }
  table.rows.push_back({{"blobs that are no light's, or seen twice", "", fmt::format("{}", strangers)},
                        "none",
                        verdict_of(strangers == 0)});
  return table;
}

}  // namespace tandem::validate
