// A world of Tandem behind the interface that ARGoS' simulator classes call.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "compat/argos3/simulator/world_door.hpp"
#include "core/hook/hook.hpp"

namespace tandem::compat::argos3 {

class WorldAdapter final : public WorldDoor {
 public:
  /// Phases of a tick that hooks see: before sensors look, after controllers, and others, in which nothing has moved.
  enum class Phase : std::uint8_t { Sense, Stepped, Other };
  /// Takes the world from a hook's context; `clock` ticks have begun. @returns whether the phase has just begun
  bool look(core::HookContext& context, std::uint32_t clock, Phase phase);
  /// Whether it looks at this space, or at none yet.
  bool may_be(const core::Space& space) const noexcept { return space_ == nullptr || space_ == &space; }
  /// Whether a run begins: with a new world, or with the entities from before its reset.
  enum class Begins : std::uint8_t { Afresh, Again, Goes };
  Begins begins() noexcept { return std::exchange(begins_, Begins::Goes); }
  void begin_afresh() noexcept { begins_ = Begins::Afresh; }
  void begin_again() noexcept {
    if (begins_ == Begins::Goes) begins_ = Begins::Again;
  }

  std::uint32_t clock() const override { return clock_; }
  double ticks_per_second() const override { return ticks_per_second_; }
  std::uint64_t seed() const override { return seed_; }
  bool repeats() const override;
  std::uint32_t longest() const override;
  std::uint32_t threads() const override;
  std::unique_ptr<ticpp::Element> experiment() const override;
  void reset(std::uint64_t seed) override;
  void warn(const std::string& text) override;
  Point arena_center() const override;
  Point arena_size() const override;

  std::vector<Named> robots() const override;
  std::vector<Named> objects() const override;
  Body find_robot(const std::string& id) const override;
  Body find_object(const std::string& id) const override;
  bool there(const Body& body) const override;
  std::string id_in_world(const Body& robot) const override;
  Place place(const Body& body) const override;
  Form form(const Body& body) const override;
  void put(const Body& body, const Place& place) override;
  std::string room(const Body& body, const Place& place) const override;
  std::string add_robot(const Named& robot, const Place& place, Body& added) override;
  std::string add_object(const std::string& id, const Form& form, const Place& place, const std::vector<Led>& leds,
                         Body& added) override;
  std::string change(const Body& object, const Form& form) override;
  void remove(const Body& body) override;
  void halt(const Body& robot, bool halted) override;

  std::vector<Led> leds(const Body& body) const override;
  bool set_led(const Body& body, std::size_t number, Rgb8 color) override;
  double battery(const Body& robot) const override;
  std::string set_battery(const Body& robot, double charge) override;
  double turret_rad(const Body& robot) const override;
  std::vector<std::uint8_t> message(const Body& robot) const override;
  bool set_message(const Body& robot, const std::vector<std::uint8_t>& bytes) override;
  double rab_range_m(const Body& robot) const override;
  std::size_t rab_bytes(const Body& robot) const override;
  double wheel_base_m(const Body& robot) const override;
  std::array<double, 2> wheels_m_s(const Body& robot) const override;
  bool set_wheels_m_s(const Body& robot, const std::array<double, 2>& speeds) override;

  std::vector<std::pair<std::size_t, Lamp>> lamps() const override;
  std::string add_lamp(const Lamp& lamp, std::size_t& number) override;
  void set_lamp(std::size_t number, const Lamp& lamp) override;
  void remove_lamp(std::size_t number) override;
  double floor(double x_m, double y_m) const override;
  void repaint_floor() override;

  void draw_line(const std::vector<Point>& points, const Ink& ink) override;
  void draw_polygon(const std::vector<Point>& corners, const Ink& ink) override;
  void draw_circle(const Point& center, double radius_m, const Ink& ink) override;
  void draw_text(const Point& at, const std::string& text, const Ink& ink) override;

 private:
  core::Space* space_ = nullptr;
  core::Checkpoints* checkpoints_ = nullptr;
  double ticks_per_second_ = 10.0;
  std::uint64_t seed_ = 0;
  const core::Scenario* scenario_ = nullptr;
  std::uint32_t clock_ = 0;
  Phase phase_ = Phase::Other;
  Begins begins_ = Begins::Afresh;
};

}  // namespace tandem::compat::argos3
