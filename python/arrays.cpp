#include "python/arrays.hpp"

#include <algorithm>
#include <cstring>
#include <pybind11/stl.h>

#include "core/space/stores.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/buttons.hpp"
#include "hal/device/cliff.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/element.hpp"

namespace tandem::python {

py::dtype dtype_of(hal::Scalar scalar) {
  switch (scalar) {
    case hal::Scalar::F32:
      return py::dtype::of<float>();
    case hal::Scalar::F64:
      return py::dtype::of<double>();
    case hal::Scalar::U8:
      return py::dtype::of<std::uint8_t>();
    case hal::Scalar::U16:
      return py::dtype::of<std::uint16_t>();
    case hal::Scalar::U32:
      return py::dtype::of<std::uint32_t>();
    case hal::Scalar::I32:
      return py::dtype::of<std::int32_t>();
    case hal::Scalar::I64:
      return py::dtype::of<std::int64_t>();
    case hal::Scalar::Bool:
      return py::dtype::of<bool>();
  }
  return py::dtype::of<double>();
}

namespace {

template <class Part>
std::size_t entries_by(const hal::RobotKind& kind) {
  const Part* const part = kind.part<Part>();
  if (part == nullptr) return 0;
  if constexpr (requires { part->mounts; })
    return part->mounts.size();
  else
    return static_cast<std::size_t>(part->count);
}

/// The part that says how long a port is, which bears its name.
struct Measured {
  std::size_t capacity;
  std::size_t (*entries)(const hal::RobotKind& kind);
};

const std::map<std::string_view, Measured>& measured_ports() {
  using namespace hal;
  static const std::map<std::string_view, Measured> all = {
      {Proximity::kName, {Proximity::kCapacity, &entries_by<ProximityPart>}},
      {Light::kName, {Light::kCapacity, &entries_by<LightPart>}},
      {Ground::kName, {Ground::kCapacity, &entries_by<GroundPart>}},
      {BaseGround::kName, {BaseGround::kCapacity, &entries_by<BaseGroundPart>}},
      {MotorGround::kName, {MotorGround::kCapacity, &entries_by<MotorGroundPart>}},
      {Cliff::kName, {Cliff::kCapacity, &entries_by<CliffPart>}},
      {Microphones::kName, {Microphones::kCapacity, &entries_by<MicrophonesPart>}},
      {Buttons::kName, {Buttons::kCapacity, &entries_by<ButtonsPart>}},
      {RingLeds::kName, {RingLeds::kCapacity, &entries_by<LedsPart>}},
      {UpperRingLeds::kName, {UpperRingLeds::kCapacity, &entries_by<UpperLedsPart>}}};
  return all;
}

}  // namespace

DeviceLength::DeviceLength(const hal::PortType& type, const hal::RobotKind& kind) {
  const auto found = measured_ports().find(type.name);
  if (found == measured_ports().end()) return;
  entries = found->second.entries(kind);
  capacity = found->second.capacity;
}

py::array array_of(const std::shared_ptr<Session>& session, const hal::Field& field, std::byte* port, std::size_t count,
                   bool writable) {
  auto* const held = new std::shared_ptr<Session>(session);
  const py::capsule base(held, [](void* p) { delete static_cast<std::shared_ptr<Session>*>(p); });
  py::array made(dtype_of(field.scalar), std::vector<py::ssize_t>{static_cast<py::ssize_t>(count)},
                 std::vector<py::ssize_t>{static_cast<py::ssize_t>(hal::size_of(field.scalar))}, port + field.offset,
                 base);
  if (!writable) made.attr("flags").attr("writeable") = false;
  return made;
}

void no_field(const hal::RowType& type, const std::string& name) {
  std::vector<std::string> known;
  for (const hal::Field& field : type.fields) known.emplace_back(field.name);
  throw py::attribute_error("there is no field '" + name + "' in '" + std::string(type.name) +
                            "'; it has: " + hal::listed(known) + hal::did_you_mean(name, known));
}

void assign(const py::array& array, const hal::RowType& type, const hal::Field& field, const py::object& value) {
  const std::string name = "'" + std::string(type.name) + "." + std::string(field.name) + "'";
  py::array given = py::array::ensure(value);
  if (!given || std::string_view("biuf").find(given.dtype().kind()) == std::string_view::npos) {
    throw py::type_error(name + " takes numbers (" + py::cast<std::string>(py::str(array.dtype())) + "), and this is " +
                         (given && py::isinstance<py::array>(value)
                              ? "an array of " + py::cast<std::string>(py::str(given.dtype()))
                              : "of type " + py::cast<std::string>(py::type::of(value).attr("__name__"))));
  }
  const char kind = array.dtype().kind();
  if (kind != 'f' && given.dtype().kind() != 'b') {
    const py::object whole = given.attr("astype")(array.dtype());
    if (!py::cast<bool>(whole.attr("__eq__")(given).attr("all")())) {
      throw py::value_error(name + " takes " + (kind == 'b' ? "true or false" : "whole numbers") + " (" +
                            py::cast<std::string>(py::str(array.dtype())) + "), and some of these are others");
    }
    given = py::reinterpret_borrow<py::array>(whole);
  }
  try {
    array[py::ellipsis()] = given;
  } catch (const py::error_already_set& e) {
    if (!e.matches(PyExc_ValueError)) throw;
    throw py::value_error(name + " is an array of shape " + py::cast<std::string>(py::str(array.attr("shape"))) +
                          ", and what is written has the shape " + py::cast<std::string>(py::str(given.attr("shape"))));
  }
}

// --- ports ---

void PortArrays::copy(const Copy& field, Way way) const noexcept {
  const std::vector<std::uint32_t>& place = rows_->place;
  const auto each = [&](auto bytes) {
    for (std::size_t row = 0; row < place.size(); ++row) {
      std::byte* const here = field.data + place[row] * bytes;
      std::byte* const there = first_ + row * type_->size + field.offset;
      std::memcpy(way == Way::FromWorld ? here : there, way == Way::FromWorld ? there : here, bytes);
    }
  };
  switch (field.bytes) {  // of known lengths, compilers copy without a call
    case 1:
      return each(std::integral_constant<std::size_t, 1>());
    case 4:
      return each(std::integral_constant<std::size_t, 4>());
    case 8:
      return each(std::integral_constant<std::size_t, 8>());
    case 32:
      return each(std::integral_constant<std::size_t, 32>());
    default:
      return each(field.bytes);
  }
}

void PortArrays::read() noexcept {
  for (const auto& [name, field] : fields_) copy(field, Way::FromWorld);
}

void PortArrays::write() noexcept {
  if (type_->role != hal::Role::Actuator) return;
  for (const auto& [name, field] : fields_) copy(field, Way::ToWorld);
}

py::array PortArrays::get(const std::string& name) {
  if (const auto made = fields_.find(name); made != fields_.end()) return made->second.array;
  const hal::Field* const field = type_->field(name);
  if (field == nullptr) no_field(*type_, name);
  const auto session = session_.lock();
  if (session == nullptr || session->owner == nullptr) throw std::runtime_error("the world of this swarm was closed");
  const bool writable = type_->role == hal::Role::Actuator;
  const std::size_t count = length_.scalars(*field);
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows())};
  if (field->count > 1) shape.push_back(static_cast<py::ssize_t>(count));
  Copy made{py::array(dtype_of(field->scalar), shape), nullptr, field->offset, count * hal::size_of(field->scalar)};
  made.data = static_cast<std::byte*>(made.array.mutable_data());
  if (!writable) made.array.attr("flags").attr("writeable") = false;
  copy(made, Way::FromWorld);
  const std::lock_guard hold(session->arrays_lock);
  session->writes = session->writes || writable;
  return fields_.emplace(name, std::move(made)).first->second.array;
}

