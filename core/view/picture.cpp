#include "core/view/picture.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "core/space/stores.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

std::uint32_t kind_of(const hal::RobotKind& robot, Drawing& drawing) {
  for (std::uint32_t k = 0; k < drawing.kinds.size(); ++k) {
    if (drawing.kinds[k].name == robot.name) return k;
  }
  const auto* const leds = robot.part<hal::LedsPart>();
  const auto* const gripper = robot.part<hal::GripperPart>();
  Drawing::Kind kind{robot.name,
                     robot.body.radius_m,
                     {},
                     leds != nullptr && leds->on_turret,
                     gripper != nullptr ? gripper->reach_m : 0.0,
                     robot.body.height_m};
  if (const auto* const rotors = std::get_if<hal::Quadrotor>(&robot.locomotion)) kind.rotor_arm_m = rotors->rotor_arm_m;
  if (leds != nullptr) {
    for (const hal::Mount& led : leds->mounts) kind.leds.push_back({led.x_m, led.y_m, led.z_m});
  }
  drawing.kinds.push_back(std::move(kind));
  return static_cast<std::uint32_t>(drawing.kinds.size() - 1);
}

void add_lit_leds(const Space& space, RobotId id, Drawing::Robot& robot, Drawing& drawing) {
  robot.first_light = static_cast<std::uint32_t>(drawing.lit.size());
  const auto* leds = space.port<hal::RingLeds>(id);
  if (leds == nullptr) return;
  const std::size_t mounted = std::min(drawing.kinds[robot.kind].leds.size(), hal::RingLeds::kCapacity);
  for (std::uint32_t i = 0; i < mounted; ++i) {
    if (leds->color(i) == hal::kBlack) continue;
    drawing.lit.push_back({i, leds->color(i)});
    ++robot.lights;
  }
}

void add_robots(const Space& space, const PictureOptions& options, Drawing& drawing) {
  drawing.robots.reserve(space.robot_count());
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const RobotId id = space.robot(i);
    const Pose pose = space.pose(id);
    Drawing::Robot robot;
    robot.x_m = pose.x_m;
    robot.y_m = pose.y_m;
    robot.heading_rad = pose.heading_rad();
    robot.kind = kind_of(space.kind(id), drawing);
    robot.halted = space.halted(id);
    robot.turret_rad = space.turret_rad(id);
    robot.holding = space.holding(id);
    robot.z_m = pose.z_m;
    add_lit_leds(space, id, robot, drawing);
    drawing.robots.push_back(robot);
    if (options.look.ids) drawing.ids.push_back(space.robot_name(id));
    if (!space.external(id)) continue;
    drawing.real.push_back({i, space.robot_name(id), ""});
    for (const PictureOptions::Trouble& trouble : options.trouble) {
      if (trouble.robot == id) drawing.real.back().state = trouble.state;
    }
  }
}

}  // namespace

Drawing drawing_of(const Space& space, const PictureOptions& options) {
  Drawing drawing;
  drawing.title = options.experiment + ", seed " + std::to_string(options.seed) +
                  ", t = " + hal::format_number(hal::to_seconds(options.time_ns)) + " s";
  drawing.min_x_m = space.arena_center_x_m() - 0.5 * space.arena_size_x_m();
  drawing.max_x_m = space.arena_center_x_m() + 0.5 * space.arena_size_x_m();
  drawing.min_y_m = space.arena_center_y_m() - 0.5 * space.arena_size_y_m();
  drawing.max_y_m = space.arena_center_y_m() + 0.5 * space.arena_size_y_m();
  for (const Object& s : space.objects()) {
    if (!s.alive) continue;
    if (s.kind == Object::Kind::Cylinder) {
      drawing.cylinders.push_back({s.x_m, s.y_m, s.radius_m, s.movable, s.z_low_m, s.z_high_m - s.z_low_m});
    } else {
      const Pose pose{s.x_m, s.y_m, 0.0, s.cos_h, s.sin_h};
      drawing.boxes.push_back(
          {s.x_m, s.y_m, pose.heading_rad(), s.half_x_m, s.half_y_m, s.movable, s.z_low_m, s.z_high_m - s.z_low_m});
    }
  }
  for (const Region& region : space.stores().regions) {
    for (std::size_t i = 0; i < region.sides.size(); ++i) {
      const RegionSide& a = region.sides[i];
      const RegionSide& b = region.sides[(i + 1) % region.sides.size()];
      drawing.borders.push_back({a.x_m, a.y_m, b.x_m, b.y_m, a.wall});
    }
  }
  for (const LightSource& light : space.lights()) {
    if (light.alive) drawing.lights.push_back({light.x_m, light.y_m, light.color, light.z_m});
  }
  if (const Field* floor = space.stores().fields.find("floor"); floor != nullptr && floor->mark() != 0) {
    drawing.floor_mark = floor->mark();
    drawing.floor = [&space](double x_m, double y_m) { return space.floor(x_m, y_m); };
  }
  add_robots(space, options, drawing);
  if (options.trails != nullptr) options.trails->add_to(drawing, space, options.ticks_done);
  drawing.shapes = space.sketch().shapes();
  return drawing;
}

hal::Result<PictureFormat> picture_format(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".svg") return PictureFormat::Svg;
  if (ending == ".png") return PictureFormat::Png;
  if (ending == ".pdf") return PictureFormat::Pdf;
  return hal::Error{"the picture '" + path + "' must end in .svg, .png or .pdf"};
}

hal::Status write_picture(const Space& space, hal::OutputFile& file, const PictureOptions& options) {
  return write_picture(drawing_of(space, options), file, options.look);
}

hal::Status write_picture(const Drawing& drawing, hal::OutputFile& file, const PictureLook& look) {
  const auto format = picture_format(file.path());
  if (!format.ok()) return format.error();
  const auto rendered = render(to_svg(drawing, look), format.value());
  if (!rendered.ok()) return rendered.error();
  const hal::Status written = file.write(rendered.value());
  return written.ok() ? file.commit() : written;
}

}  // namespace tandem::core
