#include "core/space/looks.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace tandem::core {
namespace {

/// Without the role of a port.
std::string_view bare(std::string_view row) noexcept {
  for (const std::string_view role : {"sensor ", "actuator "}) {
    if (row.starts_with(role)) return row.substr(role.size());
  }
  return row;
}

}  // namespace

double DrivenValue::value() const noexcept {
  if (row == nullptr) return 0.0;
  const double value = hal::get_value(row, *field, static_cast<std::size_t>(driver->index));
  if (driver->as_switch) return value == driver->off ? 0.0 : 1.0;
  return std::isfinite(value) ? value : 0.0;
}

void LampRun::read(hal::Rgb* lamps) const noexcept {
  static_assert(sizeof(hal::Rgb) == 3);
  if (rgb != nullptr)
    std::memcpy(static_cast<void*>(lamps + first), rgb, count * sizeof(hal::Rgb));
  else
    lamps[first] = switched.value() != 0.0 ? color : hal::kBlack;
}

hal::Rgb rgb_of(std::string_view hex) noexcept {
  hal::Rgb color;
  std::uint32_t bits = 0;
  if (hal::is_color(hex)) (void)std::from_chars(hex.data() + 1, hex.data() + hex.size(), bits, 16);
  color.r = static_cast<std::uint8_t>(bits >> 16);
  color.g = static_cast<std::uint8_t>(bits >> 8);
  color.b = static_cast<std::uint8_t>(bits);
  return color;
}

const std::byte* Looks::Place::row(const RobotBlock& block, std::size_t number, std::size_t slot) const noexcept {
  if (type == nullptr) return nullptr;
  const std::byte* const rows = column != nullptr ? column->array(number) : block.ports[port];
  return rows == nullptr ? nullptr : rows + slot * type->size;
}

Looks::Place Looks::place_of(const RobotGroup& group, std::string_view row) noexcept {
  const std::string_view name = bare(row);
  if (name == row) {
    for (const KeptColumn& column : group.columns) {
      if (column.type->name == row) return {column.type, column.arrays, 0};
    }
    return {};
  }
  const hal::Role role = row.front() == 's' ? hal::Role::Sensor : hal::Role::Actuator;
  for (std::size_t p = 0; p < group.ports.size(); ++p) {
    if (group.ports[p]->role == role && group.ports[p]->name == name) return {group.ports[p], nullptr, p};
  }
  return {};
}

/// So many values of the field are wanted, from the driver's index on.
Looks::Driven Looks::driven(const RobotGroup& group, const hal::Driver& driver, std::size_t values) noexcept {
  Driven found{place_of(group, driver.row), nullptr, &driver};
  if (found.place.type != nullptr) found.field = found.place.type->field(driver.field);
  const bool there = found.field != nullptr && driver.index >= 0 &&
                     static_cast<std::size_t>(driver.index) + values <= found.field->count;
  if (!there) found.place.type = nullptr;
  return found;
}

Looks::Looks(const Space& space) : stores_(space.stores()), groups_(stores_.groups.size()) {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    const RobotGroup& robots = stores_.groups[g];
    Group& group = groups_[g];
    group.appearance = hal::appearance_of(*robots.kind);
    for (const hal::Driver* const driver : group.appearance.drivers())
      group.values.push_back(driven(robots, *driver, 1));
    for (const hal::Appearance::Lamp& lamp : group.appearance.lamps) {
      Driven& light = group.lamps.emplace_back(driven(robots, lamp.by, lamp.color.empty() ? 3 : 1));
      if (lamp.color.empty() && light.field != nullptr && light.field->scalar != hal::Scalar::U8)
        light.place.type = nullptr;
    }
  }
}

const Looks::Group& Looks::group_of(RobotId robot) const noexcept {
  return groups_[stores_.blocks[stores_.robots[robot.index].block].group];
}

const hal::Appearance& Looks::appearance(RobotId robot) const noexcept {
  return group_of(robot).appearance;
}

DrivenValue Looks::value_of(const Driven& driven, const RobotEntity& robot) const noexcept {
  return {driven.place.row(stores_.blocks[robot.block], robot.block, robot.slot), driven.field, driven.driver};
}

void Looks::add_values(RobotId robot, std::vector<DrivenValue>& to) const {
  for (const Driven& driven : group_of(robot).values) to.push_back(value_of(driven, stores_.robots[robot.index]));
}

void Looks::add_lamps(RobotId robot, std::vector<LampRun>& to) const {
  const Group& group = group_of(robot);
  const std::size_t before = to.size();
  for (std::uint32_t i = 0; i < group.lamps.size(); ++i) {
    const DrivenValue light = value_of(group.lamps[i], stores_.robots[robot.index]);
    if (light.row == nullptr) continue;
    const std::string& color = group.appearance.lamps[i].color;
    if (!color.empty()) {
      to.push_back({i, 1, nullptr, light, rgb_of(color)});
      continue;
    }
    const std::byte* const rgb = light.row + light.field->offset + light.driver->index;
    if (to.size() > before && to.back().rgb != nullptr && to.back().first + to.back().count == i &&
        to.back().rgb + 3 * std::size_t{to.back().count} == rgb)
      ++to.back().count;
    else
      to.push_back({i, 1, rgb, {}, {}});
  }
}

std::vector<std::string> driven_rows(const std::vector<const hal::RobotKind*>& kinds) {
  std::vector<std::string> rows;
  const auto add = [&rows](const hal::Driver& driver) {
    if (!driver.row.empty() && std::find(rows.begin(), rows.end(), driver.row) == rows.end())
      rows.push_back(driver.row);
  };
  for (const hal::RobotKind* const kind : kinds) {
    const hal::Appearance look = hal::appearance_of(*kind);
    for (const hal::Driver* const driver : look.drivers()) add(*driver);
    for (const hal::Appearance::Lamp& lamp : look.lamps) add(lamp.by);
  }
  return rows;
}

std::string_view row_name(const std::vector<std::string>& rows, std::string_view row) noexcept {
  const bool alone = std::none_of(rows.begin(), rows.end(),
                                  [row](const std::string& other) { return other != row && bare(other) == bare(row); });
  return alone ? bare(row) : row;
}

}  // namespace tandem::core
