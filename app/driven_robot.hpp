// A real robot as `tandem robot` drives it, whatever its kind.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/json.hpp"
#include "core/scenario/scenario.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "hal/robot.hpp"
#include "mixed_reality/time/pacer.hpp"

namespace tandem::app {

/// What the experiment says of the one robot that is driven.
struct DrivenRobotRequest {
  const core::RobotItem& item;  ///< `item.bridge` is set
  const core::ControllerConfig& controller;
  std::int64_t ticks_per_second = 10;
  std::uint64_t seed = 1;
};

/// A bridge with its guardian. The controller is constructed with `robot()` before `start`.
class DrivenRobot {
 public:
  virtual ~DrivenRobot() = default;

  virtual hal::Robot& robot() noexcept = 0;
  virtual void set_origin(hal::TimeNs origin_ns) noexcept = 0;
  virtual void start() = 0;
  /// Error: it does not answer within the time; says what is known.
  virtual hal::Status wait_active(hal::TimeNs timeout_ns) = 0;
  /// Its link does not even open: nothing to wait for.
  virtual bool unreachable() const = 0;
  /// Error: it is another one than the file says.
  virtual hal::Status check_identity() const = 0;

  virtual void latch(hal::Tick tick, hal::TimeNs now) noexcept = 0;
  virtual void commit(hal::TimeNs now) noexcept = 0;
  virtual void fault(hal::TimeNs now, std::string_view why) = 0;

  /// It was never driven: the guardian may forget it.
  virtual void forget() = 0;
  /// Stops it and ends the conversation; the guardian forgets it when it is known to stand still.
  virtual void shut_down() = 0;

  /// As it was when `shut_down` was called, or is. Why it was lost; empty when it was not.
  virtual std::string loss() const = 0;
  virtual std::string link() const = 0;
  /// Adds what is told of its kind alone.
  virtual void add_to_report(Json& json) const = 0;
  virtual std::vector<std::pair<std::string, std::string>> table() const = 0;
};

/// Makes the bridge that the robot's kind needs, and a guardian: call it before any thread exists. Errors: no bridge
/// for that kind; a link that does not suit it; what its own configuration lacks.
hal::Result<std::unique_ptr<DrivenRobot>> make_driven_robot(const DrivenRobotRequest& request, const hal::Log& log);

/// The makers for each kind.
hal::Result<std::unique_ptr<DrivenRobot>> make_driven_epuck(const DrivenRobotRequest& request, const hal::Log& log);
hal::Result<std::unique_ptr<DrivenRobot>> make_driven_footbot(const DrivenRobotRequest& request, const hal::Log& log);
hal::Result<std::unique_ptr<DrivenRobot>> make_driven_eyebot(const DrivenRobotRequest& request, const hal::Log& log);

/// Names of the devices in a configuration.
std::vector<std::string> device_names(const std::vector<core::DeviceChoice>& choices);

}  // namespace tandem::app
