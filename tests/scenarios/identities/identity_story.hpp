// Stories of one hub and two robots of a kind that are switched off, exchanged, renumbered and come back, in virtual
// time. The verdict is what the robots did: after what needs a person nothing moves until a person has re-armed it.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bridges/driver_bridge.hpp"
#include "hal/device/wheels.hpp"
#include "mixed_reality/safety/lone_robot.hpp"

namespace tandem::identities {

using hal::TimeNs;
inline constexpr TimeNs kMs = hal::kNsPerMs;
inline constexpr TimeNs kSecond = hal::kNsPerSecond;
inline constexpr TimeNs kTick = 100 * kMs;
inline constexpr int kNoPart = -1;

/// A robot and its firmware: an emulator without its server.
class Body {
 public:
  virtual ~Body() = default;
  /// Goes on to `now`; one that is off is kept from starting, as is its part `part_off`.
  virtual void live(TimeNs now, bool on, int part_off) = 0;
  /// How many parts it does not drive without may be off alone.
  virtual int parts() const { return 0; }
  /// Whether a wheel is told a speed that is not 0, or a flight, by the emulator's log.
  virtual bool moves() const = 0;
};

/// What the hub's link leads to. `robot` 0 or 1, or -1: nothing.
class HubSide {
 public:
  virtual ~HubSide() = default;
  /// The line is silent, or carries this robot.
  virtual void lead_to(int robot, TimeNs now) = 0;
  /// The device is gone, until `open`.
  virtual void hang_up(TimeNs now) = 0;
  virtual void open(const std::string& device, TimeNs now) = 0;
  /// What its thread does.
  virtual void pump(TimeNs now) = 0;
  /// What the hub says does not arrive, what the robot says does. False: this line has no such fault.
  virtual bool deafen(bool /*deaf*/) { return false; }
};

struct Rig {
  std::array<std::unique_ptr<Body>, 2> bodies;
  std::unique_ptr<bridges::RobotBridge> bridge;
  HubSide* hub = nullptr;                       // the same
  std::function<void(double speed_m_s)> drive;  // what its controller does in every tick
};

/// One kind: makes two robots and the hub's side; `seed` may choose firmwares.
using MakeRig = std::function<Rig(std::uint64_t seed)>;

/// The hub's side of a kind whose driver is `Driver`: judged as its bridge is, without its thread. `Self` has
/// `driver_`, and what DriverBridge asks for.
template <class Self, class Robot>
class DriverSide : public bridges::DriverBridge<Self, Robot>, public HubSide {
 public:
  bool at_rest() const noexcept override { return false; }
  std::string link_trouble() const { return ""; }
  std::string robot_trouble() const { return ""; }
  std::string advice() const override { return ""; }
  bridges::StopMessages stop_messages() const override { return {}; }
  bridges::LinkReport report() const override { return {}; }
  void describe(bridges::StatusVisitor&) const override {}

 protected:
  void note_open(const std::string& device) {
    reached_.link = "serial:/dev/robot@115200";
    reached_.device = device;
    ++reached_.session;
  }
  bridges::RobotIdentity reached_;
};

/// Plays stories 1 to `usual`, or as many as TANDEM_IDENTITY_RUNS says.
/// @returns the first few that went wrong; empty: nothing.
std::string play_all(const MakeRig& make, std::uint64_t usual);

}  // namespace tandem::identities
