// Shutdown sequence of a flight: hover, then land. Shared by a hub that ends and by the guardian of one that was
// killed.
#pragma once
#include "bridges/eyebot/driver.hpp"

namespace tandem::bridges::eyebot {

struct ShutdownSettings {
  bool land = true;                              ///< else it is left hovering, and lands by itself after 10 s
  hal::TimeNs find_ns = 0;                       ///< how long a robot is waited for that was not heard of yet
  hal::TimeNs hover_ns = 2 * hal::kNsPerSecond;  ///< how long it may take to say that it hovers
  hal::TimeNs land_ns = 30 * hal::kNsPerSecond;  ///< and that it has landed
};

/// One robot's. Not thread-safe.
class ShutdownSequence {
 public:
  explicit ShutdownSequence(const ShutdownSettings& settings) : settings_(settings) {}

  /// Pumps the driver, and takes the next step when one is done. True when there is nothing left to do, or to wait for.
  bool step(EyebotDriver& driver, hal::TimeNs now) noexcept;

 private:
  enum class Stage : std::uint8_t { Begin, Hover, Land, End };

  ShutdownSettings settings_;
  Stage stage_ = Stage::Begin;
  hal::TimeNs begun_ns_ = 0;
  hal::TimeNs since_ns_ = 0;
};

}  // namespace tandem::bridges::eyebot
