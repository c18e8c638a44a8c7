// What moves and lights the robots of a space: where the values lie that their appearance names.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/space/space.hpp"
#include "core/space/stores.hpp"
#include "hal/appearance.hpp"

namespace tandem::core {

/// One driver's value of one robot.
struct DrivenValue {
  const std::byte* row = nullptr;  ///< null: the robot has no such row
  const hal::Field* field = nullptr;
  const hal::Driver* driver = nullptr;

  double value() const noexcept;
};

/// Lamps of one robot whose colours lie one behind the other, or one that is only switched.
struct LampRun {
  std::uint32_t first = 0, count = 1;  ///< of its lamps
  const std::byte* rgb = nullptr;      ///< null: `switched` counts
  DrivenValue switched = {};
  hal::Rgb color = {};  ///< while it is on

  /// Their colours, into those of all lamps of the robot.
  void read(hal::Rgb* lamps) const noexcept;
};

/// Valid as long as the robots and ports of the space are the same.
class Looks {
 public:
  explicit Looks(const Space& space);
  Looks(Looks&&) noexcept = default;
  Looks(const Looks&) = delete;

  /// Of the robots of that one's group.
  const hal::Appearance& appearance(RobotId robot) const noexcept;
  /// Values in the order of Appearance::drivers, behind those that there are.
  void add_values(RobotId robot, std::vector<DrivenValue>& to) const;
  void add_lamps(RobotId robot, std::vector<LampRun>& to) const;

  /// Where rows of a form lie: in a port, or a column of the group.
  struct Place {
    const hal::RowType* type = nullptr;  ///< null: the group has no such
    const ColumnArrays* column = nullptr;
    std::size_t port = 0;  ///< of RobotGroup::ports, where there is no column

    const std::byte* row(const RobotBlock& block, std::size_t number, std::size_t slot) const noexcept;
  };
  /// The rows that a driver names: "sensor NAME", "actuator NAME", or a column.
  static Place place_of(const RobotGroup& group, std::string_view row) noexcept;

 private:
  struct Driven {
    Place place;
    const hal::Field* field = nullptr;
    const hal::Driver* driver = nullptr;
  };
  struct Group {
    hal::Appearance appearance;
    std::vector<Driven> values, lamps;
  };
  static Driven driven(const RobotGroup& group, const hal::Driver& driver, std::size_t values) noexcept;
  DrivenValue value_of(const Driven& driven, const RobotEntity& robot) const noexcept;
  const Group& group_of(RobotId robot) const noexcept;

  const SpaceStores& stores_;
  std::vector<Group> groups_;
};

/// The rows that the appearances of these kinds name, each once, in the order in which they do.
std::vector<std::string> driven_rows(const std::vector<const hal::RobotKind*>& kinds);
/// How records call one of these rows: without the role of a port, unless another row would be called the same.
std::string_view row_name(const std::vector<std::string>& rows, std::string_view row) noexcept;

/// "#rrggbb" as a colour; anything else is black.
hal::Rgb rgb_of(std::string_view hex) noexcept;

}  // namespace tandem::core
