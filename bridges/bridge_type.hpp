// Interface of a kind of bridges: makes a real robot of one kind from its element of an experiment file.
//
//   void register_epuck(hal::Registrar& registrar) {
//     registrar.add(bridge_type);                                             this table
//     registrar.add(hal::element_options<EpuckOptions>("bridge of e-puck"));  its own attributes of <bridge>
//     registrar.add(stopper_type());                                          how the guardian stops such a robot
//   }
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bridges/robot_bridge.hpp"
#include "bridges/send_permit.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"
#include "hal/surface.hpp"
#include "hal/time.hpp"

namespace tandem::bridges {

/// One `<bridge>`, and what the run adds to it.
struct BridgeRequest {
  std::string kind;                            ///< of robot
  const hal::RobotKind* robot_kind = nullptr;  ///< what is known of it; null: what the bridge knows itself
  std::string robot;                           ///< its id
  std::string link;                            ///< "serial:/dev/ttyUSB0@115200"
  std::string file = {};                       ///< the experiment; files that it names may lie beside it
  std::shared_ptr<const void> options = {};    ///< its own attributes, as read; null: all left out
  hal::TimeNs tick_ns = 100 * hal::kNsPerMs;
  hal::TimeNs lost_after_ns = 500 * hal::kNsPerMs;  ///< silence, or lack of commands, after which it is stopped
  std::uint64_t seed = 1;
  /// Names of the devices that the controller's configuration lists; empty optional: all that the robot has.
  std::optional<std::vector<std::string>> sensors = {}, actuators = {};
  SendPermit permit = {};  ///< asked before everything that is said to the robot
  /// The clock that shows the date, for robots that are told it; null: the system's.
  hal::TimeNs (*unix_clock)() noexcept = nullptr;
};

using MadeBridge = hal::Result<std::unique_ptr<RobotBridge>>;

/// A file that a bridge reads: what it is, and its path.
using InputFile = std::pair<std::string, std::string>;

struct BridgeType {
  static constexpr std::string_view kCategory = "bridge";
  static constexpr std::uint32_t kNumber = 3;
  using Crosses =
      hal::Layouts<RobotBridge, BridgeRequest, MadeBridge, InputFile, hal::RobotKind, hal::RobotKind::Crosses,
                   SendPermit, StopMessages, RobotIdentity, LinkReport, PortView, hal::Log>;
  std::string_view name;     ///< the kind of robot, as the element in experiment files
  std::string_view summary;  ///< over which links, for people
  /// Does not wait for the robot. Errors: a link that does not suit it, options that make no sense, files that it
  /// needs.
  MadeBridge (*make)(const BridgeRequest& request, const hal::Log& log) = nullptr;
  /// The errors of `make`, without making anything.
  hal::Status (*check)(const BridgeRequest& request) = nullptr;
  /// Equal for two robots that would be one; null: the link is.
  std::string (*reached_by)(const BridgeRequest& request) = nullptr;
  /// The files that `make` reads; null: none.
  std::vector<InputFile> (*inputs)(const BridgeRequest& request) = nullptr;
};

/// The options of a request, or their defaults.
template <class Options>
Options options_of(const BridgeRequest& request) {
  return request.options == nullptr ? Options{} : *static_cast<const Options*>(request.options.get());
}

/// `BridgeType::check` of a bridge whose `make` begins with `prepare(request)`, a Result.
template <auto prepare>
hal::Status check_by(const BridgeRequest& request) {
  const auto prepared = prepare(request);
  return prepared.ok() ? hal::Status{} : hal::Status{prepared.error()};
}

/// Fills in what all bridges' settings have, from `parts`: `Parts::settings.driver.robot` and its time-outs.
template <class Settings>
void apply(const BridgeRequest& request, Settings& settings) {
  auto& driver = settings.driver;
  driver.robot.id = request.robot;
  driver.robot.kind = request.robot_kind;
  driver.robot.seed = request.seed;
  driver.robot.tick_ns = request.tick_ns;
  driver.robot.sensors = request.sensors;
  driver.robot.actuators = request.actuators;
  driver.command_timeout_ns = request.lost_after_ns;
}

}  // namespace tandem::bridges
