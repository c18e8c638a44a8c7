// Places that a robot can have come to: one that is too far from the last one for the time between is not believed.
#pragma once
#include <cstdint>

#include "bridges/eyebot/world_frame.hpp"
#include "hal/time.hpp"

namespace tandem::bridges::eyebot {

/// The first place is believed. Others must lie within what a robot flies at `fastest_m_s`, and `kSlack_m` for the
/// noise of its positioning. When places elsewhere agree with one another for `kLasting`, the positioning has begun
/// again there: they are believed from then on, and the jump is counted. Not thread-safe.
class PlaceGate {
 public:
  static constexpr double kSlack_m = 0.25;
  static constexpr hal::TimeNs kLasting = 500 * hal::kNsPerMs;

  explicit PlaceGate(double fastest_m_s) : fastest_m_s_(fastest_m_s) {}

  /// Whether `place`, measured at `taken_ns`, is believed.
  bool take(const Vector& place, hal::TimeNs taken_ns) noexcept;
  /// Of another start of the robot: the next place is the first.
  void forget() noexcept { known_ = odd_ = false; }

  bool known() const noexcept { return known_; }
  std::uint64_t refused() const noexcept { return refused_; }
  std::uint64_t jumps() const noexcept { return jumps_; }

 private:
  struct Sight {
    Vector place{};
    hal::TimeNs taken_ns = 0;
  };
  bool within_reach(const Sight& from, const Vector& place, hal::TimeNs taken_ns) const noexcept;

  double fastest_m_s_;
  bool known_ = false, odd_ = false;
  Sight last_;       // believed
  Sight elsewhere_;  // not believed yet, while `odd_`
  hal::TimeNs odd_since_ns_ = 0;
  std::uint64_t refused_ = 0, jumps_ = 0;
};

}  // namespace tandem::bridges::eyebot
