// One reading of two: the real robot's, and its twin's among the simulated robots.
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "core/space/space.hpp"
#include "hal/port.hpp"

namespace tandem::mixed_reality {

/// The real robot's newest reading of a port class, or null when it has no such device. Compared by name, role and
/// layout.
using RealReadings = std::function<const void*(const hal::PortType&)>;

/// Fuses the sensor ports of one robot, each field as its description says: proximity takes the nearer, messages are
/// joined, the floor is the virtual one. What the real robot cannot measure and the virtual one may not replace becomes
/// absent.
class PortFusion {
 public:
  /// Finds the ports that the controller of `robot` took, and the real devices behind them. The space's ports and what
  /// `real` returns must outlive this.
  PortFusion(core::Space& space, core::RobotId robot, const RealReadings& real);
  /// From now on other devices are behind the ports: another robot took over.
  void take_from(const RealReadings& real);

  /// Copies what the real devices say now. Entries of lists that are not in use are as in a fresh port.
  void latch() noexcept;
  /// To be called when the space's ports hold the virtual readings: they then hold those fused with the latched ones.
  /// Allocates nothing.
  void fuse() noexcept;

  /// The latched readings, by number; one without a device is absent. They stay where they are.
  std::size_t size() const noexcept { return pairs_.size(); }
  const hal::PortType& type(std::size_t i) const noexcept { return *pairs_[i].type; }
  void* reading(std::size_t i) noexcept { return readings_.get() + pairs_[i].at; }
  const void* reading(std::size_t i) const noexcept { return readings_.get() + pairs_[i].at; }
  /// A reading that the controller asked for, that the real robot has a device for, and that never came; null: all did.
  /// Not meant are devices that the virtual ones may stand in for, and a scanner: it measures only when told to.
  const hal::PortType* missing() const noexcept;

 private:
  struct Pair {
    const hal::PortType* type;
    void* port;        // in the space
    const void* real;  // null: no such device
    bool needed;
    std::size_t at;  // its reading in `readings_`
  };
  struct List {  // a field of which only so many entries are in use
    std::size_t pair;
    const hal::Field* field;
    hal::UsedBy used;
  };
  std::vector<Pair> pairs_;
  std::vector<List> lists_;
  std::unique_ptr<std::max_align_t[]> readings_;  // as latched
  std::unique_ptr<std::max_align_t[]> scratch_;   // one port, the largest
};

}  // namespace tandem::mixed_reality
