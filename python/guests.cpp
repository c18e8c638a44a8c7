#include "python/guests.hpp"

#include <algorithm>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <stdexcept>

#include "app/catalog.hpp"
#include "core/hook/hook.hpp"
#include "hal/controller.hpp"
#include "hal/device_list.hpp"
#include "hal/open_params.hpp"
#include "python/arrays.hpp"
#include "python/world.hpp"

namespace tandem::python {
namespace {

struct Guest {
  std::weak_ptr<Session> session;
  py::object object;
};

/// By key; touched with Python's lock held.
std::map<std::string, Guest>& guests() {
  static auto* const all = new std::map<std::string, Guest>();  // never destroyed: Python may be gone by then
  return *all;
}

Guest& guest_of(const std::string& key) {
  const auto found = guests().find(key);
  if (found == guests().end()) throw std::runtime_error("is a class of Python that was not handed to tandem.World");
  return found->second;
}

/// Calls `call` with Python's lock; what Python raises becomes an exception of ours.
template <class Call>
auto in_python(Call&& call) {
  const py::gil_scoped_acquire lock;
  try {
    return call();
  } catch (const py::error_already_set& e) {
    std::string why = e.what();
    throw std::runtime_error(why);
  } catch (const py::cast_error& e) {
    throw std::runtime_error(std::string("gave something of another type than is expected: ") + e.what());
  }
}

/// An object of Python in places that do not hold its lock.
class Held {
 public:
  Held() = default;
  explicit Held(py::object object) : object_(object.release()) {}
  Held(Held&& other) noexcept : object_(std::exchange(other.object_, {})) {}
  Held& operator=(Held&& other) noexcept {
    std::swap(object_, other.object_);
    return *this;
  }
  ~Held() {
    if (!object_ || Py_IsInitialized() == 0) return;
    const py::gil_scoped_acquire lock;
    object_.dec_ref();
  }
  py::handle get() const noexcept { return object_; }

 private:
  py::handle object_;
};

// --- controllers ---

/// The robot that a controller of Python is made for.
class GuestRobot {
 public:
  GuestRobot(std::weak_ptr<Session> session, hal::Robot& robot)
      : session_(std::move(session)),
        robot_(&robot),
        id_(robot.id()),
        kind_(robot.kind().name),
        seed_(hal::seed_of(robot.run_seed(), robot.id())),
        log_(robot.log()) {}

  void leave() noexcept { robot_ = nullptr; }
  const std::string& id() const noexcept { return id_; }
  const std::string& kind() const noexcept { return kind_; }
  const std::weak_ptr<Session>& session() const noexcept { return session_; }
  hal::Random random(std::uint32_t stream) const { return hal::Random(seed_, stream); }
  void log(const std::string& text) { log_.info(text); }

  std::vector<std::pair<std::string, std::string>> devices() {
    std::vector<std::pair<std::string, std::string>> all;
    for (const hal::ListedDevice& device : list().devices())
      all.emplace_back(device.port->role == hal::Role::Sensor ? "sensor" : "actuator", device.port->name);
    return all;
  }
  std::shared_ptr<Port> port(const std::string& name, hal::Role role) {
    std::vector<std::string> known;
    for (const hal::ListedDevice& device : list().devices()) {
      if (device.port->role != role) continue;
      if (device.port->name == name || device.written == name) {
        auto made = std::make_shared<Port>(session_, list().port(*device.port), *device.port, robot_->kind());
        ports.push_back(made);
        return made;
      }
      known.emplace_back(device.port->name);
    }
    const std::string what = role == hal::Role::Sensor ? "sensor" : "actuator";
    throw py::key_error("the configuration of robot '" + id_ + "' lists no " + what + " '" + name + "'; it lists: " +
                        (known.empty() ? "none" : hal::listed(known)) + hal::did_you_mean(name, known));
  }

  std::vector<std::shared_ptr<Port>> ports;  ///< that it handed out

 private:
  hal::DeviceList& list() {
    if (robot_ == nullptr)
      throw std::runtime_error("devices of robot '" + id_ +
                               "' are taken while its controller is made or reset, not later");
    auto* const devices = dynamic_cast<hal::DeviceList*>(robot_);
    if (devices == nullptr) throw std::runtime_error("this world does not tell which devices a configuration lists");
    return *devices;
  }

  std::weak_ptr<Session> session_;
  hal::Robot* robot_;
  std::string id_, kind_;
  std::uint64_t seed_;
  hal::RobotLog log_;
};

/// A robot under a class of Python.
class PythonController final : public hal::Controller {
 public:
  struct Params {
    std::string key;
    std::vector<hal::NamedText> others;
    void describe(hal::ParamVisitor& v) {
      v.text(kKey, key, "The class, as tandem.World keeps it.");
      hal::describe_others(v, others, "What the class is given, as texts.");
    }
  };

