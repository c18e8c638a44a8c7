// Food items on the floor, the nest, and the balance of energy.
#pragma once
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/hook/hook.hpp"
#include "core/space/space.hpp"
#include "hal/params.hpp"

namespace tandem::hooks {

/// The nest is the western end of the arena, with a grey floor; food items are black discs on the white floor of a
/// rectangle. A robot whose beacon is green takes the item that it stands on, if it has none; the item is gone from the
/// floor then. In the nest it lays its item down: that is counted, and a new one appears at a random place.
///
/// Every item gives energy; every robot outside of the nest costs some each second. Writes a CSV file,
/// `time_s,outside,inside,bringing,collected,energy_J`, a line every `every` seconds.
class Foraging final : public core::Hook {
 public:
  struct Params {
    std::int64_t items = 15;
    double radius_m = 0.1;
    double nest_x_m = -1.5;
    std::array<double, 3> food_min_m = {-0.8, -1.8, 0.0};
    std::array<double, 3> food_max_m = {2.2, 1.8, 0.0};
    double energy_per_item_J = 1000.0;
    double power_outside_W = 1.0;
    double every_s = 10.0;
    std::string output;
    void describe(hal::ParamVisitor& v) {
      v.integer("items", items, {1, 10000}, "Food items on the floor or with robots.");
      v.number("radius", radius_m, hal::unit::m, {0.01, 1.0}, "Of an item on the floor.");
      v.number("nest", nest_x_m, hal::unit::m, hal::kAny, "The nest is where x is less.");
      v.vector("food_min", food_min_m, hal::unit::m, "South-western corner of the rectangle that has food.");
      v.vector("food_max", food_max_m, hal::unit::m, "Its north-eastern corner.");
      v.number("energy_per_item", energy_per_item_J, hal::unit::none, hal::kNotNegative, "That an item gives, in J.");
      v.number("power_outside", power_outside_W, hal::unit::none, hal::kNotNegative,
               "That a robot outside of the nest costs, in W.");
      v.number("every", every_s, hal::unit::s, {0.01, 1e6}, "Time between lines of the file.");
      v.text("output", output, "CSV file to write at the end; empty: none.");
    }
  };

  explicit Foraging(const Params& params) : params_(params) {}

  void before_run(core::HookContext& context) override;
  void after_step(core::HookContext& context) override;
  /// @throws std::runtime_error when the file cannot be written
  void after_run(core::HookContext& context) override;
  std::optional<double> floor(double x_m, double y_m) override;
  /// The size of food items, and a button that puts those on the floor elsewhere.
  void controls(core::HookContext& context, hal::Controls& controls) override;
  bool remember(hal::Archive& a) override {
    a(state_.items, state_.collected, state_.robot_ticks_outside, state_.chance, state_.lines);
    return true;
  }

 private:
  struct Item {
    double x_m = 0.0, y_m = 0.0;
    core::RobotId bearer{};
    bool taken = false;
  };
  struct Line {
    double time_s = 0.0;
    std::size_t outside = 0, inside = 0, bringing = 0, collected = 0;
    double energy_J = 0.0;
  };
  struct State {
    std::vector<Item> items;
    std::size_t collected = 0;
    std::int64_t robot_ticks_outside = 0;
    std::mt19937_64 chance;
    std::vector<Line> lines;
  };

  void appear(Item& item);
  void treat(core::Space& space, core::RobotId robot);
  Item* item_of(core::RobotId robot) noexcept;

  Params params_;
  State state_;
};

}  // namespace tandem::hooks