void PortArrays::set(const std::string& name, const py::object& value) {
  if (type_->role == hal::Role::Sensor && type_->field(name) != nullptr)
    throw py::attribute_error("'" + std::string(type_->name) + "' is a sensor: its readings cannot be set");
  assign(get(name), *type_, *type_->field(name), value);
}

std::vector<std::string> PortArrays::names() const {
  std::vector<std::string> names;
  for (const hal::Field& field : type_->fields) names.emplace_back(field.name);
  return names;
}

void Session::read_arrays() noexcept {
  const std::lock_guard hold(arrays_lock);
  for (const auto& [key, port] : arrays) port->read();
}

void Session::write_arrays() noexcept {
  const std::lock_guard hold(arrays_lock);
  for (const auto& [key, port] : arrays) port->write();
}

// --- swarms ---

std::vector<std::shared_ptr<Swarm>> Swarm::all(const std::shared_ptr<Session>& session) {
  const core::SpaceStores& s = session->world->space().stores();
  std::vector<std::shared_ptr<Swarm>> swarms;
  for (std::size_t g = 0; g < s.groups.size(); ++g) {
    const core::RobotGroup& group = s.groups[g];
    std::shared_ptr<Swarm> last;
    std::size_t used = 0;
    const core::RobotBlock* before = nullptr;
    for (const std::size_t b : group.blocks) {
      const core::RobotBlock& block = s.blocks[b];
      if (block.used == 0) continue;
      bool joins = before != nullptr && last->first_block_ + last->blocks_ == b && before->used == before->capacity &&
                   before->first_row + before->used == block.first_row && block.own_arrays.empty();
      for (std::size_t p = 0; joins && p < group.ports.size(); ++p)
        joins = block.ports[p] == before->ports[p] + before->used * group.ports[p]->size;
      if (!joins) {
        if (last != nullptr) last->find_rows(used);
        used = 0;
        last = std::make_shared<Swarm>();
        last->session_ = session;
        last->group_ = g;
        last->first_block_ = b;
        last->kind_ = group.kind->name;
        last->controller_ = session->world->scenario().controllers[group.config].id;
        for (std::size_t p = 0; p < group.ports.size(); ++p) last->ports_.emplace_back(group.ports[p], block.ports[p]);
        swarms.push_back(last);
      }
      last->kept_.insert(last->kept_.end(), block.own_arrays.begin(), block.own_arrays.end());
      ++last->blocks_;
      used += block.used;
      before = &block;
    }
    if (last != nullptr) last->find_rows(used);
  }
  return swarms;
}