  PythonController(hal::Robot& robot, const Params& params) {
    in_python([&] {
      Guest& guest = guest_of(params.key);
      py::dict given;
      for (const hal::NamedText& one : params.others) given[py::str(one.name)] = py::str(one.value);
      const auto seen = std::make_shared<GuestRobot>(guest.session, robot);
      object_ = Held(guest.object(seen, given));
      robot_ = Held(py::cast(seen));
      seen->leave();
      find_step();
    });
  }
  /// What it remembers is copied deeply; ports, and arrays of them, are shared.
  PythonController(const PythonController& other) : hal::Controller(other) {
    in_python([&] {
      py::dict memo;
      const auto keep = [&](py::handle o) { memo[py::int_(reinterpret_cast<std::uintptr_t>(o.ptr()))] = o; };
      for (const auto& port : other.robot_.get().cast<std::shared_ptr<GuestRobot>>()->ports) {
        keep(py::cast(port));
        for (const auto& [name, array] : port->arrays()) keep(array);
      }
      keep(other.robot_.get());
      object_ = Held(py::module_::import("copy").attr("deepcopy")(other.object_.get(), memo));
      robot_ = Held(py::reinterpret_borrow<py::object>(other.robot_.get()));
      find_step();
    });
  }
  PythonController& operator=(const PythonController&) = delete;

  void step() override {
    in_python([&] { step_locked(); });
  }
  bool reset(hal::Robot& robot) override {
    return in_python([&] {
      if (!py::hasattr(object_.get(), "reset")) return false;
      const auto seen =
          std::make_shared<GuestRobot>(robot_.get().cast<std::shared_ptr<GuestRobot>>()->session(), robot);
      object_.get().attr("reset")(seen);
      robot_ = Held(py::cast(seen));
      seen->leave();
      return true;
    });
  }

  /// Takes Python's lock once for the row.
  static std::size_t step_row(std::byte* first, std::size_t stride, std::size_t begin, std::size_t count,
                              const std::uint8_t* halted, hal::StepFault& fault) {
    std::size_t i = begin;
    const py::gil_scoped_acquire lock;
    try {
      for (; i < count; ++i) {
        if (halted[i] != 0) continue;
        __atomic_store_n(&fault.index, i, __ATOMIC_RELAXED);
        std::launder(reinterpret_cast<PythonController*>(first + i * stride))->step_locked();
      }
      return count;
    } catch (const std::exception& e) {
      fault.message = e.what();
    }
    fault.index = i;
    return i;
  }

 private:
  void find_step() { step_ = Held(py::reinterpret_borrow<py::object>(object_.get()).attr("step")); }
  void step_locked() {
    if (PyObject* const result = PyObject_CallNoArgs(step_.get().ptr()); result != nullptr)
      Py_DECREF(result);
    else
      throw py::error_already_set();
  }

  Held object_, robot_, step_;
};

/// Takes every device that its configuration lists; who has the ports writes the commands.
class Driven final : public hal::Controller {
 public:
  explicit Driven(hal::Robot& robot) {
    auto* const list = dynamic_cast<hal::DeviceList*>(&robot);
    if (list == nullptr)
      throw hal::DeviceError("is in a world that does not tell which devices its configuration lists");
    for (const hal::ListedDevice& device : list->devices()) list->port(*device.port);
  }
  void step() noexcept override {}
  bool reset(hal::Robot& /*robot*/) override { return true; }
};

// --- hooks ---

/// A hook of Python: any object with some of the methods.
class PythonHook final : public core::Hook {
 public:
  struct Params {
    std::string key;
    std::vector<hal::NamedText> others;
    void describe(hal::ParamVisitor& v) {
      v.text(kKey, key, "The hook, as tandem.World keeps it.");
      hal::describe_others(v, others, "Not used.");
    }
  };

  explicit PythonHook(const Params& params) {
    in_python([&] {
      Guest& guest = guest_of(params.key);
      session_ = guest.session;
      py::object object = guest.object;
      if (PyType_Check(object.ptr()) != 0) object = object();
      for (std::size_t i = 0; i < kMethods.size(); ++i) has_[i] = py::hasattr(object, kMethods[i]);
      object_ = Held(std::move(object));
      if (const auto session = session_.lock()) session->held.push_back(object_.get().ptr());
    });
  }
  ~PythonHook() override {
    if (Py_IsInitialized() == 0) return;
    const py::gil_scoped_acquire lock;
    const auto session = session_.lock();
    if (session == nullptr) return;
    const auto found = std::find(session->held.begin(), session->held.end(), object_.get().ptr());
    if (found != session->held.end()) session->held.erase(found);
  }

