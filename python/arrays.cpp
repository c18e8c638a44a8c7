#include "python/arrays.hpp"

#include <algorithm>
#include <pybind11/stl.h>

#include "core/space/stores.hpp"
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

py::array array_of(const std::shared_ptr<Session>& session, const hal::RowType& type, const hal::Field& field,
                   std::byte* first, std::size_t rows, bool writable) {
  std::vector<py::ssize_t> shape, strides;
  if (rows > 0) {
    shape.push_back(static_cast<py::ssize_t>(rows));
    strides.push_back(static_cast<py::ssize_t>(type.size));
  }
  if (field.count > 1 || rows == 0) {
    shape.push_back(static_cast<py::ssize_t>(field.count));
    strides.push_back(static_cast<py::ssize_t>(hal::size_of(field.scalar)));
  }
  auto* const held = new std::shared_ptr<Session>(session);
  const py::capsule base(held, [](void* p) { delete static_cast<std::shared_ptr<Session>*>(p); });
  py::array made(dtype_of(field.scalar), std::move(shape), std::move(strides), first + field.offset, base);
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

py::array PortArrays::get(const std::string& name) {
  const auto made = arrays_.find(name);
  if (made != arrays_.end()) return made->second;
  const hal::Field* const field = type_->field(name);
  if (field == nullptr) no_field(*type_, name);
  const bool writable = type_->role == hal::Role::Actuator;
  if (writable) session_->writes = true;
  py::array array = array_of(session_, *type_, *field, first_, rows_, writable);
  arrays_.emplace(name, array);
  return array;
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

// --- swarms ---

std::vector<std::shared_ptr<Swarm>> Swarm::all(const std::shared_ptr<Session>& session) {
  const core::SpaceStores& s = session->world->space().stores();
  std::vector<std::shared_ptr<Swarm>> swarms;
  for (std::size_t g = 0; g < s.groups.size(); ++g) {
    const core::RobotGroup& group = s.groups[g];
    std::shared_ptr<Swarm> last;
    const core::RobotBlock* before = nullptr;
    for (const std::size_t b : group.blocks) {
      const core::RobotBlock& block = s.blocks[b];
      if (block.used == 0) continue;
      bool joins = before != nullptr && last->first_block_ + last->blocks_ == b && before->used == before->capacity &&
                   before->first_row + before->used == block.first_row && block.own_arrays.empty();
      for (std::size_t p = 0; joins && p < group.ports.size(); ++p)
        joins = block.ports[p] == before->ports[p] + before->used * group.ports[p]->size;
      if (!joins) {
        last = std::make_shared<Swarm>();
        last->session_ = session;
        last->group_ = g;
        last->first_block_ = b;
        last->first_row_ = block.first_row;
        last->mark_ = block.controllers;
        last->kind_ = group.kind->name;
        last->controller_ = session->world->scenario().controllers[group.config].id;
        for (std::size_t p = 0; p < group.ports.size(); ++p) last->ports_.emplace_back(group.ports[p], block.ports[p]);
        swarms.push_back(last);
      }
      last->kept_.insert(last->kept_.end(), block.own_arrays.begin(), block.own_arrays.end());
      ++last->blocks_;
      last->rows_ += block.used;
      before = &block;
    }
  }
  return swarms;
}

const core::SpaceStores& Swarm::stores() const {
  if (session_->owner == nullptr) throw std::runtime_error("the world of this swarm was closed");
  const core::SpaceStores& s = session_->world->space().stores();
  if (first_block_ + blocks_ > s.blocks.size() || s.blocks[first_block_].controllers != mark_)
    throw std::runtime_error("the robots of this swarm are gone; ask the world for its swarms again");
  return s;
}

template <class Visit>
void Swarm::each(Visit&& visit) const {
  const core::SpaceStores& s = stores();
  std::size_t i = 0;
  for (std::size_t b = first_block_; b < first_block_ + blocks_; ++b) {
    for (std::size_t slot = 0; slot < s.blocks[b].used && i < rows_; ++slot, ++i)
      visit(s, i, s.blocks[b], slot, s.blocks[b].first_row + slot);
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
  const auto key = std::make_pair(name, static_cast<int>(role));
  if (const auto made = made_.find(key); made != made_.end()) return made->second;
  stores();
  for (const auto& [type, at] : ports_) {
    if (type->name != name || type->role != role) continue;
    auto* session = new std::pair<std::shared_ptr<Session>, std::vector<std::shared_ptr<std::byte>>>(session_, kept_);
    const std::shared_ptr<Session> held(session->first.get(), [session](Session*) { delete session; });
    return made_.emplace(key, std::make_shared<PortArrays>(held, *type, at, rows_)).first->second;
  }
  const std::vector<std::string> known = ports(role);
  const std::string what = role == hal::Role::Sensor ? "sensor" : "actuator";
  throw py::key_error("the controllers of '" + controller_ + "' took no " + what + " '" + name + "'; they took: " +
                      (known.empty() ? "none" : hal::listed(known)) + hal::did_you_mean(name, known));
}

std::vector<std::string> Swarm::ids() const {
  std::vector<std::string> names(rows_);
  each([&](const core::SpaceStores& s, std::size_t i, const core::RobotBlock&, std::size_t, std::size_t row) {
    const std::uint32_t entity = s.bodies.entity[row];
    names[i] = session_->world->space().robot_name({entity, s.robots[entity].generation});
  });
  return names;
}

py::array Swarm::order() const {
  py::array_t<std::int64_t> made(static_cast<py::ssize_t>(rows_));
  std::vector<std::pair<std::uint32_t, std::int64_t>> robots(rows_);
  each([&](const core::SpaceStores& s, std::size_t i, const core::RobotBlock&, std::size_t, std::size_t row) {
    robots[i] = {s.bodies.entity[row], static_cast<std::int64_t>(i)};
  });
  std::sort(robots.begin(), robots.end());
  for (std::size_t i = 0; i < rows_; ++i) made.mutable_data()[i] = robots[i].second;
  return made;
}

py::array Swarm::alive() const {
  py::array_t<bool> made(static_cast<py::ssize_t>(rows_));
  each([&](const core::SpaceStores& s, std::size_t i, const core::RobotBlock&, std::size_t, std::size_t row) {
    made.mutable_data()[i] = (s.bodies.flags[row] & core::kAlive) != 0;
  });
  return made;
}

py::array Swarm::poses() const {
  py::array_t<double> made({static_cast<py::ssize_t>(rows_), py::ssize_t{3}});
  double* at = made.mutable_data();
  each([&](const core::SpaceStores& s, std::size_t, const core::RobotBlock&, std::size_t, std::size_t row) {
    *at++ = s.bodies.x_m[row];
    *at++ = s.bodies.y_m[row];
    *at++ = std::atan2(s.bodies.sin_h[row], s.bodies.cos_h[row]);
  });
  return made;
}

py::array Swarm::published(const std::string& name) const {
  const core::RobotGroup& group = stores().groups[group_];
  for (const hal::PublishedField& field : group.published) {
    if (field.name != name) continue;
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows_)};
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
  return "<tandem.Swarm of " + std::to_string(rows_) + " " + kind_ + " under '" + controller_ + "'>";
}

void bind_arrays(py::module_& m) {
  py::class_<PortArrays, std::shared_ptr<PortArrays>>(
      m, "PortArrays",
      "One port of all robots of a swarm: each field is an array over the robots, without a copy.\n\n"
      "Row i is the robot swarm.ids[i]. Sensors are read-only; what is written into an actuator is the command of the "
      "next step, limited to what the robot can do. The arrays stay the same for the whole life of the world.")
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
                                            "are in the order of memory, which is that "
                                            "of places at the start; `array[swarm.order]` is in the order of the file.")
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
      .def_property_readonly("order", &Swarm::order, "Rows in the order of the experiment file.")
      .def_property_readonly("alive", &Swarm::alive, "Whether the robot of each row is still there.")
      .def_property_readonly("poses", &Swarm::poses, "x and y in m and heading in rad, by row; a copy.")
      .def("published", &Swarm::published, py::arg("name"), "What each controller shows under that name; a copy.")
      .def_property_readonly("published_names", &Swarm::published_names, "Names of what the controllers show.");
}

}  // namespace tandem::python
