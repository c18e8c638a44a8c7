// A simulated world in real time that gives an emulated firmware its body.
#pragma once
#include <atomic>
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <thread>

#include "app/real/simulated_body.hpp"
#include "app/run/time_parts.hpp"
#include "core/run/run.hpp"
#include "core/sim/world.hpp"

namespace tandem::app {

/// Steps the world on its own thread until `stop`, or until its end; one of its robots is the body behind `ports`.
class RealTimeWorld {
 public:
  RealTimeWorld(std::unique_ptr<core::World> world, core::RobotId robot, bridges::SharedPorts& ports,
                const std::atomic<bool>& stop)
      : world_(std::move(world)), body_link_(*world_, robot, ports) {
    world_->set_external(&body_link_);
    thread_ = std::thread([this, &stop] { live(stop); });
  }
  ~RealTimeWorld() { thread_.join(); }
  RealTimeWorld(const RealTimeWorld&) = delete;
  RealTimeWorld& operator=(const RealTimeWorld&) = delete;

 private:
  void live(const std::atomic<bool>& stop) {
    mixed_reality::MonotonicTime clock;
    mixed_reality::Pacer pacer(clock, world_->ticks_per_second());
    core::Run run(*world_, stop);
    run.add(std::make_unique<core::Length>(0));
    run.add(pace_part(pacer));
    (void)run.go();
    if (!world_->failure().empty()) fmt::print(stderr, "error: the arena stands still: {}\n", world_->failure());
  }

  std::unique_ptr<core::World> world_;
  SimulatedBody body_link_;
  std::thread thread_;
};

}  // namespace tandem::app