  void before_run(core::HookContext& c) override { call(0, c); }
  void before_step(core::HookContext& c) override { call(1, c); }
  void after_step(core::HookContext& c) override { call(2, c); }
  bool is_done(core::HookContext& c) override { return call(3, c); }
  void after_run(core::HookContext& c) override { call(4, c); }
  bool reset(std::uint64_t seed) override {
    if (!has_[5]) return false;
    return in_python([&] { return py::cast<bool>(py::bool_(object_.get().attr("reset")(seed).is(py::bool_(true)))); });
  }
  std::optional<double> floor(double x_m, double y_m) override {
    if (!has_[6]) return std::nullopt;
    return in_python([&]() -> std::optional<double> {
      const py::object painted = object_.get().attr("floor")(x_m, y_m);
      if (painted.is_none()) return std::nullopt;
      return painted.cast<double>();
    });
  }
  std::any save() const override {
    if (!has_[7]) return {};
    return in_python([&]() -> std::any {
      py::object saved = py::module_::import("copy").attr("deepcopy")(object_.get().attr("save")());
      return std::make_shared<Held>(std::move(saved));
    });
  }
  void restore(const std::any& saved) override {
    if (!has_[8] || !saved.has_value()) return;
    in_python([&] {
      const auto held = std::any_cast<std::shared_ptr<Held>>(saved);
      object_.get().attr("restore")(py::module_::import("copy").attr("deepcopy")(held->get()));
    });
  }

 private:
  static constexpr std::array<const char*, 9> kMethods = {
      "before_run", "before_step", "after_step", "is_done", "after_run", "reset", "floor", "save", "restore"};

  bool call(std::size_t method, core::HookContext& context) {
    if (!has_[method]) return false;
    return in_python([&] {
      const auto session = session_.lock();
      if (session == nullptr || session->owner == nullptr) return false;
      core::HookContext* const outer = std::exchange(session->hook_context, &context);
      struct Back {
        Session& session;
        core::HookContext* outer;
        ~Back() { session.hook_context = outer; }
      } const back{*session, outer};
      session->read_arrays();
      const py::object answer =
          object_.get().attr(kMethods[method])(py::cast(session->owner, py::return_value_policy::reference));
      session->write_arrays();
      const int truth = PyObject_IsTrue(answer.ptr());
      if (truth < 0) throw py::error_already_set();
      return truth == 1;
    });
  }

