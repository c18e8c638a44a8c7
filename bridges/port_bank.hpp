// The ports of one robot, real or emulated: memory for each class, found by type.
#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "bridges/body_pose.hpp"
#include "hal/check.hpp"
#include "hal/port.hpp"

namespace tandem::bridges {

/// The descriptions of some classes of ports, in this order.
template <class... Port>
std::vector<const hal::PortType*> port_types_of() {
  return {&hal::port_type<Port>()...};
}

/// Holds one port of each class: an absent reading, or the safe command, until it is written. Looks up nothing
/// but by type; allocates only when it is made. Not thread-safe.
class PortBank {
 public:
  explicit PortBank(std::span<const hal::PortType* const> types) {
    for (const hal::PortType* type : types) {
      const std::size_t blocks = (type->size + sizeof(std::max_align_t) - 1) / sizeof(std::max_align_t);
      rows_.push_back({type, std::make_unique<std::max_align_t[]>(blocks)});
      type->reset(rows_.back().memory.get());
    }
  }

  struct Row {
    const hal::PortType* type;
    std::unique_ptr<std::max_align_t[]> memory;
    void* data() const noexcept { return memory.get(); }
  };
  const std::vector<Row>& rows() const noexcept { return rows_; }

  /// The port of that name and role, whatever its layout; `rows().size()` when there is none.
  std::size_t find(std::string_view name, hal::Role role) const noexcept {
    std::size_t i = 0;
    while (i < rows_.size() && !(rows_[i].type->name == name && rows_[i].type->role == role)) ++i;
    return i;
  }
  /// The port of that name, role and layout, or null.
  void* find(const hal::PortType& type) const noexcept {
    const std::size_t i = find(type.name, type.role);
    return i < rows_.size() && rows_[i].type->layout == type.layout ? rows_[i].data() : nullptr;
  }
  template <class Port>
  Port* find() const noexcept {
    return static_cast<Port*>(find(hal::port_type<Port>()));
  }
  /// Of one of the types that the bank was made with, without a look at its name.
  std::size_t row_of(const hal::PortType& type) const noexcept {
    std::size_t i = 0;
    while (i < rows_.size() && rows_[i].type != &type) ++i;
    TANDEM_CHECK(i < rows_.size(), "asked for a port that the robot was made with");
    return i;
  }
  template <class Port>
  Port& port() const noexcept {
    return *static_cast<Port*>(rows_[row_of(hal::port_type<Port>())].data());
  }
  /// Lets `use` at a reading, unless it was never measured.
  template <class Port, class Use>
  void read(Use&& use) const {
    const Port& reading = port<Port>();
    if (reading.validity != hal::Validity::Absent) use(reading);
  }

 private:
  std::vector<Row> rows_;
};

/// Copies as many values as both have.
template <class From, class To>
void copy_values(const From& from, To& to) {
  std::copy_n(from.begin(), std::min(from.size(), to.size()), to.begin());
}

/// The ports of an emulated robot that lives in a foreign world: that side fills the readings and takes the
/// commands, the firmware's side the other way round, each from its own thread.
class SharedPorts {
 public:
  explicit SharedPorts(std::span<const hal::PortType* const> types) : bank_(types) {}

  /// Lets `use(bank)` at the ports, alone.
  template <class Use>
  auto with(Use&& use) {
    const std::lock_guard lock(mutex_);
    return use(bank_);
  }
  /// The same for writers of readings: they are new from now on.
  template <class Use>
  void tell(Use&& use) {
    const std::lock_guard lock(mutex_);
    use(bank_);
    ++told_;
  }
  /// How often readings were written; asked within `with`.
  std::uint64_t told() const noexcept { return told_; }

  /// The body's true pose, from the owner of the world; nothing: not yet known.
  void set_pose(const BodyPose& pose) {
    const std::lock_guard lock(mutex_);
    pose_ = pose;
  }
  std::optional<BodyPose> pose() {
    const std::lock_guard lock(mutex_);
    return pose_;
  }

 private:
  std::optional<BodyPose> pose_;
  std::mutex mutex_;
  PortBank bank_;
  std::uint64_t told_ = 0;
};

}  // namespace tandem::bridges
