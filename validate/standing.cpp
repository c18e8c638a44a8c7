#include "validate/standing.hpp"

#include <cmath>
#include <stdexcept>

#include "validate/scene.hpp"

namespace tandem::validate {

std::unique_ptr<library::OpenWorld> open_experiment(const std::string& name, std::uint64_t seed,
                                                    const std::vector<std::pair<std::string, std::string>>& replace,
                                                    const std::vector<std::string>& parameters) {
  std::string text = scene_text("experiments/" + name);
  for (const auto& [what, by] : replace) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
      text.replace(at, what.size(), by);
  }
  auto opened = library::open_world({.file = name, .text = text, .parameters = parameters, .seed = seed});
  if (!opened.ok()) throw std::runtime_error(opened.error().message);
  auto world = std::move(opened).value();
  world->world().start();
  return world;
}

Solids solids_of(const core::Space& space, double grown_m) {
  Solids solids;
  for (const core::Object& o : space.objects()) {
    if (o.kind == core::Object::Kind::Box)
      solids.boxes.push_back({o.x_m, o.y_m, std::atan2(o.sin_h, o.cos_h), 2.0 * (o.half_x_m + grown_m),
                              2.0 * (o.half_y_m + grown_m), o.z_low_m - grown_m, o.z_high_m + grown_m});
    else
      solids.cylinders.push_back({o.x_m, o.y_m, o.radius_m + grown_m, o.z_low_m - grown_m, o.z_high_m + grown_m, 0});
  }
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const core::Pose pose = space.pose(space.robot(i));
    const hal::Body& body = space.kind(space.robot(i)).body;
    solids.cylinders.push_back(
        {pose.x_m, pose.y_m, body.radius_m + grown_m, pose.z_m - grown_m, pose.z_m + body.height_m + grown_m, i + 1});
  }
  return solids;
}

}  // namespace tandem::validate
