#include "core/run/scripts.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "core/space/stores.hpp"

namespace tandem::core {

using hal::Json;

std::vector<RobotId> robots_of(const World& world, std::size_t config) {
  const SpaceStores& s = world.space().stores();
  std::vector<RobotId> robots;
  for (const std::uint32_t entity : s.living) {
    const RobotEntity& e = s.robots[entity];
    if (s.groups[s.blocks[e.block].group].config == config) robots.push_back({entity, e.generation});
  }
  return robots;
}

std::vector<RobotId> robots_in_order(const World& world, std::size_t config) {
  const SpaceStores& s = world.space().stores();
  std::vector<RobotId> robots = robots_of(world, config);
  std::sort(robots.begin(), robots.end(), [&](RobotId a, RobotId b) {
    const auto place = [&](RobotId robot) {
      return std::pair(s.robots[robot.index].block, s.robots[robot.index].slot);
    };
    return place(a) < place(b);
  });
  return robots;
}

std::vector<hal::SourceFile> source_files(World& world, RobotId robot) {
  hal::SourceFilesTaker files;
  (void)world.visit_controls(robot, files);
  return files.files().value_or(std::vector<hal::SourceFile>());
}

Json source_files(World& world) {
  Json all = Json::object();
  const auto& configs = world.scenario().controllers;
  for (std::size_t c = 0; c < configs.size(); ++c) {
    const std::vector<RobotId> robots = robots_in_order(world, c);
    if (robots.empty() || source_files(world, robots.front()).empty()) continue;
    Json& list = all[configs[c].id] = Json::array();
    std::map<std::string, std::string> known;
    for (const RobotId robot : robots) {  // each may have a script of its own
      for (hal::SourceFile& file : source_files(world, robot)) {
        if (known.emplace(file.name, file.path).second)
          list.push_back({{"name", file.name}, {"path", file.path}, {"text", std::move(file.text)}});
      }
    }
  }
  return all;
}

}  // namespace tandem::core