/// Those that the session knows; others where robots have come or gone.
void Swarm::find_rows(std::size_t used) {
  std::byte* const mark = session_->world->space().stores().blocks[first_block_].controllers;
  std::shared_ptr<SwarmRows>& known = session_->rows[first_block_];
  const bool same = known != nullptr && known->mark == mark && known->place.size() <= used;
  if (!same || known->place.size() < used) {
    auto rows = std::make_shared<SwarmRows>(SwarmRows{mark, same ? known->place : file_order(used)});
    while (rows->place.size() < used) rows->place.push_back(static_cast<std::uint32_t>(rows->place.size()));
    known = std::move(rows);
  }
  rows_ = known;
}

std::vector<std::uint32_t> Swarm::file_order(std::size_t used) const {
  const core::SpaceStores& s = session_->world->space().stores();
  const std::size_t first = s.blocks[first_block_].first_row;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> robots;
  for (std::uint32_t row = 0; row < used; ++row) robots.emplace_back(s.bodies.entity[first + row], row);
  std::sort(robots.begin(), robots.end());
  std::vector<std::uint32_t> place(used);
  for (std::uint32_t i = 0; i < used; ++i) place[robots[i].second] = i;
  return place;
}

void Swarm::renew(const std::shared_ptr<Session>& session, bool anew) {
  const auto swarms = all(session);
  std::map<std::size_t, std::shared_ptr<SwarmRows>> there;
  for (const auto& swarm : swarms) {
    if (anew) swarm->rows_->place = swarm->file_order(swarm->size());
    there.emplace(swarm->first_block_, swarm->rows_);
  }
  const std::lock_guard hold(session->arrays_lock);
  session->rows = std::move(there);
  std::erase_if(session->arrays, [&](const auto& entry) {
    const auto found = session->rows.find(entry.first.first);
    return found == session->rows.end() || found->second.get() != entry.second->swarm();
  });
}

