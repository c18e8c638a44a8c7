#include "core/view/picture.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <map>

#include "core/space/looks.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

/// The kinds of a drawing.
class Kinds {
 public:
  explicit Kinds(Drawing& drawing) : drawing_(drawing) {}

  std::uint32_t of(const hal::RobotKind& robot, const hal::Appearance& look) {
    const auto [entry, fresh] = known_.emplace(&robot, 0);
    if (fresh) {
      std::vector<Drawing::Kind>& all = drawing_.kinds;
      while (entry->second < all.size() && !(all[entry->second].name == robot.name && all[entry->second].look == look))
        ++entry->second;
      if (entry->second == all.size()) all.push_back({robot.name, robot.body.radius_m, look, robot.body.height_m});
    }
    return entry->second;
  }

 private:
  Drawing& drawing_;
  std::map<const hal::RobotKind*, std::uint32_t> known_;
};

void add_robots(const Space& space, const PictureOptions& options, Drawing& drawing) {
  const Looks looks(space);
  Kinds kinds(drawing);
  std::vector<DrivenValue> values;
  std::vector<LampRun> runs;
  std::vector<hal::Rgb> lamps;
  drawing.robots.reserve(space.robot_count());
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const RobotId id = space.robot(i);
    const Pose pose = space.pose(id);
    const hal::Appearance& look = looks.appearance(id);
    Drawing::Robot robot{pose.x_m, pose.y_m, pose.heading_rad(), kinds.of(space.kind(id), look)};
    robot.halted = space.halted(id);
    robot.z_m = pose.z_m;
    values.clear();
    looks.add_values(id, values);
    robot.first_value = static_cast<std::uint32_t>(drawing.values.size());
    for (const DrivenValue& value : values) drawing.values.push_back(value.value());
    runs.clear();
    looks.add_lamps(id, runs);
    lamps.assign(look.lamps.size(), hal::kBlack);
    for (const LampRun& run : runs) run.read(lamps.data());
    robot.first_light = static_cast<std::uint32_t>(drawing.lit.size());
    for (std::uint32_t lamp = 0; lamp < lamps.size(); ++lamp) {
      if (lamps[lamp] != hal::kBlack) drawing.lit.push_back({lamp, lamps[lamp]});
    }
    robot.lights = static_cast<std::uint32_t>(drawing.lit.size()) - robot.first_light;
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
  const auto there = [](const auto& one) { return one.alive; };
  std::copy_if(space.objects().begin(), space.objects().end(), std::back_inserter(drawing.objects), there);
  std::copy_if(space.lights().begin(), space.lights().end(), std::back_inserter(drawing.lights), there);
  for (const Region& region : space.stores().regions) {
    for (std::size_t i = 0; i < region.sides.size(); ++i) {
      const RegionSide& a = region.sides[i];
      const RegionSide& b = region.sides[(i + 1) % region.sides.size()];
      drawing.borders.push_back({a.x_m, a.y_m, b.x_m, b.y_m, a.wall});
    }
  }
  if (const Field* floor = space.stores().fields.find("floor"); floor != nullptr && floor->mark() != 0) {
    drawing.floor_mark = floor->mark();
    if (const FieldGrid grid = floor->grid(); grid.columns > 0)
      drawing.floor_pixels_per_m = static_cast<double>(grid.columns) / space.arena_size_x_m();
    drawing.floor = [&space](double x_m, double y_m) { return space.floor(x_m, y_m); };
    if (floor->color(space.stores(), space.arena_center_x_m(), space.arena_center_y_m()))
      drawing.floor_color = [&space, floor](double x_m, double y_m) {
        return floor->color(space.stores(), x_m, y_m).value_or(hal::kBlack);
      };
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