  std::weak_ptr<Session> session_;
  Held object_;
  std::array<bool, kMethods.size()> has_{};
};

}  // namespace

const hal::Catalog& catalog() {
  static const hal::Catalog* const all = [] {
    auto* const made = new hal::Catalog(app::catalog());
    const hal::Status good = made->add_from(std::string(hal::Catalog::kInside), [](hal::Registrar& r) {
      static const hal::ControllerType guest = [] {
        hal::ControllerType type = hal::controller_type<PythonController>(kPythonController, "A class of Python.");
        type.step_row = &PythonController::step_row;
        return type;
      }();
      r.add(guest);
      r.add_controller<Driven>(kDriven, "Leaves its robot to whoever writes its ports from outside.");
      r.add(core::hook_type<PythonHook>(kPythonHook, "A hook of Python."));
    });
    if (!good.ok()) throw std::runtime_error(good.error().message);
    return made;
  }();
  return *all;
}

std::string keep_guest(const std::shared_ptr<Session>& session, py::object guest) {
  static std::uint64_t number = 0;
  std::string key = std::to_string(++number);
  session->held.push_back(guest.ptr());
  guests().emplace(key, Guest{session, std::move(guest)});
  session->keys.push_back(key);
  return key;
}

void forget_guests(Session& session) {
  for (const std::string& key : session.keys) guests().erase(key);
  session.keys.clear();
  session.held.clear();
}

Session::~Session() {
  world.reset();
  forget_guests(*this);
}

void Session::note(hal::Severity severity, std::string_view text) {
  static constexpr std::array<const char*, 3> kNames = {"info", "warning", "error"};
  const std::lock_guard hold(lock_);
  if (messages_.size() >= kMostMessages) messages_.erase(messages_.begin(), messages_.begin() + kMostMessages / 10);
  messages_.emplace_back(kNames[static_cast<std::size_t>(severity)], text);
}

std::vector<std::pair<std::string, std::string>> Session::messages() {
  const std::lock_guard hold(lock_);
  return messages_;
}

// --- ports of one robot ---

py::object Port::array(const std::shared_ptr<Session>& session, const hal::Field& field) {
  const py::str name{std::string(field.name)};
  if (arrays_.contains(name)) return arrays_[name];
  const bool writable = type_->role == hal::Role::Actuator;
  py::object made = array_of(session, field, static_cast<std::byte*>(memory_), length_.scalars(field), writable);
  arrays_[name] = made;
  return made;
}

py::object Port::get(const std::string& name) {
  const auto session = session_.lock();
  if (session == nullptr || session->owner == nullptr) throw std::runtime_error("the world of this robot is gone");
  const hal::Field* const field = type_->field(name);
  if (field == nullptr) no_field(*type_, name);
  if (field->count > 1) return array(session, *field);
  const double value = hal::get_value(memory_, *field, 0);
  if (field->scalar == hal::Scalar::F32 || field->scalar == hal::Scalar::F64) return py::float_(value);
  if (field->scalar == hal::Scalar::Bool) return py::bool_(value != 0.0);
  return py::int_(static_cast<std::int64_t>(value));
}

void Port::set(const std::string& name, const py::object& value) {
  const auto session = session_.lock();
  if (session == nullptr || session->owner == nullptr) throw std::runtime_error("the world of this robot is gone");
  const hal::Field* const field = type_->field(name);
  if (field == nullptr) no_field(*type_, name);
  if (type_->role == hal::Role::Sensor)
    throw py::attribute_error("'" + std::string(type_->name) + "' is a sensor: its readings cannot be set");
  if (field->count == 1 && (field->scalar == hal::Scalar::F64 || field->scalar == hal::Scalar::F32)) {
    const double number = PyFloat_AsDouble(value.ptr());  // the usual case, without an array
    if (number == -1.0 && PyErr_Occurred() != nullptr) {
      PyErr_Clear();
      throw py::type_error("'" + std::string(type_->name) + "." + name + "' takes a number, and this is of type " +
                           py::cast<std::string>(py::type::of(value).attr("__name__")));
    }
    hal::set_value(memory_, *field, 0, number);
  } else {
    assign(py::reinterpret_borrow<py::array>(array(session, *field)), *type_, *field, value);
  }
}

std::vector<std::string> Port::names() const {
  std::vector<std::string> names;
  for (const hal::Field& field : type_->fields) names.emplace_back(field.name);
  return names;
}

std::string Port::text() const {
  const auto session = session_.lock();
  if (session == nullptr || session->owner == nullptr) return "<tandem.Port of a world that is gone>";
  return "<tandem.Port " + hal::to_text(*type_, memory_) + ">";
}

void bind_guests(py::module_& m) {
  py::class_<Port, std::shared_ptr<Port>>(m, "Port",
                                          "One device of one robot: its fields are attributes. Those with several "
                                          "elements are arrays without a copy.")
      .def("__getattr__", &Port::get, py::arg("name"))
      .def("__setattr__", &Port::set, py::arg("name"), py::arg("value"))
      .def("__dir__", &Port::names)
      .def("__repr__", &Port::text);
  py::class_<hal::Random>(m, "Random", "Random numbers with the same bits on every machine.")
      .def(py::init<std::uint64_t, std::uint32_t>(), py::arg("seed"), py::arg("stream") = 0)
      .def("uniform", py::overload_cast<double, double>(&hal::Random::uniform), py::arg("low") = 0.0,
           py::arg("high") = 1.0)
      .def("integer", &hal::Random::integer, py::arg("low"), py::arg("high"), "Both included.")
      .def("chance", &hal::Random::chance, py::arg("probability"))
      .def("normal", &hal::Random::normal, py::arg("mean") = 0.0, py::arg("deviation") = 1.0)
      .def("exponential", &hal::Random::exponential, py::arg("mean") = 1.0)
      .def("__copy__", [](const hal::Random& r) { return r; })
      .def("__deepcopy__", [](const hal::Random& r, const py::dict&) { return r; });
  py::class_<GuestRobot, std::shared_ptr<GuestRobot>>(
      m, "Robot", "The robot that a controller of Python is made for. Its devices are taken while that is made.")
      .def_property_readonly("id", &GuestRobot::id)
      .def_property_readonly("kind", &GuestRobot::kind)
      .def_property_readonly("devices", &GuestRobot::devices, "(role, name) of each device that is listed.")
      .def(
          "sensor", [](GuestRobot& r, const std::string& name) { return r.port(name, hal::Role::Sensor); },
          py::arg("name"))
      .def(
          "actuator", [](GuestRobot& r, const std::string& name) { return r.port(name, hal::Role::Actuator); },
          py::arg("name"))
      .def("random", &GuestRobot::random, py::arg("stream") = 0,
           "Random numbers of this robot's own, from the run's seed.")
      .def("log", &GuestRobot::log, py::arg("text"), "Tells people something, with the robot's name and the tick.");
}

}  // namespace tandem::python
