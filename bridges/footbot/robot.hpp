// The foot-bot as its controller sees it: ports that the wiring fills and drains.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bridges/footbot/map.hpp"
#include "hal/robot.hpp"
#include "hal/spec/footbot.hpp"

namespace tandem::bridges::footbot {

/// Every port class that a foot-bot's map may feed: sensors first. Range-and-bearing is in both halves.
const std::vector<const hal::PortType*>& port_types();

struct RobotSettings {
  std::string id = "footbot";
  std::uint64_t seed = 0;
  hal::TimeNs tick_ns = 100 * hal::kNsPerMs;
  hal::TimeNs origin_ns = 0;  ///< start of the run on the link's clock; readings are stamped from there
  hal::TimeNs fresh_ns = 0;   ///< older readings are stale; 0: two ticks, at least 150 ms
  /// Names of the devices that the configuration lists; empty optional: all that the robot has.
  std::optional<std::vector<std::string>> sensors = {};
  std::optional<std::vector<std::string>> actuators = {};
};

/// Ports of one foot-bot: those that the map feeds, the clock, and the odometry where the wheels' encoders are fed.
/// Not thread-safe: one thread constructs, latches, steps and commits.
class FootbotRobot final : public hal::Robot {
 public:
  FootbotRobot(RobotSettings settings, const FootbotMap& map);
  FootbotRobot(const FootbotRobot&) = delete;
  FootbotRobot& operator=(const FootbotRobot&) = delete;

  std::string_view id() const noexcept override { return settings_.id; }
  const hal::DataSheet& data_sheet() const noexcept override { return hal::footbot::kDataSheet; }
  std::uint64_t run_seed() const noexcept override { return settings_.seed; }

  /// Takes a port by its description, for those who fuse, record or inspect. The memory lives as long as the robot.
  /// @throws hal::DeviceError
  void* require(const hal::PortType& type) { return take(type); }
  /// Takes a port whatever the configuration lists; null when the map feeds none of that name, role and layout.
  void* find(const hal::PortType& type) noexcept;

  struct PortView {
    const hal::PortType* type;
    void* data;
  };
  /// Ports that were taken, in this order.
  std::vector<PortView> taken() const;
  /// Ports that there are.
  std::vector<const hal::PortType*> present() const;
  /// Whether somebody reads or writes the port, be it only the odometry. `type` is one of `port_types()`.
  bool uses(const hal::PortType& type) const noexcept;
  /// The port's memory. `type` is one of `port_types()`.
  void* memory(const hal::PortType& type) const noexcept { return row(type).data.get(); }
  template <class T>
  T& port() const noexcept {
    return *static_cast<T*>(memory(hal::port_type<T>()));
  }

  const RobotSettings& settings() const noexcept { return settings_; }
  void set_origin(hal::TimeNs origin_ns) noexcept { settings_.origin_ns = origin_ns; }
  /// Stamps a reading taken at `taken` (link's clock) whose variables are asked for every `period_ns`.
  void stamp(hal::Reading& reading, hal::TimeNs taken, hal::TimeNs period_ns, hal::TimeNs now) const noexcept;

  /// What follows from the readings that were just filled: clock, odometry, where the scanner's heads look, whether
  /// the gripper holds.
  void complete(hal::Tick tick) noexcept;

 protected:
  void* take(const hal::PortType& type) override;

 private:
  struct Row {
    const hal::PortType* type;
    std::unique_ptr<std::max_align_t[]> data;
    bool present = false;
    bool taken = false;
  };
  const Row& row(const hal::PortType& type) const noexcept;
  bool listed(const hal::PortType& type) const;
  void* take(Row& row);
  void reckon() noexcept;

  RobotSettings settings_;
  std::vector<Row> rows_;  // parallel to `port_types()`
  std::vector<std::size_t> order_;
  bool tells_holding_ = false;  // the map does
  bool reckoning_ = false;
  double left_m_ = 0.0, right_m_ = 0.0;  // that the odometry has seen
};

}  // namespace tandem::bridges::footbot
