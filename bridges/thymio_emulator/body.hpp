// Interface of an emulated Thymio's body: its senses and commands in SI, the world behind the node.
#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "bridges/body_pose.hpp"
#include "bridges/emulation/imperfect_wheels.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::thymio_emulator {

/// Everything that the robot's devices measure at one instant, in the order of its variables. The defaults are a robot
/// at rest on white ground in the middle of nowhere.
struct BodySenses {
  std::array<double, 7> distance_m = nowhere();         ///< from each infrared sensor
  std::array<double, 2> ground = {1.0, 1.0};            ///< 0 black, 1 white
  std::array<double, 3> force_m_s2 = {0.0, 0.0, 9.81};  ///< specific force: x forward, y left, z up
  std::array<bool, 5> buttons{};                        ///< backward, left, center, forward, right: pressed
  double sound = 0.0;                                   ///< 0 silence, 1 full scale

  static constexpr std::array<double, 7> nowhere() {
    std::array<double, 7> all{};
    all.fill(std::numeric_limits<double>::infinity());
    return all;
  }
};

inline constexpr std::size_t kLeds = 11;  ///< circle, below left, below right, top

/// Command of the node to the robot's body.
struct BodyCommand {
  double left_m_s = 0.0;  ///< rim speeds
  double right_m_s = 0.0;
  std::array<std::uint8_t, 3 * kLeds> rgb{};  ///< red, green, blue of LED 0, of LED 1, …
  double tone_Hz = 0.0;                       ///< 0: silence
  friend bool operator==(const BodyCommand&, const BodyCommand&) = default;
};

/// A body for the node to live in. Times never decrease. All calls come from the thread that runs the node.
class EmulatedBody {
 public:
  virtual ~EmulatedBody() = default;
  virtual BodySenses sense(hal::TimeNs now) = 0;
  /// `command` holds from `now` until the next call.
  virtual void actuate(hal::TimeNs now, const BodyCommand& command) = 0;
};

/// Open ground, where nothing is to be sensed; it rolls there without slip, on wheels that may err.
class OpenGround final : public EmulatedBody {
 public:
  explicit OpenGround(const BodyPose& start = {}, const WheelErrors& errors = {}) : pose_(start), wheels_(errors) {}
  BodySenses sense(hal::TimeNs /*now*/) override { return senses; }
  void actuate(hal::TimeNs now, const BodyCommand& command) override {
    advance(now);
    command_ = command;
    wheels_.tell(now, command.left_m_s, command.right_m_s);
  }
  /// Rolls on to `now`.
  void advance(hal::TimeNs now);
  const BodyCommand& command() const noexcept { return command_; }
  const BodyPose& pose() const noexcept { return pose_; }

  BodySenses senses;

 private:
  BodyCommand command_;
  BodyPose pose_;  // taken when it last rolled
  ImperfectWheels wheels_;
};

}  // namespace tandem::bridges::thymio_emulator