const core::SpaceStores& Swarm::stores() const {
  if (session_->owner == nullptr) throw std::runtime_error("the world of this swarm was closed");
  const core::SpaceStores& s = session_->world->space().stores();
  if (first_block_ + blocks_ > s.blocks.size() || s.blocks[first_block_].controllers != rows_->mark)
    throw std::runtime_error("the robots of this swarm are gone; ask the world for its swarms again");
  return s;
}

template <class Visit>
void Swarm::each(Visit&& visit) const {
  const core::SpaceStores& s = stores();
  std::size_t row = 0;
  for (std::size_t b = first_block_; b < first_block_ + blocks_; ++b) {
    for (std::size_t slot = 0; slot < s.blocks[b].used && row < size(); ++slot, ++row)
      visit(s, std::size_t{rows_->place[row]}, s.blocks[b], slot, s.blocks[b].first_row + slot);
  }
}

std::vector<std::string> Swarm::ports(hal::Role role) const {
  std::vector<std::string> names;
  for (const auto& [type, at] : ports_) {
    if (type->role == role) names.emplace_back(type->name);
  }
  return names;
}

std::shared_ptr<PortArrays> Swarm::port(const std::string& name, hal::Role role) {
  const core::SpaceStores& s = stores();
  for (const auto& [type, at] : ports_) {
    if (type->name != name || type->role != role) continue;
    const std::lock_guard hold(session_->arrays_lock);
    std::shared_ptr<PortArrays>& made = session_->arrays[{first_block_, type}];
    if (made == nullptr || made->swarm() != rows_.get())
      made = std::make_shared<PortArrays>(session_, *type, *s.groups[group_].kind, at, rows_, kept_);
    return made;
  }
  const std::vector<std::string> known = ports(role);
  const std::string what = role == hal::Role::Sensor ? "sensor" : "actuator";
  throw py::key_error("the controllers of '" + controller_ + "' took no " + what + " '" + name + "'; they took: " +
                      (known.empty() ? "none" : hal::listed(known)) + hal::did_you_mean(name, known));
}

std::vector<std::string> Swarm::ids() const {
  std::vector<std::string> names(size());
  each([&](const core::SpaceStores& s, std::size_t i, const core::RobotBlock&, std::size_t, std::size_t row) {
    const std::uint32_t entity = s.bodies.entity[row];
    names[i] = session_->world->space().robot_name({entity, s.robots[entity].generation});
  });
  return names;
}

py::array Swarm::alive() const {
  py::array_t<bool> made(static_cast<py::ssize_t>(size()));
  each([&](const core::SpaceStores& s, std::size_t i, const core::RobotBlock&, std::size_t, std::size_t row) {
    made.mutable_data()[i] = (s.bodies.flags[row] & core::kAlive) != 0;
  });
  return made;
}

py::array Swarm::poses() const {
  py::array_t<double> made({static_cast<py::ssize_t>(size()), py::ssize_t{3}});
  double* const all = made.mutable_data();
  each([&](const core::SpaceStores& s, std::size_t i, const core::RobotBlock&, std::size_t, std::size_t row) {
    double* at = all + 3 * i;
    *at++ = s.bodies.x_m[row];
    *at++ = s.bodies.y_m[row];
    *at = std::atan2(s.bodies.sin_h[row], s.bodies.cos_h[row]);
  });
  return made;
}

