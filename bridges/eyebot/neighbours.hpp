// Other hubs and other robots that are heard on the network: to name them where a robot is missing or is not ours.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>

#include "hal/time.hpp"

namespace tandem::bridges::eyebot {

/// Filled by the thread that receives, read by the one that drives. Thread-safe. Names of robots and hubs come from the
/// network: at most `kMost` of each are kept, the first ones.
class Neighbours {
 public:
  static constexpr std::size_t kMost = 32;

  /// A robot's heartbeat was heard on the channel of that name.
  void hear_robot(std::string_view name);
  /// A hub's heartbeat.
  void hear_hub(std::string_view name, std::int32_t session);
  /// A command to our robot that is not ours.
  void hear_command(std::int32_t session, hal::TimeNs received_ns) noexcept;

  /// When another hub commanded our robot last; 0: never.
  hal::TimeNs commanded_ns() const noexcept { return commanded_ns_.load(std::memory_order_relaxed); }
  /// Which one, for people: "another hub, 'lab2'," or "another hub".
  std::string commander() const { return hub_of(commander_.load(std::memory_order_relaxed)); }
  std::string hub_of(std::int32_t session) const;
  /// "eb0, eb1"; "" when there are none.
  std::string robots() const;

 private:
  struct Hub {
    std::string name;
    std::int32_t session = 0;
  };

  mutable std::mutex mutex_;
  std::array<std::string, kMost> robots_;
  std::size_t robot_count_ = 0;
  std::array<Hub, kMost> hubs_;
  std::size_t hub_count_ = 0;
  std::atomic<std::int32_t> commander_{0};
  std::atomic<hal::TimeNs> commanded_ns_{0};
};

}  // namespace tandem::bridges::eyebot
