// Arrays of numpy over memory of a world.
#pragma once
#include <memory>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

#include "hal/port.hpp"
#include "python/session.hpp"

namespace tandem::python {

namespace py = pybind11;

py::dtype dtype_of(hal::Scalar scalar);

/// The field over `rows` rows of `type` from `first` on, without a copy: shape (rows,) or (rows, count); (count,) where
/// `rows` is 0: of one row. Read-only for sensors. Holds `session`.
py::array array_of(const std::shared_ptr<Session>& session, const hal::RowType& type, const hal::Field& field,
                   std::byte* first, std::size_t rows, bool writable);

/// "there is no field 'x' in 'y'; it has: …", with what was perhaps meant.
[[noreturn]] void no_field(const hal::RowType& type, const std::string& name);

/// Assigns into such an array, which is that field. Errors name the field: other than numbers, another shape, numbers
/// that a field of whole numbers cannot hold.
void assign(const py::array& array, const hal::RowType& type, const hal::Field& field, const py::object& value);

/// One port of all robots of a swarm.
class PortArrays {
 public:
  PortArrays(std::shared_ptr<Session> session, const hal::PortType& type, std::byte* first, std::size_t rows)
      : session_(std::move(session)), type_(&type), first_(first), rows_(rows) {}

  py::array get(const std::string& name);
  void set(const std::string& name, const py::object& value);
  std::vector<std::string> names() const;
  const hal::PortType& type() const noexcept { return *type_; }
  std::size_t rows() const noexcept { return rows_; }

 private:
  std::shared_ptr<Session> session_;
  const hal::PortType* type_;
  std::byte* first_;
  std::size_t rows_;
  std::map<std::string, py::array, std::less<>> arrays_;
};

/// Robots of one kind and one controller whose rows lie one behind another: all that the file has of them. Robots that
/// are added while the run goes on form further swarms. Row i of every array is the same robot until the next reset.
class Swarm {
 public:
  /// All swarms of the world.
  static std::vector<std::shared_ptr<Swarm>> all(const std::shared_ptr<Session>& session);

  std::size_t size() const noexcept { return rows_; }
  const std::string& kind() const noexcept { return kind_; }
  const std::string& controller() const noexcept { return controller_; }
  std::vector<std::string> ports(hal::Role role) const;
  std::shared_ptr<PortArrays> port(const std::string& name, hal::Role role);
  std::vector<std::string> ids() const;
  py::array order() const;
  py::array alive() const;
  py::array poses() const;
  py::array published(const std::string& name) const;
  std::vector<std::string> published_names() const;
  std::string text() const;

 private:
  const core::SpaceStores& stores() const;  // or an error: the robots are gone
  template <class Visit>
  void each(Visit&& visit) const;

  std::shared_ptr<Session> session_;
  std::size_t group_ = 0, first_block_ = 0, blocks_ = 0, first_row_ = 0, rows_ = 0;
  std::byte* mark_ = nullptr;  // memory of the controllers: the same as long as the robots are there
  std::vector<std::shared_ptr<std::byte>> kept_;
  std::string kind_, controller_;
  std::vector<std::pair<const hal::PortType*, std::byte*>> ports_;
  std::map<std::pair<std::string, int>, std::shared_ptr<PortArrays>> made_;
};

void bind_arrays(py::module_& m);

}  // namespace tandem::python
