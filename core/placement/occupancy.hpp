// Space already taken in the arena: answers whether something new would overlap it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace tandem::core {

/// A box or cylinder anywhere in space.
struct Solid {
  using Vector = std::array<double, 3>;
  std::array<Vector, 3> axes{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};  ///< its own, in W
  Vector middle_m{};
  Vector half_m{};     ///< of a cylinder: radius, radius, half the height
  bool round = false;  ///< a cylinder about its third axis
};

/// Half the extent along a unit vector of W.
double half_extent(const Solid& s, const Solid::Vector& along) noexcept;

/// A disc, or a rectangle with a heading.
struct Obstacle {
  double x_m = 0.0, y_m = 0.0;
  double radius_m = 0.0;  ///< of the disc, or of the circle around the rectangle
  bool is_box = false;
  double half_x_m = 0.0, half_y_m = 0.0;
  double cos_h = 1.0, sin_h = 0.0;
  double z_low_m = 0.0, z_high_m = 0.0;
  bool is_robot = false;
  bool flies = false;
  const Solid* leans = nullptr;  ///< not null: a tilted body, of which the rest holds the bounds; outlives this
  std::uint32_t item = 0;        ///< of Scenario::robots or objects
};

Obstacle disc_at(double x_m, double y_m, double radius_m) noexcept;
Obstacle box_at(double x_m, double y_m, double size_x_m, double size_y_m, double yaw_rad) noexcept;

/// The bounds of a tilted body.
Obstacle bounds_of(const Solid& leans) noexcept;

/// Whether the two share space; touching is not overlapping. Robots that do not fly are kept out of everything above
/// and below upright objects: engines of the plane know no heights. Where tilted bodies are involved, shapes are
/// compared in space; next to edges of cylinders this may find an overlap where a small gap is.
bool overlap(const Obstacle& a, const Obstacle& b) noexcept;

/// Obstacles by cell of grids of doubling cell size: each is listed in the finest grid that needs few cells for it, so
/// that neither a crowd of small things nor one huge thing is slow.
class Occupancy {
 public:
  using Filter = std::function<bool(const Obstacle&)>;

  /// `cell_m`: about the diameter of the most frequent obstacle.
  explicit Occupancy(double cell_m);

  void reserve(std::size_t n);
  void add(const Obstacle& o);
  /// Some obstacle that `o` overlaps, or null. Valid until the next `add`.
  const Obstacle* hit(const Obstacle& o) const;
  /// The same among those for which `counts(obstacle)` is true.
  const Obstacle* hit(const Obstacle& o, const Filter& counts) const;

 private:
  static constexpr std::size_t kLevels = 48;
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  struct Link {
    std::uint32_t obstacle;
    std::uint32_t next;
  };
  struct Cells {
    std::int64_t x0, y0, x1, y1;
    double count() const noexcept { return static_cast<double>(x1 - x0 + 1) * static_cast<double>(y1 - y0 + 1); }
  };
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t head = kNone;  // kNone: the slot is free
  };
  struct Level {
    double per_cell = 1.0;
    std::vector<std::uint32_t> members;
    std::vector<Slot> table;  // open addressing; a power of two
    std::size_t used = 0;
    std::vector<Link> links;
  };

  static Cells cells_of(const Obstacle& o, double per_cell) noexcept;
  static Slot& slot_of(std::vector<Slot>& table, std::uint64_t key) noexcept;
  static const Slot& slot_of(const std::vector<Slot>& table, std::uint64_t key) noexcept;
  static void grow(Level& level, std::size_t slots);
  const Obstacle* hit(const Level& level, const Obstacle& o, const Filter& counts) const;

  std::vector<Obstacle> obstacles_;
  std::array<Level, kLevels> levels_;
  std::size_t levels_used_ = 0;
};

}  // namespace tandem::core