py::array Swarm::published(const std::string& name) const {
  const core::RobotGroup& group = stores().groups[group_];
  for (const hal::PublishedField& field : group.published) {
    if (field.name != name) continue;
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(size())};
    if (field.count > 1) shape.push_back(static_cast<py::ssize_t>(field.count));
    py::array_t<double> made(shape);
    double* const values = made.mutable_data();
    each([&](const core::SpaceStores&, std::size_t i, const core::RobotBlock& block, std::size_t slot, std::size_t) {
      for (std::size_t k = 0; k < field.count; ++k)
        values[i * field.count + k] =
            block.constructed[slot] != 0 ? hal::value_of(field, block.controller(slot), k) : 0.0;
    });
    return made;
  }
  const std::vector<std::string> known = published_names();
  throw py::key_error("the controllers of '" + controller_ + "' publish no '" + name + "'; they publish: " +
                      (known.empty() ? "nothing" : hal::listed(known)) + hal::did_you_mean(name, known));
}

std::vector<std::string> Swarm::published_names() const {
  std::vector<std::string> names;
  for (const hal::PublishedField& field : stores().groups[group_].published) names.push_back(field.name);
  return names;
}

std::string Swarm::text() const {
  return "<tandem.Swarm of " + std::to_string(size()) + " " + kind_ + " under '" + controller_ + "'>";
}

void bind_arrays(py::module_& m) {
  py::class_<PortArrays, std::shared_ptr<PortArrays>>(
      m, "PortArrays",
      "One port of all robots of a swarm: each field is an array over the robots, as wide as their device.\n\n"
      "Row i is the robot swarm.ids[i]. Arrays follow the world: they are the same objects after each step. Those of "
      "sensors are read-only; what is written into those of an actuator is the command of the next step, limited to "
      "what the robot can do.")
      .def("__getattr__", &PortArrays::get, py::arg("name"))
      .def("__setattr__", &PortArrays::set, py::arg("name"), py::arg("value"))
      .def("__getitem__", &PortArrays::get, py::arg("name"))
      .def("__dir__", &PortArrays::names)
      .def("__len__", &PortArrays::rows)
      .def("__repr__", [](const PortArrays& p) {
        return "<tandem.PortArrays '" + std::string(p.type().name) + "' of " + std::to_string(p.rows()) + " robots>";
      });
  py::class_<Swarm, std::shared_ptr<Swarm>>(m, "Swarm",
                                            "Robots of one kind under one configuration of a controller, as arrays.\n\n"
                                            "Row i of every array is the robot ids[i], until the world is reset. Rows "
                                            "are in the order of the file.")
      .def("__len__", &Swarm::size)
      .def("__repr__", &Swarm::text)
      .def_property_readonly("kind", &Swarm::kind, "Kind of robot, such as 'e-puck'.")
      .def_property_readonly("controller", &Swarm::controller, "Id of the controller's configuration.")
      .def_property_readonly(
          "sensors", [](const Swarm& s) { return s.ports(hal::Role::Sensor); },
          "Names of the sensors that the controllers took.")
      .def_property_readonly(
          "actuators", [](const Swarm& s) { return s.ports(hal::Role::Actuator); },
          "Names of the actuators that the controllers took.")
      .def(
          "sensor", [](Swarm& s, const std::string& name) { return s.port(name, hal::Role::Sensor); }, py::arg("name"),
          "The readings of a sensor: an array for each field.")
      .def(
          "actuator", [](Swarm& s, const std::string& name) { return s.port(name, hal::Role::Actuator); },
          py::arg("name"), "The commands of an actuator: an array for each field, to be written.")
      .def_property_readonly("ids", &Swarm::ids, "Ids of the robots, by row.")
      .def_property_readonly("alive", &Swarm::alive, "Whether the robot of each row is still there.")
      .def_property_readonly("poses", &Swarm::poses, "x and y in m and heading in rad, by row; a copy.")
      .def("published", &Swarm::published, py::arg("name"), "What each controller shows under that name; a copy.")
      .def_property_readonly("published_names", &Swarm::published_names, "Names of what the controllers show.");
}

}  // namespace tandem::python
