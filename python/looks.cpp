// What Python sees of a world, and changes in it, between ticks.
#include <cmath>
#include <pybind11/stl.h>
#include <utility>

#include "core/config/reader.hpp"
#include "core/hook/hook.hpp"
#include "python/picture.hpp"
#include "python/world.hpp"

namespace tandem::python {
namespace {

/// A method of the class for a function of the world behind it, which is marked as used meanwhile.
template <class Result, class... Arguments>
auto look(Result (*function)(core::World&, Arguments...)) {
  return [function](World& world, Arguments... arguments) -> Result {
    const Use use(world);
    return function(*world.session()->world, std::forward<Arguments>(arguments)...);
  };
}
template <class Result, class... Arguments>
auto look(Result (*function)(const std::shared_ptr<Session>&, Arguments...)) {
  return [function](World& world, Arguments... arguments) -> Result {
    const Use use(world);
    return function(world.session(), std::forward<Arguments>(arguments)...);
  };
}

core::RobotId robot_of(const core::World& world, const std::string& id) {
  const core::RobotId robot = world.space().find_robot(id);
  if (!world.space().contains(robot)) throw py::key_error("there is no robot '" + id + "'");
  return robot;
}

/// Of a pose, or of an object.
template <class Placed>
void place(Placed& thing, double x_m, double y_m, double heading_rad) {
  thing.x_m = x_m;
  thing.y_m = y_m;
  thing.cos_h = std::cos(heading_rad);
  thing.sin_h = std::sin(heading_rad);
}

void expect(const hal::Status& done) {
  if (!done.ok()) throw py::value_error(done.error().message);
}

std::vector<std::string> ids(core::World& world) {
  const core::Space& space = world.space();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < space.robot_count(); ++i) names.push_back(space.robot_name(space.robot(i)));
  return names;
}

py::array poses(core::World& world) {
  const core::Space& space = world.space();
  py::array_t<double> made({static_cast<py::ssize_t>(space.robot_count()), py::ssize_t{3}});
  double* at = made.mutable_data();
  for (std::size_t i = 0; i < space.robot_count(); ++i) {
    const core::Pose pose = space.pose(space.robot(i));
    *at++ = pose.x_m;
    *at++ = pose.y_m;
    *at++ = pose.heading_rad();
  }
  return made;
}

py::tuple pose(core::World& world, const std::string& robot) {
  const core::Pose pose = world.space().pose(robot_of(world, robot));
  return py::make_tuple(pose.x_m, pose.y_m, pose.heading_rad());
}

void set_pose(core::World& world, const std::string& robot, double x_m, double y_m, double heading_rad) {
  if (!std::isfinite(x_m) || !std::isfinite(y_m) || !std::isfinite(heading_rad))
    throw py::value_error("a pose is three finite numbers");
  const core::RobotId id = robot_of(world, robot);
  core::Pose pose = world.space().pose(id);
  place(pose, x_m, y_m, heading_rad);
  expect(world.space().room_for(id, pose));
  world.space().set_pose(id, pose);
}

/// `change` of the robots: with commands that Python wrote, and seen by its arrays.
template <class Change>
void change_robots(const std::shared_ptr<Session>& session, Change&& change) {
  session->write_arrays();
  change(*session->world);
  session->read_arrays();
}

void add_robot(const std::shared_ptr<Session>& session, const std::string& id, const std::string& controller,
               double x_m, double y_m, double heading_rad, const std::string& kind) {
  core::NewRobot wanted;
  wanted.kind = kind;
  wanted.id = id;
  wanted.controller = controller;
  place(wanted.pose, x_m, y_m, heading_rad);
  change_robots(session, [&](core::World& world) {
    const auto added = world.space().add_robot(wanted);
    if (!added.ok()) throw py::value_error(added.error().message);
  });
}

void remove_robot(const std::shared_ptr<Session>& session, const std::string& id) {
  change_robots(session, [&](core::World& world) { world.space().remove_robot(robot_of(world, id)); });
}

void move_object(core::World& world, const std::string& object, double x_m, double y_m, double heading_rad) {
  const core::ObjectId id = world.space().find_object(object);
  if (!world.space().contains(id)) throw py::key_error("there is no object '" + object + "'");
  core::Object changed = world.space().objects()[id.index];
  place(changed, x_m, y_m, heading_rad);
  expect(world.space().set_object(id, changed));
}

py::dict objects(core::World& world) {
  py::dict all;
  for (const core::Object& object : world.space().objects()) {
    if (!object.alive) continue;
    all[py::str(object.id)] = py::make_tuple(object.x_m, object.y_m, std::atan2(object.sin_h, object.cos_h));
  }
  return all;
}

py::dict measures(core::World& world) {
  py::dict all;
  for (const auto& [name, value] : world.measures().all()) all[py::str(name)] = value;
  return all;
}

void set_measure(const std::shared_ptr<Session>& session, const std::string& name, double value) {
  if (session->hook_context == nullptr) throw std::runtime_error("measures are set by hooks, while these are called");
  session->hook_context->measures.set(name, value);
}

py::dict incidents(core::World& world) {
  const core::Incidents& all = world.incidents();
  py::dict made;
  made["commands_clamped"] = all.commands_clamped;
  made["commands_not_finite"] = all.commands_not_finite;
  made["controllers_thrown"] = all.controllers_thrown;
  made["bodies_escaped"] = all.bodies_escaped;
  made["first"] = all.first();
  return made;
}

Picture picture(const std::shared_ptr<Session>& session, int size_px, bool ids, bool axes) {
  session->write_arrays();  // lamps
  const core::World& world = *session->world;
  core::PictureOptions options;
  options.experiment = world.scenario().name;
  options.seed = world.seed();
  options.time_ns = hal::time_of_tick(world.tick(), world.ticks_per_second());
  options.ticks_done = world.tick();
  return picture_of(world.space(), std::move(options), size_px, ids, axes);
}

std::string text(World& world) {
  if (world.closed()) return "<tandem.World, closed>";
  const Use use(world);
  const core::World& w = *world.session()->world;
  return "<tandem.World '" + w.scenario().name + "' of " + std::to_string(w.space().robot_count()) + " robots, tick " +
         std::to_string(w.tick()) + ", seed " + std::to_string(w.seed()) + ">";
}

double length_s(World& world) {
  const Use use(world);
  return world.length_s();
}

using W = core::World;

}  // namespace

