// Interface through which real robots take part in a simulated world.
#pragma once

namespace tandem::core {

class World;

/// Called by World::step at fixed places of the tick, from the thread that steps.
class ExternalRobots {
 public:
  virtual ~ExternalRobots() = default;

  /// Phase 1: newest input of every bridge is taken over; poses of twins are set (`Space::set_pose`).
  virtual void latch(World& world) = 0;
  /// After every port holds its virtual reading and before any controller steps: real readings are fused in.
  virtual void after_sense(World& world) = 0;
  /// After the controllers stepped and before commands are limited: commands of robots whose controllers step elsewhere
  /// (`World::set_steps_elsewhere`) are written. @returns false: the tick is given up, and the run with it
  virtual bool after_control(World& /*world*/) { return true; }
  /// After commands were filtered: they are sent to real robots at once.
  virtual void after_filter(World& world) = 0;
};

}  // namespace tandem::core
