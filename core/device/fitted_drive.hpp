// Wheels as they were measured on real robots: scale, wheel base, noise, and the delay of commands.
#pragma once
#include <array>

#include "core/device/device.hpp"
#include "hal/device/fitted.hpp"

namespace tandem::core {

/// What simulated wheels work by, and the commands that have not reached them yet.
struct DriveState {
  static constexpr std::string_view kName = "fitted_wheels";
  static constexpr std::string_view kDoc = "By which wheels roll, and the commands of the last ticks.";
  static constexpr std::size_t kLine = 32;
  bool known = false;  ///< the values were looked up or drawn
  double left = 1.0, right = 1.0, base = 1.0, counted_left = 1.0, counted_right = 1.0, noise_sqrt_m = 0.0;
  double delay_ticks = 0.0;
  std::uint32_t newest = 0;                                     ///< of the next two
  std::array<double, kLine> told_left_m_s{}, told_right_m_s{};  ///< rings

  void describe(hal::FieldList& f) const {
    f.add("known", known, hal::unit::none, "the values were looked up or drawn");
    f.add("left", left, hal::unit::none, "way of the left wheel, of that commanded");
    f.add("right", right, hal::unit::none, "way of the right wheel, of that commanded");
    f.add("base", base, hal::unit::none, "wheel base, of that of the kind");
    f.add("counted_left", counted_left, hal::unit::none, "by the left encoder, of the way commanded");
    f.add("counted_right", counted_right, hal::unit::none, "by the right encoder, of the way commanded");
    f.add("noise", noise_sqrt_m, hal::unit::none, "after 1 m, in m");
    f.add("delay", delay_ticks, hal::unit::none, "in ticks");
    f.add("newest", newest, hal::unit::none, "place of the newest command in the rings");
    f.add("told_left", told_left_m_s, hal::unit::m_s, "a ring");
    f.add("told_right", told_right_m_s, hal::unit::m_s, "a ring");
  }
};

/// Turns commands of one block into what the wheels then do.
class FittedDrive {
 public:
  FittedDrive(const hal::FittedWheels& part, const BlockColumns& columns);

  /// What robot `i` of the block is told in this tick. To be called in every tick, also while it does not obey.
  void tell(const DeviceContext& context, std::size_t i, double left_m_s, double right_m_s) noexcept;
  /// What its wheels do then, in W, and what encoders do not see of it.
  void drive(const DeviceContext& context, std::size_t i, double& left_m_s, double& right_m_s) noexcept;
  /// It stands.
  void stand(std::size_t i) noexcept;

  static std::vector<KeptColumn> columns() { return {keeps<DriveState>(), keeps<HiddenRoll>()}; }
  /// Empty, or why a delay cannot be simulated.
  static std::string flaw(const hal::FittedWheels& part, double tick_s);

 private:
  const hal::FittedWheels& part_;  // of the kind, which lives as long as the world
  DriveState* states_;
  HiddenRoll* hidden_;
};

}  // namespace tandem::core
