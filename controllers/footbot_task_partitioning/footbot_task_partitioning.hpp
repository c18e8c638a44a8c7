// Foraging by task partitioning: foot-bots carry objects towards the nest, each only so far as its odometry is good.
#pragma once
#include "controllers/grasping/grasp.hpp"
#include "controllers/steering/nearby.hpp"
#include "hal/controller.hpp"
#include "hal/device/leds.hpp"
#include "hal/random.hpp"

namespace tandem::controllers {

/// A robot that knows nothing explores. It grips the object that it finds, remembers where that was, carries it towards
/// the light at the nest, and drops it after a limited distance, or in the nest, whose floor is dark. Then it goes back
/// to where it gripped, by its odometry alone, searches around there, and explores again when there is nothing: its
/// estimate was too bad, or another robot was faster. What one drops others find; together they bring it home. The idea
/// is that of Pini et al. (2012), as described by Pinciroli et al. (2012), section 4.2.2: odometry errors grow with the
/// distance covered.
class FootbotTaskPartitioning final : public hal::Controller {
 public:
  struct Params {
    double carry_m = 2.0;
    double search_m = 0.5;
    double search_s = 60.0;
    double velocity_m_s = 0.1;
    double broadest_m = 0.13;
    double dark = 0.25;
    void describe(hal::ParamVisitor& v) {
      v.number("carry", carry_m, hal::unit::m, {0.1, 1000.0},
               "Farthest that one robot carries an object at a time, by its odometry. Large: all the way home.");
      v.number("search_radius", search_m, hal::unit::m, {0.1, 10.0},
               "How far around the remembered place it searches.");
      v.number("search_time", search_s, hal::unit::s, hal::kNotNegative, "How long, before it explores again.");
      v.number("velocity", velocity_m_s, hal::unit::cm_s, {0.01, 0.3}, "Wheel speed.");
      v.number("broadest", broadest_m, hal::unit::m, {0.01, 1.0}, "What looks broader is a wall and no object.");
      v.number("dark", dark, hal::unit::none, {0.0, 1.0}, "The nest's floor reflects less than this.");
    }
  };

  FootbotTaskPartitioning(hal::Robot& robot, const Params& params);

  void step() noexcept override;

 private:
  /// Explore: anywhere. Return: to the remembered place. Search: around there. Grasp: an object. Turn: away from what
  /// was in the way. Carry: to the nest. Release: drop it and back off.
  enum class State : std::uint8_t { Explore, Return, Search, Grasp, Turn, Carry, Release };

  void explore() noexcept;
  void go_back() noexcept;
  void search() noexcept;
  void grasp() noexcept;
  void turn() noexcept;
  void carry() noexcept;
  void release() noexcept;

  void enter(State state) noexcept;
  void turn_away(double bearing_rad, State then) noexcept;
  bool found_something(State after) noexcept;
  bool avoid_robots() noexcept;
  bool fresh() const noexcept;
  double in_state_s() const noexcept { return static_cast<double>(clock_.now_ns - since_ns_) * 1e-9; }
  double distance_to(const hal::Vector2& place) const noexcept;
  double bearing_to(const hal::Vector2& place) const noexcept;

  const hal::Proximity& proximity_;
  const hal::Light& light_;
  const hal::MotorGround& ground_;
  const hal::Odometry& odometry_;
  const hal::RangeAndBearing& heard_;
  const hal::Clock& clock_;
  hal::WheelSpeeds& wheels_;
  hal::RangeAndBearingSend& send_;
  hal::RingLeds& leds_;
  std::span<const hal::Mount> proximity_mounts_;
  std::span<const hal::Mount> light_mounts_;
  Params params_;
  Grasp grasp_;
  hal::Random random_;

  State state_ = State::Explore;
  State after_ = State::Explore;  // Grasp and Turn: what comes when there was nothing to grip
  hal::TimeNs since_ns_ = 0;      // start of the state
  hal::TimeNs leg_until_ns_ = 0;  // Explore, Search: end of the straight part
  double goal_heading_rad_ = 0.0;
  bool turned_ = false;  // Turn: now straight on
  hal::TimeNs return_until_ns_ = 0;
  bool knows_place_ = false;
  hal::TimeNs search_until_ns_ = 0;
  hal::Vector2 place_ = hal::Vector2::Zero();     // where it gripped last, as odometry had it
  hal::Vector2 waypoint_ = hal::Vector2::Zero();  // Search: where to look next
};

}  // namespace tandem::controllers
