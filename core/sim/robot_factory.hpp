// Makes robots: gives each its row, its ports and its controller.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/device/device.hpp"
#include "core/scenario/scenario.hpp"
#include "core/space/stores.hpp"
#include "hal/plugin_call.hpp"
#include "hal/plugin_loader.hpp"
#include "hal/result.hpp"
#include "hal/robot_log.hpp"

namespace tandem::core {

/// One robot to be made.
struct RobotRequest {
  std::uint32_t item = 0;    ///< of Scenario::robots
  std::uint32_t entity = 0;  ///< index of its id
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double yaw_rad = 0.0;
};

/// Devices of one block, in the order of the group's ports. Shared with snapshots: they bring back blocks that the run
/// left behind when it went to an earlier moment.
struct BlockDevices {
  std::vector<std::shared_ptr<Sensor>> sensors;      ///< null where the port is an actuator
  std::vector<std::shared_ptr<Actuator>> actuators;  ///< null where the port is a sensor
};

/// Products of the factory beyond the stores.
struct RobotDevices {
  std::vector<BlockDevices> blocks;  ///< parallel to SpaceStores::blocks
};

/// Makes the robots of a file at the start, and others while the run goes on. Everything that it is handed must outlive
/// it.
class RobotFactory {
 public:
  RobotFactory(const Scenario& scenario, std::uint64_t seed, hal::PluginLoader& loader, SpaceStores& stores,
               RobotDevices& devices, Media& media, hal::RobotLog::Sink& messages)
      : scenario_(scenario),
        seed_(seed),
        loader_(loader),
        stores_(stores),
        devices_(devices),
        media_(media),
        messages_(messages) {}
  ~RobotFactory();
  RobotFactory(const RobotFactory&) = delete;
  RobotFactory& operator=(const RobotFactory&) = delete;

  const hal::Catalog& catalog() const noexcept { return loader_.catalog(); }

  /// Fills the stores (bodies, groups, blocks, robots) and the devices. Every problem goes to `problems` with the line
  /// of the robot or controller that it is about. Robots of a group get rows in the order of a space-filling curve.
  void make(const std::vector<RobotRequest>& requests, Problems& problems);

  /// Before the stores are emptied for a reset: ends the controllers of robots that came later, and remembers what
  /// `make` made, so that the next `make` fills it again: groups, blocks, ports, and controllers that can be reset.
  /// `changed`: the scenario is another than that `make` had, in what World::reset takes over; controllers are
  /// constructed again.
  void begin_anew(std::uint64_t seed, bool changed);
  /// Whether a controller was reset since then, and may remember the run before.
  bool any_reset() const noexcept { return any_reset_; }

  /// What is wrong with the parameters of controllers in another scenario of the same robots.
  void check_params(const Scenario& changed, Problems& problems) const;

  /// Adds one robot, in the first free row of its group or a new one. `accepts(row)` is asked once the body stands in
  /// its row, before its controller is made. Errors: what is wrong with the parameters; what `accepts` says; a
  /// controller that throws. Nothing then shows that it was tried.
  hal::Result<RobotId> add(const RobotItem& item, const Pose& pose,
                           const std::function<hal::Status(std::size_t row)>& accepts);

  /// Takes what the controllers of a block remember. @returns what gives it to those that are made in their place;
  /// empty: they start again.
  using KeepMemory = std::function<std::function<hal::Status()>(std::size_t block)>;

  /// The scenario has changed from `before` while the run goes on, in what World::continue_with takes over: does that
  /// for all robots. Error: a controller that cannot be made; some are changed then and others not.
  hal::Status go_on_from(const Scenario& before, const KeepMemory& keep);

  /// "controller 'c' (library 'x') of robot 'ep3'": who has this slot of a block. For hal::PluginCall.
  void name_controller(std::size_t block, std::size_t slot, hal::FixedText& out) const noexcept;

 private:
  std::vector<std::vector<std::uint32_t>> group(const std::vector<RobotRequest>& requests);
  void sort_by_place(const std::vector<RobotRequest>& requests, std::vector<std::uint32_t>& members) const;
  bool prepare_group(std::size_t g, Problems& problems);
  std::shared_ptr<const void> read_params(const RobotGroup& group, const RobotItem& item, const Scenario& scenario,
                                          Problems& problems) const;
  bool read_devices(const RobotGroup& group, hal::Role role, GroupFactories& factories, Problems& problems);
  bool make_blocks(std::size_t g, const std::vector<RobotRequest>& requests, const std::vector<std::uint32_t>& members,
                   Problems& problems);
  std::uint32_t add_block(std::size_t g, std::size_t capacity);
  void place(const RobotRequest& request, Slot at);
  void end_kept() noexcept;
  std::string construct(Slot at, const std::shared_ptr<const void>& params);
  static void name_constructor(const void* factory, std::size_t block, std::size_t slot, hal::FixedText& out) noexcept;
  static void name_params(const void* factory, std::size_t config, std::size_t index, hal::FixedText& out) noexcept;
  void note_needs(RobotGroup& group);
  void add_rows(std::size_t block);
  void complete(std::size_t g);
  hal::Result<std::size_t> group_for(const RobotItem& item);
  Slot free_slot(std::size_t g);
  struct Taken {  // by the controllers of a group
    std::size_t ports, published;
  };
  struct Room {  // for a robot that comes while the run goes on
    std::size_t group = 0;
    Slot slot;
    std::shared_ptr<const void> params;
    bool own_params = false;
    Taken before{};
  };
  hal::Result<Room> room_for(const RobotItem& item);
  void begin_row(const Room& room);
  void end_row(Room& room);
  static void reset_row(const RobotGroup& group, RobotBlock& block, std::size_t slot);
  static hal::Error cannot_be_made(const RobotItem& item, const Problems& problems);
  hal::Status change_group(std::size_t g, const Scenario& before, const KeepMemory& keep);
  hal::Status make_anew(std::size_t g, const KeepMemory& keep);
  hal::Status move(std::uint32_t entity, const RobotItem& item);
  void give_back(std::size_t g, Slot slot, const Taken& before, std::uint32_t entity_before);
  hal::Status can_hold(Slot at) const;

  const Scenario& scenario_;
  std::uint64_t seed_;
  hal::PluginLoader& loader_;
  SpaceStores& stores_;
  RobotDevices& devices_;
  Media& media_;
  hal::RobotLog::Sink& messages_;
  std::vector<std::size_t> group_of_item_;  // by the file's robots; decided once
  std::vector<RobotGroup> start_groups_;    // as `make` left them
  std::vector<RobotBlock> start_blocks_;
  std::vector<std::pair<ColumnArrays*, std::vector<std::byte*>>> start_columns_;
  std::size_t start_robots_ = 0;
  std::vector<RobotBlock> kept_;  // start_blocks_ with their controllers, to be filled again
  std::size_t filled_ = 0;        // how many of them are
  bool new_settings_ = false;     // controllers are not to be reset
  bool any_reset_ = false;
  std::vector<std::shared_ptr<const void>> former_params_;  // controllers may know theirs
  Slab* slab_ = nullptr;                                    // where blocks get their memory; null: each on its own
  std::size_t start_rows_ = 0;                              // of the group that is being made at the start
};

/// Ends the life of every controller. Before the loader closes its plug-ins.
void destroy_controllers(SpaceStores& stores) noexcept;
void destroy_controllers(SpaceStores& stores, RobotBlock& block) noexcept;

}  // namespace tandem::core
