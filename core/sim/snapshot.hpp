// Snapshot of a running world, to go back to.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/sim/robot_factory.hpp"
#include "core/space/stores.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::core {

struct SavedWorld;  // core/sim/world.cpp: everything beside the space

/// State of a world, from World::snapshot for World::restore. Its copies share what was kept, which never changes. Must
/// not outlive the plug-ins whose controllers it holds.
class Snapshot {
 public:
  hal::Tick tick() const noexcept { return tick_; }
  /// About how much memory it takes, but for what controllers and hooks hold outside of themselves.
  std::size_t bytes() const noexcept { return bytes_; }

 private:
  friend class World;
  Snapshot(hal::Tick tick, std::size_t bytes, std::shared_ptr<const SavedWorld> state)
      : tick_(tick), bytes_(bytes), state_(std::move(state)) {}
  hal::Tick tick_;
  std::size_t bytes_;
  std::shared_ptr<const SavedWorld> state_;
};

/// A copy of the stores and of all controllers.
class SpaceCopy {
 public:
  /// Errors: a controller whose class cannot be copied, or whose copy constructor throws; names it.
  static hal::Result<std::unique_ptr<SpaceCopy>> take(const Space& space, const RobotDevices& devices);
  ~SpaceCopy();
  SpaceCopy(const SpaceCopy&) = delete;
  SpaceCopy& operator=(const SpaceCopy&) = delete;

  /// Makes the space equal to the copy, whether that is of an earlier state of what went on or of another way on from
  /// an earlier one. `space` and `devices` are those that it was taken from: controllers and ports stand at the same
  /// addresses as then. Errors: a copy constructor that throws; the robot is then halted.
  hal::Status put_back(Space& space, RobotDevices& devices) const;
  std::size_t bytes() const noexcept;

 private:
  SpaceCopy() = default;

  struct Block {
    RobotBlock was;                    // keeps the arrays of blocks that the run leaves behind
    std::byte* controllers = nullptr;  // of memory_; as in `was.constructed` as far as they are `copied`
    std::size_t copied = 0;            // slots
    std::vector<std::vector<std::byte>> ports;
    std::vector<std::vector<std::byte>> columns;

    std::byte* controller(std::size_t slot) const noexcept { return controllers + slot * was.controller_stride; }
  };
  hal::Status copy_block(const Space& space, std::size_t b);
  const hal::ControllerType& type_of(const Block& block) const noexcept { return *groups_[block.was.group].controller; }
  hal::Status put_back_block(std::size_t b, Space& space) const;

  Slab memory_;
  std::vector<RobotGroup> groups_;
  std::vector<Block> blocks_;
  std::vector<std::pair<ColumnArrays*, std::vector<std::byte*>>> column_arrays_;
  SpaceParts parts_;  // indices too: their cells are chosen by what was there before, and they are as old as they were
  RobotDevices devices_;
  std::vector<std::shared_ptr<const void>> fields_;
};

/// Copies a controller. Says what it threw, or nothing.
std::string copied(const hal::ControllerType& type, void* where, const void* from);

/// The stores have another state than before: keepers of parts of them look again.
void note_other_state(SpaceStores& stores);

}  // namespace tandem::core
