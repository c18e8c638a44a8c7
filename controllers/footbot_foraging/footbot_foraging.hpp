// Foraging for items on the floor: out, home, rest.
#pragma once
#include <span>

#include "hal/controller.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "hal/random.hpp"
#include "hal/vector2.hpp"

namespace tandem::controllers {

/// Walks at random, away from the light at first, until the sensors between its tracks see a black food item, or the
/// search has lasted too long; then towards the light until they see the nest's grey floor. It lays the item down and
/// rests. Each second of rest it leaves with a probability that success raises and failure lowers: so as many robots
/// go out as there is food for, as in Liu et al. (2007), "Towards energy optimization: emergent task allocation in a
/// swarm of foraging robots", Adaptive Behavior 15(3).
///
/// Its beacon shows what it does: green while it brings an item, blue while it searches, off in the nest.
class FootbotForaging final : public hal::Controller {
 public:
  struct Params {
    double leave = 0.1;
    double more = 0.02;
    double less = 0.02;
    double least = 0.005;
    double search_s = 90.0;
    double velocity_m_s = 0.1;
    void describe(hal::ParamVisitor& v) {
      v.number("leave", leave, hal::unit::none, {0.0, 1.0}, "Probability of leaving the nest, a second, at the start.");
      v.number("more", more, hal::unit::none, {0.0, 1.0}, "Added to it when the robot comes home with an item.");
      v.number("less", less, hal::unit::none, {0.0, 1.0}, "Taken from it when the robot comes home without.");
      v.number("least", least, hal::unit::none, {0.0, 1.0}, "It never falls below this.");
      v.number("search_time", search_s, hal::unit::s, {1.0, 1e6}, "Without food after this, it goes home.");
      v.number("velocity", velocity_m_s, hal::unit::cm_s, {0.01, 0.3}, "Wheel speed.");
    }
  };

  FootbotForaging(hal::Robot& robot, const Params& params);

  void step() noexcept override;

 private:
  enum class State : std::uint8_t { Rest, Search, Bring, GiveUp };

  void rest() noexcept;
  void search() noexcept;
  void go_home() noexcept;
  void enter(State state) noexcept;
  void walk(const hal::Vector2& way) noexcept;
  bool all_see(float low, float high) const noexcept;
  double in_state_s() const noexcept { return static_cast<double>(clock_.now_ns - since_ns_) * 1e-9; }

  const hal::Proximity& proximity_;
  const hal::Light& light_;
  const hal::MotorGround& ground_;
  const hal::Clock& clock_;
  hal::WheelSpeeds& wheels_;
  hal::RingLeds& leds_;
  std::span<const hal::Mount> proximity_mounts_;
  std::span<const hal::Mount> light_mounts_;
  std::size_t beacon_;
  Params params_;
  hal::Random random_;
  State state_ = State::Rest;
  hal::TimeNs since_ns_ = 0;
  hal::TimeNs inside_ns_ = -1;  // when it came into the nest; -1: it is outside
  double drift_rad_ = 0.0;      // Search: of a random walk's course
};

}  // namespace tandem::controllers