void bind_looks(WorldClass& world) {
  const auto seconds = [](W& w) { return static_cast<double>(w.tick()) / static_cast<double>(w.ticks_per_second()); };
  world.def_property_readonly("swarms", look(&Swarm::all), "All robots, by kind and controller.")
      .def_property_readonly("ids", look(&ids), "Ids of all robots, in the order of the file.")
      .def_property_readonly("poses", look(&poses),
                             "x and y in m and heading in rad of all robots, in the order of ids; a copy.")
      .def("pose", look(&pose), py::arg("robot"), "(x, y, heading) of a robot, in m and rad.")
      .def("set_pose", look(&set_pose), py::arg("robot"), py::arg("x"), py::arg("y"), py::arg("heading") = 0.0,
           "Puts a robot somewhere else; an error where there is no room.")
      .def("add_robot", look(&add_robot), py::arg("id"), py::arg("controller"), py::arg("x"), py::arg("y"),
           py::arg("heading") = 0.0, py::arg("kind") = "",
           "Adds a robot under a configuration of the file. kind: where absent, that of the first robot there.")
      .def("remove_robot", look(&remove_robot), py::arg("robot"), "Takes a robot out; its row stays, not alive.")
      .def("move_object", look(&move_object), py::arg("object"), py::arg("x"), py::arg("y"), py::arg("heading") = 0.0,
           "Puts a box or a cylinder somewhere else.")
      .def_property_readonly("objects", look(&objects), "(x, y, heading) of every box and cylinder, by id.")
      .def_property_readonly("measures", look(&measures), "What hooks measure, by name.")
      .def("set_measure", look(&set_measure), py::arg("name"), py::arg("value"), "For hooks: publishes a number.")
      .def_property_readonly("incidents", look(&incidents),
                             "What went wrong with commands, controllers and bodies so far.")
      .def_property_readonly("messages", look(+[](const std::shared_ptr<Session>& s) { return s->messages(); }),
                             "(severity, text) of what the world and its controllers told.")
      .def_property_readonly("tick", look(+[](W& w) { return w.tick(); }), "Ticks done.")
      .def_property_readonly("time", look(+seconds), "Time of the run in s.")
      .def_property_readonly("ticks_per_second", look(+[](W& w) { return w.ticks_per_second(); }))
      .def_property_readonly("seed", look(+[](W& w) { return w.seed(); }))
      .def_property_readonly("fingerprint", look(+[](const std::shared_ptr<Session>& s) {
                               s->write_arrays();
                               return s->world->state_hash();
                             }),
                             "A number that is equal for equal states.")
      .def_property_readonly("settings", look(+[](W& w) { return core::effective_settings(w.scenario()); }),
                             "The experiment as XML, with every default written out.")
      .def_property_readonly("name", look(+[](W& w) { return w.scenario().name; }))
      .def_property_readonly("length", &length_s, "Length of the run in s; 0: it has none.")
      .def("floor", look(+[](W& w, double x_m, double y_m) { return w.space().floor(x_m, y_m); }), py::arg("x"),
           py::arg("y"), "Reflectance of the floor, 0 black to 1 white.")
      .def("picture", look(&picture), py::arg("size") = 600, py::arg("ids") = false, py::arg("axes") = false,
           "The world from above, as notebooks show it.")
      .def("__repr__", &text);
}

}  // namespace tandem::python
