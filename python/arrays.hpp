// Arrays of numpy over memory of a world.
#pragma once
#include <algorithm>
#include <memory>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>
#include <vector>

#include "hal/port.hpp"
#include "hal/robot_kind.hpp"
#include "python/session.hpp"

namespace tandem::python {

namespace py = pybind11;

py::dtype dtype_of(hal::Scalar scalar);

/// How much of a port's arrays the device of one kind of robot fills.
struct DeviceLength {
  /// As many as the kind has sensors or lamps; no entries where that changes from tick to tick, or the kind does not
  /// say.
  DeviceLength(const hal::PortType& type, const hal::RobotKind& kind);
  /// Of a field; its own capacity where there are no entries.
  std::size_t scalars(const hal::Field& field) const noexcept {
    return field.count == 1 || entries == 0 ? field.count : std::min(field.count, field.count / capacity * entries);
  }
  std::size_t entries = 0, capacity = 1;
};

/// The first `count` scalars of the field of one port, without a copy: shape (count,). Read-only for sensors. Holds
/// `session`.
py::array array_of(const std::shared_ptr<Session>& session, const hal::Field& field, std::byte* port, std::size_t count,
                   bool writable);

/// "there is no field 'x' in 'y'; it has: …", with what was perhaps meant.
[[noreturn]] void no_field(const hal::RowType& type, const std::string& name);

/// Assigns into such an array, which is that field. Errors name the field: other than numbers, another shape, numbers
/// that a field of whole numbers cannot hold.
void assign(const py::array& array, const hal::RowType& type, const hal::Field& field, const py::object& value);

/// Rows of a swarm: robots in the order of the file, that of their ids when the run began.
struct SwarmRows {
  std::byte* mark = nullptr;         ///< memory of the controllers: the same as long as the robots are there
  std::vector<std::uint32_t> place;  ///< by row of memory, which is in spatial order: row of every array
};

/// One port of all robots of a swarm: copies of the fields that were asked for, which the session keeps equal to the
/// world's memory (Session::read_arrays and write_arrays).
class PortArrays {
 public:
  /// `kept`: what holds the memory from `first` on where that is not the world's own.
  PortArrays(const std::shared_ptr<Session>& session, const hal::PortType& type, const hal::RobotKind& kind,
             std::byte* first, std::shared_ptr<const SwarmRows> rows, std::vector<std::shared_ptr<std::byte>> kept)
      : session_(session),
        type_(&type),
        length_(type, kind),
        first_(first),
        rows_(std::move(rows)),
        kept_(std::move(kept)) {}

  py::array get(const std::string& name);
  void set(const std::string& name, const py::object& value);
  std::vector<std::string> names() const;
  const hal::PortType& type() const noexcept { return *type_; }
  const SwarmRows* swarm() const noexcept { return rows_.get(); }
  std::size_t rows() const noexcept { return rows_->place.size(); }
  /// Copies between arrays and the world's memory. `write`: of actuators alone.
  void read() noexcept;
  void write() noexcept;

 private:
  struct Copy {
    py::array array;
    std::byte* data = nullptr;
    std::size_t offset = 0, bytes = 0;  ///< in a port; of a row
  };
  enum class Way { FromWorld, ToWorld };
  void copy(const Copy& field, Way way) const noexcept;

  std::weak_ptr<Session> session_;
  const hal::PortType* type_;
  DeviceLength length_;
  std::byte* first_;
  std::shared_ptr<const SwarmRows> rows_;
  std::vector<std::shared_ptr<std::byte>> kept_;
  std::map<std::string, Copy, std::less<>> fields_;
};

/// Robots of one kind and one controller whose rows lie one behind another: all that the file has of them. Robots that
/// are added while the run goes on form further swarms. Row i of every array is the same robot until the next reset.
class Swarm {
 public:
  /// All swarms of the world.
  static std::vector<std::shared_ptr<Swarm>> all(const std::shared_ptr<Session>& session);
  /// After the world went elsewhere: forgets arrays of robots that are gone. `anew`: rows are those of a new run.
  static void renew(const std::shared_ptr<Session>& session, bool anew);

  std::size_t size() const noexcept { return rows_->place.size(); }
  const std::string& kind() const noexcept { return kind_; }
  const std::string& controller() const noexcept { return controller_; }
  std::vector<std::string> ports(hal::Role role) const;
  std::shared_ptr<PortArrays> port(const std::string& name, hal::Role role);
  std::vector<std::string> ids() const;
  py::array alive() const;
  py::array poses() const;
  py::array published(const std::string& name) const;
  std::vector<std::string> published_names() const;
  std::string text() const;

 private:
  const core::SpaceStores& stores() const;  // or an error: the robots are gone
  template <class Visit>
  void each(Visit&& visit) const;
  void find_rows(std::size_t used);
  std::vector<std::uint32_t> file_order(std::size_t used) const;

  std::shared_ptr<Session> session_;
  std::size_t group_ = 0, first_block_ = 0, blocks_ = 0;
  std::shared_ptr<SwarmRows> rows_;
  std::vector<std::shared_ptr<std::byte>> kept_;
  std::string kind_, controller_;
  std::vector<std::pair<const hal::PortType*, std::byte*>> ports_;
};

void bind_arrays(py::module_& m);

}  // namespace tandem::python
