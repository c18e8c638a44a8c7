// A network and some nodes on a bus in memory, with a clock turned by hand.
#pragma once
#include <functional>
#include <memory>
#include <vector>

#include "bridges/aseba/can_messages.hpp"
#include "bridges/aseba/network.hpp"
#include "tests/bridges/aseba/fake_node.hpp"
#include "tests/bridges/can/faulty_can_link.hpp"
#include "tests/bridges/can/memory_bus.hpp"

namespace tandem::bridges::aseba {

/// Not a fixture: tests make as many as they like.
struct RobotOnBus {
  explicit RobotOnBus(const CanFaults& faults = {})
      : bus([this] { return now; }, 4096),
        link(attach(faults), {}, [this] { return now; }),
        network(link, {}, hal::Log([this](hal::Severity, std::string_view text) { said.emplace_back(text); })) {}

  std::unique_ptr<CanLink> attach(const CanFaults& faults) {
    const bool any = faults.loss + faults.doubling + faults.reordering + faults.lateness + faults.bus_off > 0.0;
    if (!any) return bus.attach();
    return std::make_unique<FaultyCanLink>(bus.attach(), faults, [this] { return now; });
  }
  FakeNode& add(std::uint8_t id, const std::string& name, std::vector<std::pair<std::string, int>> variables) {
    nodes.push_back(std::make_unique<FakeNode>(bus.attach(), id, name, std::move(variables)));
    return *nodes.back();
  }
  FakeNode& add_motor(std::uint8_t id = 1, const std::string& name = "left motor") {
    return add(id, name, {{"id", 1}, {"source", 1}, {"args", 32}, {"speed", 1}, {"odo", 2}});
  }
  /// Time in steps of a millisecond.
  void pass(hal::TimeNs time) {
    for (const hal::TimeNs end = now + time; now < end;) {
      now += hal::kNsPerMs;
      network.poll(now);
      for (const auto& node : nodes) node->work();
    }
  }
  /// Passes time until it holds. False: not within `longest`.
  bool pass_until(const std::function<bool()>& holds, hal::TimeNs longest = hal::kNsPerSecond) {
    for (const hal::TimeNs end = now + longest; now < end;) {
      if (holds()) return true;
      pass(hal::kNsPerMs);
    }
    return holds();
  }
  bool pass_until_ready(std::uint8_t id, hal::TimeNs longest = hal::kNsPerSecond) {
    return pass_until([this, id] { return network.node(id).ready(); }, longest);
  }

  hal::TimeNs now = 1000 * hal::kNsPerMs;
  MemoryBus bus;
  CanMessages link;
  std::vector<std::string> said;
  Network network;
  std::vector<std::unique_ptr<FakeNode>> nodes;
};

}  // namespace tandem::bridges::aseba
