#include "core/sim/snapshot.hpp"

#include <algorithm>
#include <exception>

#include "core/space/space.hpp"
#include "hal/plugin_call.hpp"

namespace tandem::core {
namespace {

void name_copy(const void* type, std::size_t /*part*/, std::size_t /*index*/, hal::FixedText& out) noexcept {
  out << "a controller of class '" << static_cast<const hal::ControllerType*>(type)->name << "', while it was copied,";
}

std::string name_of(const Space& space, std::size_t row) {
  const SpaceStores& s = space.stores();
  const std::uint32_t entity = s.bodies.entity[row];
  return "robot '" + space.robot_name({entity, s.robots[entity].generation}) + "'";
}

}  // namespace

std::string copied(const hal::ControllerType& type, void* where, const void* from) {
  const hal::PluginCall call(&name_copy, &type);
  try {
    type.copy(where, from);
    return {};
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    return "an exception of unknown type";
  }
}

void note_other_state(SpaceStores& s) {
  ++s.generations;  // who looks for newcomers finds those who are back
  ++s.immovables_version;
  ++s.object_leds_version;
  ++s.poses_version;
  s.touched.clear();
  s.bodies_changed = true;
}

hal::Result<std::unique_ptr<SpaceCopy>> SpaceCopy::take(const Space& space, const RobotDevices& devices) {
  const SpaceStores& s = space.stores();
  std::unique_ptr<SpaceCopy> copy(new SpaceCopy);
  copy->groups_ = s.groups;
  copy->blocks_.reserve(s.blocks.size());
  for (std::size_t b = 0; b < s.blocks.size(); ++b) {
    if (const hal::Status done = copy->copy_block(space, b); !done.ok()) return done.error();
  }
  for (const auto& column : s.columns.all()) copy->column_arrays_.emplace_back(column.get(), column->of_block);
  copy->parts_ = parts_of(s);
  copy->devices_ = devices;
  for (const Fields::Entry& entry : s.fields.all()) copy->fields_.push_back(entry.field->keep());
  return copy;
}

hal::Status SpaceCopy::copy_block(const Space& space, std::size_t b) {
  const RobotBlock& from = space.stores().blocks[b];
  Block& to = blocks_.emplace_back();
  to.was = from;
  const hal::ControllerType& type = type_of(to);
  for (std::size_t p = 0; p < from.ports.size(); ++p) {
    const std::byte* bytes = from.ports[p];
    to.ports.emplace_back(bytes, bytes + groups_[from.group].ports[p]->size * from.capacity);
  }
  for (const KeptColumn& column : groups_[from.group].columns) {
    const std::byte* rows = column.arrays->array(b);
    to.columns.emplace_back(rows, rows + column.type->size * from.capacity);
  }
  to.controllers = memory_.take(from.controller_stride * from.capacity, type.align);
  for (; to.copied < from.used; ++to.copied) {
    if (from.constructed[to.copied] == 0) continue;
    const std::string who = name_of(space, from.first_row + to.copied);
    if (type.copy == nullptr) {
      return hal::Error{"no snapshot: the controller '" + std::string(type.name) + "' of " + who +
                        " cannot be copied. Give its class a copy constructor: members that are values, no unique_ptr"};
    }
    const std::string why = copied(type, to.controller(to.copied), from.controller(to.copied));
    if (!why.empty()) return hal::Error{"no snapshot: copying the controller of " + who + " threw: " + why};
  }
  return {};
}

std::size_t SpaceCopy::bytes() const noexcept {
  const auto of = []<class T>(const T& part) -> std::size_t {
    if constexpr (requires { part.bytes(); })
      return part.bytes();
    else if constexpr (requires { part.data(); })
      return part.size() * sizeof part[0];
    else
      return 0;
  };
  std::size_t all = sizeof *this + memory_.bytes() + of(groups_) + of(blocks_);
  std::apply([&](const auto&... part) { all += (of(part) + ...); }, parts_);
  for (const Block& block : blocks_) {
    for (const auto& port : block.ports) all += port.size();
    for (const auto& column : block.columns) all += column.size();
  }
  return all;
}

SpaceCopy::~SpaceCopy() {
  for (const Block& block : blocks_) {
    for (std::size_t slot = 0; slot < block.copied; ++slot) {
      if (block.was.constructed[slot] != 0) type_of(block).destroy(block.controller(slot));
    }
  }
}

hal::Status SpaceCopy::put_back_block(std::size_t b, Space& space) const {
  const Block& from = blocks_[b];
  RobotBlock& to = space.stores().blocks.emplace_back(from.was);
  to.constructed.fill(0);
  for (std::size_t p = 0; p < from.ports.size(); ++p)
    std::copy(from.ports[p].begin(), from.ports[p].end(), to.ports[p]);
  const std::vector<KeptColumn>& columns = groups_[from.was.group].columns;
  for (std::size_t c = 0; c < from.columns.size(); ++c)
    std::copy(from.columns[c].begin(), from.columns[c].end(), columns[c].arrays->array(b));
  hal::Status all;
  for (std::size_t slot = 0; slot < from.copied; ++slot) {
    if (from.was.constructed[slot] == 0) continue;
    const std::string why = copied(type_of(from), to.controller(slot), from.controller(slot));
    if (why.empty()) {
      to.constructed[slot] = 1;
      continue;
    }
    to.halted[slot] = bit(HaltOwner::Controller);
    all = hal::Error{"copying the controller of " + name_of(space, to.first_row + slot) + " back threw: " + why};
  }
  return all;
}

hal::Status SpaceCopy::put_back(Space& space, RobotDevices& devices) const {
  SpaceStores& s = space.stores();
  destroy_controllers(s);
  s.blocks.clear();
  s.groups = groups_;
  devices = devices_;
  for (const auto& column : s.columns.all()) column->of_block.clear();  // also those that came since
  for (const auto& [column, arrays] : column_arrays_) column->of_block = arrays;
  parts_of(s) = parts_;
  for (std::size_t i = 0; i < fields_.size(); ++i) s.fields.all()[i].field->put_back(fields_[i]);
  note_other_state(s);
  hal::Status all;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    if (const hal::Status one = put_back_block(b, space); !one.ok()) all = one;
  }
  return all;
}

}  // namespace tandem::core
