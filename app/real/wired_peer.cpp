#include "app/real/wired_peer.hpp"

#include <cstring>
#include <exception>

#include "app/real/bridged_controller.hpp"
#include "app/real/listed_robot.hpp"
#include "app/real/simulated_body.hpp"
#include "bridges/wired/wired_robot.hpp"
#include "core/space/stores.hpp"
#include "mixed_reality/settings/bridge_request.hpp"

namespace tandem::app {
namespace {

const core::RobotGroup& group_of(const core::World& world, core::RobotId robot) {
  const core::SpaceStores& s = world.space().stores();
  return s.groups[s.blocks[s.robots[robot.index].block].group];
}

class WiredPeer final : public mixed_reality::Partner {
 public:
  WiredPeer(const hal::Catalog& catalog, core::World& world, core::RobotId robot,
            std::unique_ptr<bridges::WiredRobot> wired, const hal::Log& log)
      : robot_(robot),
        name_(world.space().robot_name(robot)),
        wired_(std::move(wired)),
        body_(world, robot, wired_->body()) {
    const core::RobotGroup& group = group_of(world, robot);
    const core::ControllerConfig& config = world.scenario().controllers[group.config];
    ListedRobot listed(wired_->robot(), config, catalog);
    std::vector<std::pair<hal::PublishedField, const void*>> shown;
    listed.on_show(
        [&](hal::PublishedField field, const void* member) { shown.emplace_back(std::move(field), member); });
    controller_ = std::make_unique<BridgedController>(
        *group.controller, listed, group.params.get(), world.ticks_per_second(), log,
        "controller '" + config.id + "' (library '" + config.library + "') of robot '" + name_ + "'");
    auto* const in_hub = world.space().stores().controller_of(robot);
    for (const auto& [field, member] : shown) {
      for (const hal::PublishedField& known : group.published) {
        if (known.name == field.name) shown_.push_back({member, in_hub + known.offset, hal::size_of(known)});
      }
    }
  }

  core::RobotId robot() const noexcept override { return robot_; }
  void pump(hal::TimeNs) override {
    if (connected_ || !trouble_.empty()) return;
    const hal::Status connected = wired_->connect();
    connected_ = connected.ok();
    if (!connected_) trouble_ = connected.error().message;
  }
  bool ready() const noexcept override { return connected_; }

  /// At once: all of the robot is in this program.
  void ask(core::World& world, hal::TimeNs) override {
    body_.after_sense(world);
    wired_->sense(world.tick());
    threw_ = !controller_->step(why_, world.tick());
    if (!threw_) wired_->act();
    ++ticks_;
  }
  bool answered() const noexcept override { return true; }
  hal::Status write_commands(core::World& world) override {
    if (threw_) {
      world.controller_threw(robot_, why_);
      return {};
    }
    body_.after_filter(world);
    for (const Shown& s : shown_) std::memcpy(s.to, s.from, s.bytes);
    return {};
  }
  std::string trouble() const override { return trouble_.empty() ? "not connected yet" : trouble_; }
  void end(bool, const std::string&) override {}
  mixed_reality::PartnerReport report() const override {
    mixed_reality::PartnerReport report;
    report.robot = name_;
    report.link = "emulated";
    const std::string wrong = wired_->trouble();
    report.state = !connected_ ? trouble() : wrong.empty() ? "in step" : wrong;
    report.ticks = ticks_;
    return report;
  }

 private:
  struct Shown {
    const void* from;
    void* to;  // in the hub's controller, which stands still
    std::size_t bytes;
  };

  core::RobotId robot_;
  std::string name_;
  std::unique_ptr<bridges::WiredRobot> wired_;
  SimulatedBody body_;
  std::unique_ptr<BridgedController> controller_;
  std::vector<Shown> shown_;
  bool connected_ = false, threw_ = false;
  std::string trouble_, why_;
  std::uint64_t ticks_ = 0;
};

}  // namespace

hal::Result<std::unique_ptr<mixed_reality::Partner>> make_wired_peer(const hal::Catalog& catalog, core::World& world,
                                                                     core::RobotId robot, const std::string& what,
                                                                     const hal::Log& log) {
  const core::Scenario& scenario = world.scenario();
  const hal::RobotKind& kind = world.space().kind(robot);
  const auto* const type = catalog.find<bridges::WiredType>(core::bridged_as(scenario, kind.name));
  if (type == nullptr)
    return hal::Error{"no bridge of '" + kind.name + "' can be emulated in lock-step; there are: " +
                      hal::listed(catalog.names(bridges::WiredType::kCategory))};
  const core::RobotGroup& group = group_of(world, robot);
  core::RobotItem item = *group.item;
  item.bridge = core::BridgeConfig{};
  const bridges::BridgeRequest asked = mixed_reality::bridge_request(scenario, item, world.seed());
  bridges::WiredRequest request{world.space().robot_name(robot),
                                asked.robot_kind,
                                what,
                                scenario.file,
                                world.seed(),
                                asked.tick_ns,
                                asked.sensors,
                                asked.actuators,
                                log};
  auto wired = type->make(request);
  if (!wired.ok()) return wired.error();
  try {
    return std::unique_ptr<mixed_reality::Partner>(
        std::make_unique<WiredPeer>(catalog, world, robot, std::move(wired).value(), log));
  } catch (const std::exception& e) {
    return hal::Error{std::string("its controller ") + e.what()};
  }
}

}  // namespace tandem::app
