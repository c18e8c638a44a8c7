// Two links joined in memory: what one end writes the other reads.
#pragma once
#include <memory>
#include <utility>

#include "bridges/link/link.hpp"

namespace tandem::bridges {

class MemoryPipe;

/// One end of a pair. The ends may live on two threads. Bytes carry the clock's time at which they were written. When
/// one end is destroyed or `hang_up` is called, both are HungUp; what was already written can still be read.
class MemoryLink final : public ByteLink {
 public:
  /// `capacity` bytes can be on their way in each direction; `write` takes no more and never waits.
  static std::pair<std::unique_ptr<MemoryLink>, std::unique_ptr<MemoryLink>> make_pair(Clock clock = monotonic_ns,
                                                                                       std::size_t capacity = 65536);
  ~MemoryLink() override;

  std::size_t write(std::span<const std::uint8_t> bytes, hal::TimeNs budget_ns) noexcept override;
  Received read(std::span<std::uint8_t> buffer) noexcept override;
  /// Waits in real time, whatever the clock.
  bool wait(hal::TimeNs timeout_ns) noexcept override;
  LinkState state() const noexcept override;
  LinkStatistics statistics() const noexcept override;
  std::string name() const override { return "memory"; }

  void hang_up() noexcept;

 private:
  MemoryLink(std::shared_ptr<MemoryPipe> pipe, int side) : pipe_(std::move(pipe)), side_(side) {}

  std::shared_ptr<MemoryPipe> pipe_;  // shared: neither end can know which of them goes last
  int side_;
};

}  // namespace tandem::bridges
