// Brings robots, objects and joints into a running world.
#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "core/placement/occupancy.hpp"
#include "core/sim/region_assigner.hpp"
#include "core/sim/robot_factory.hpp"
#include "core/space/editor.hpp"

namespace tandem::core {

/// Carries out the changes that Space cannot make by itself. Everything that it is handed must outlive it.
class WorldEditor final : public Editor {
 public:
  WorldEditor(const Scenario& scenario, SpaceStores& stores, RobotFactory& factory, const RegionAssigner& assigner)
      : scenario_(scenario), stores_(stores), factory_(factory), assigner_(assigner) {}

  hal::Result<RobotId> add_robot(const NewRobot& wanted) override;
  hal::Result<ObjectId> add_object(const Object& wanted) override;
  hal::Status set_object(ObjectId object, const Object& changed) override;
  hal::Status room_for(BodyKey body, const Pose& pose) override;
  hal::Result<JointId> join(BodyKey a, BodyKey b, const std::array<double, 3>& p_W, const JointForm& form) override;

 private:
  std::string usual_kind(std::size_t controller) const;
  hal::Result<RobotItem> item_for(const NewRobot& wanted) const;
  hal::Status check_place(const std::string& who, const Pose& pose) const;
  hal::Status check_shape(const Object& object) const;
  hal::Status check_mover(const Object& object, std::uint16_t region) const;
  hal::Status accept(const std::string& who, std::size_t row, bool may_overlap);
  std::string name_of(BodyKey body) const;
  /// What `o` would overlap, if anything; `of_immovable`: what cannot move may overlap its like.
  std::optional<BodyKey> in_the_way(const Obstacle& o, BodyKey self, bool of_immovable);
  Obstacle obstacle_of(BodyKey body);
  bool alive(BodyKey body) const noexcept;
  std::uint16_t region_now(BodyKey body) const noexcept;
  std::uint16_t region_at(BodyKey body, const Pose& pose);

  const Scenario& scenario_;
  SpaceStores& stores_;
  RobotFactory& factory_;
  const RegionAssigner& assigner_;
  // Where bodies stood when they were entered. They are looked up in the stores again: this only tells whom to ask.
  std::optional<Occupancy> occupancy_;
  std::uint64_t entered_version_ = 0;  // of the poses
  std::size_t entered_ = 0;            // how many of the touched bodies
  std::deque<Solid> leaning_;          // by object: those that lean, when they were last looked at
};

}  // namespace tandem::core
