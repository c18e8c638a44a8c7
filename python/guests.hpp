// Classes of Python that take part in a world: controllers and hooks; and the controller that leaves its robot to
// writers of its ports from outside.
#pragma once
#include <memory>
#include <pybind11/pybind11.h>
#include <string>

#include "hal/catalog.hpp"
#include "python/arrays.hpp"
#include "python/session.hpp"

namespace tandem::python {

namespace py = pybind11;

/// The program's catalog with these classes, which are named by the library "tandem".
const hal::Catalog& catalog();

inline constexpr const char* kPythonController = "python_controller";
inline constexpr const char* kPythonHook = "python_hook";
inline constexpr const char* kDriven = "driven_from_python";
inline constexpr const char* kKey = "python";  ///< attribute that names a guest

/// Keeps what a world is made with, until the session ends; @returns the key under which the world finds it.
std::string keep_guest(const std::shared_ptr<Session>& session, py::object guest);
void forget_guests(Session& session);

/// One port as a controller of Python sees it: `proximity.distance` is an array without a copy, `wheels.left = 0.1`
/// writes. Keeps nothing alive: once its world is gone, using it is an error.
class Port {
 public:
  Port(std::weak_ptr<Session> session, void* memory, const hal::PortType& type, const hal::RobotKind& kind)
      : session_(std::move(session)), memory_(memory), type_(&type), length_(type, kind) {}

  py::object get(const std::string& name);
  void set(const std::string& name, const py::object& value);
  std::vector<std::string> names() const;
  std::string text() const;
  const py::dict& arrays() const noexcept { return arrays_; }

 private:
  py::object array(const std::shared_ptr<Session>& session, const hal::Field& field);

  std::weak_ptr<Session> session_;
  void* memory_;
  const hal::PortType* type_;
  DeviceLength length_;
  py::dict arrays_;  // by field, once asked for
};

void bind_guests(py::module_& m);

}  // namespace tandem::python
