// Interface between ARGoS' simulator classes and the world that runs: plain data, no headers of Tandem.
#pragma once
#include <argos3/core/simulator/entity/embodied_entity.h>
#include <argos3/core/utility/configuration/argos_configuration.h>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace tandem::compat::argos3 {

using Body = argos::CEmbodiedEntity::SBody;

/// Of the middle of a body's base, in W; the turn as a quaternion.
struct Place {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
};

struct Form {
  bool box = false, movable = true;
  double half_x_m = 0.0, half_y_m = 0.0;  ///< of a box
  double radius_m = 0.0;                  ///< of anything else
  double height_m = 0.0, mass_kg = 1.0;
};

struct Rgb8 {
  std::uint8_t r = 0, g = 0, b = 0;
};

/// An LED; its place is in the frame of its body, from the middle of the base.
struct Led {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  Rgb8 color;
};

struct Lamp {
  std::string id;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, intensity = 1.0;
  Rgb8 color;
};

struct Ink {
  Rgb8 color;
  double width_m = 0.0;
  bool filled = false;
  double opacity = 1.0;
};
using Point = std::array<double, 3>;

/// A text that a function returns is the reason for which it did nothing; empty: done.
class WorldDoor {
 public:
  struct Named {
    Body body;
    std::string id, kind, controller;  ///< kind: of a robot, or "box", "cylinder"
  };
  virtual ~WorldDoor() = default;

  // --- the run ---
  virtual std::uint32_t clock() const = 0;
  virtual double ticks_per_second() const = 0;
  virtual std::uint64_t seed() const = 0;
  virtual bool repeats() const = 0;           ///< the experiment has a seed of its own
  virtual std::uint32_t longest() const = 0;  ///< in ticks; 0: endless
  virtual std::uint32_t threads() const = 0;
  /// The root of the experiment, with all that was set beside its file.
  virtual std::unique_ptr<ticpp::Element> experiment() const = 0;
  virtual void reset(std::uint64_t seed) = 0;  ///< when the tick is over
  virtual void warn(const std::string& text) = 0;
  virtual Point arena_center() const = 0;
  virtual Point arena_size() const = 0;

  // --- bodies ---
  virtual std::vector<Named> robots() const = 0;
  virtual std::vector<Named> objects() const = 0;
  virtual Body find_robot(const std::string& id) const = 0;
  virtual Body find_object(const std::string& id) const = 0;
  virtual bool there(const Body& body) const = 0;
  virtual std::string id_in_world(const Body& robot) const = 0;
  virtual Place place(const Body& body) const = 0;
  virtual Form form(const Body& body) const = 0;
  virtual void put(const Body& body, const Place& place) = 0;
  virtual std::string room(const Body& body, const Place& place) const = 0;
  virtual std::string add_robot(const Named& robot, const Place& place, Body& added) = 0;
  virtual std::string add_object(const std::string& id, const Form& form, const Place& place,
                                 const std::vector<Led>& leds, Body& added) = 0;
  virtual std::string change(const Body& object, const Form& form) = 0;
  virtual void remove(const Body& body) = 0;
  virtual void halt(const Body& robot, bool halted) = 0;

  // --- devices of robots, LEDs of objects ---
  virtual std::vector<Led> leds(const Body& body) const = 0;
  virtual bool set_led(const Body& body, std::size_t number, Rgb8 color) = 0;
  virtual double battery(const Body& robot) const = 0;  ///< 0 to 1
  virtual std::string set_battery(const Body& robot, double charge) = 0;
  virtual double turret_rad(const Body& robot) const = 0;
  virtual std::vector<std::uint8_t> message(const Body& robot) const = 0;
  virtual bool set_message(const Body& robot, const std::vector<std::uint8_t>& bytes) = 0;
  virtual double rab_range_m(const Body& robot) const = 0;
  virtual std::size_t rab_bytes(const Body& robot) const = 0;
  virtual double wheel_base_m(const Body& robot) const = 0;
  virtual std::array<double, 2> wheels_m_s(const Body& robot) const = 0;
  virtual bool set_wheels_m_s(const Body& robot, const std::array<double, 2>& speeds) = 0;

  // --- lamps, the floor ---
  virtual std::vector<std::pair<std::size_t, Lamp>> lamps() const = 0;  ///< with their numbers
  virtual std::string add_lamp(const Lamp& lamp, std::size_t& number) = 0;
  virtual void set_lamp(std::size_t number, const Lamp& lamp) = 0;
  virtual void remove_lamp(std::size_t number) = 0;
  virtual double floor(double x_m, double y_m) const = 0;
  virtual void repaint_floor() = 0;

  // --- drawings, in W ---
  virtual void draw_line(const std::vector<Point>& points, const Ink& ink) = 0;
  virtual void draw_polygon(const std::vector<Point>& corners, const Ink& ink) = 0;
  virtual void draw_circle(const Point& center, double radius_m, const Ink& ink) = 0;
  virtual void draw_text(const Point& at, const std::string& text, const Ink& ink) = 0;
};

}  // namespace tandem::compat::argos3
