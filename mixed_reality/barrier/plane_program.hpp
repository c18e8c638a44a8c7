// The point nearest to a wanted one of those that satisfy linear bounds: a quadratic program in two variables.
#pragma once
#include <array>
#include <cstddef>

namespace tandem::mixed_reality {

/// Bounds a . x <= b with |a| = 1 and b >= 0, so that 0 satisfies them all.
class PlaneProgram {
 public:
  static constexpr std::size_t kMost = 32;

  void clear() noexcept {
    count_ = 0;
    full_ = false;
  }
  /// Where there is no room for it, 0 is the answer.
  void add(double a_x, double a_y, double b) noexcept;

  /// By enumeration: the wanted point itself, its feet on each bound, and where two bounds meet.
  std::array<double, 2> nearest(double x, double y) const noexcept;

 private:
  struct Bound {
    double a_x, a_y, b;
  };
  bool allows(double x, double y) const noexcept;

  std::array<Bound, kMost> bounds_{};
  std::size_t count_ = 0;
  bool full_ = false;
};

}  // namespace tandem::mixed_reality
