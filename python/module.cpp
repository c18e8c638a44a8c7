// The module `_tandem`, on which the package `tandem` of Python stands.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "app/catalog.hpp"
#include "hal/port.hpp"
#include "hal/surface.hpp"
#include "python/arrays.hpp"
#include "python/guests.hpp"
#include "python/picture.hpp"
#include "python/world.hpp"

namespace tandem::python {
namespace {

const char* type_of(hal::Scalar scalar) {
  static constexpr const char* kNames[] = {"float32", "float64", "uint8", "uint16", "uint32", "int32", "int64", "bool"};
  return kNames[static_cast<std::size_t>(scalar)];
}

/// Every port, as its schema describes it: for stubs, documentation and environments.
py::list ports() {
  py::list all;
  for (const hal::PortType* type : app::catalog().all<hal::PortType>()) {
    py::list fields;
    for (const hal::Field& f : type->fields) {
      py::dict field;
      field["name"] = f.name;
      field["type"] = type_of(f.scalar);
      field["count"] = f.count;
      field["unit"] = f.unit.symbol;
      field["doc"] = f.doc;
      field["used_by"] = f.used_by;
      field["per_entry"] = hal::used_by(*type, f).per_entry;
      fields.append(field);
    }
    py::dict port;
    port["name"] = type->name;
    port["role"] = type->role == hal::Role::Sensor ? "sensor" : "actuator";
    port["doc"] = type->doc;
    port["fields"] = fields;
    all.append(port);
  }
  return all;
}

}  // namespace
}  // namespace tandem::python

PYBIND11_MODULE(_tandem, m) {
  using namespace tandem;
  m.doc() = "Tandem's worlds for Python; use the package tandem.";
  m.attr("version") = std::to_string(hal::kRelease.major_number) + "." + std::to_string(hal::kRelease.minor_number) +
                      "." + std::to_string(hal::kRelease.patch);
  m.def("ports", &python::ports, "Every port with its fields.");
  m.def("changes_at_reset", &python::changes_at_reset, "Whether World.reset can take over 'path=value'.");
  python::bind_guests(m);
  python::bind_arrays(m);
  python::bind_picture(m);
  python::bind_world(m);
  python::bind_records(m);
}
