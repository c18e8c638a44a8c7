// Fields: a value at every place of the arena, such as the floor's shade, the light or the sound there.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/archive.hpp"
#include "hal/rgb.hpp"

namespace tandem::core {

struct SpaceStores;  // core/space/stores.hpp

/// Place of a sensor in its robot's frame, and its direction along the ground, of length 1.
struct FieldSpot {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double look_x = 1.0, look_y = 0.0;
};

/// Places at which a field is sampled: the same spots of each robot in some rows.
struct FieldPlaces {
  const SpaceStores& stores;
  std::size_t first_row = 0, rows = 0;
  std::span<const FieldSpot> spots;
};

/// Value that hooks give for a place in W; `otherwise` where none does.
using Painter = std::function<double(double x_m, double y_m, double otherwise)>;

/// Pixels of equal size that a field is made of, over the whole arena.
struct FieldGrid {
  std::size_t columns = 0, lines = 0;
};

/// A field may hold something itself, follow from what is in the space, or both. Only the thread that steps the world
/// changes it, between parallel phases.
class Field {
 public:
  Field() noexcept;  // in core/space/stores.hpp
  virtual ~Field() = default;

  /// The values at the spots of the first robot, then those of the next, … On any thread.
  virtual void sample(const FieldPlaces& places, double* values) const noexcept = 0;
  /// At a point of W, however one looks.
  virtual double at(const SpaceStores& stores, double x_m, double y_m, double z_m) const noexcept = 0;

  /// Its colour there, for pictures; nothing: grey, by its value.
  virtual std::optional<hal::Rgb> color(const SpaceStores& /*stores*/, double /*x_m*/, double /*y_m*/) const noexcept {
    return std::nullopt;
  }

  /// Whether hooks paint it, at all.
  virtual bool painted_by_hooks() const noexcept { return false; }
  /// Whether it has not been painted since it was made or since `repaint`.
  virtual bool unpainted() const noexcept { return false; }
  virtual void repaint() noexcept {}
  /// Takes over what hooks answer. Lets through what `painter` throws.
  virtual void paint(const Painter& /*painter*/) {}

  /// Fingerprint of what it holds; 0: nothing.
  virtual std::uint64_t mark() const noexcept { return 0; }
  /// What it holds, for snapshots, and going back to that; null: nothing.
  virtual std::shared_ptr<const void> keep() const { return nullptr; }
  virtual void put_back(const std::shared_ptr<const void>& /*kept*/) {}
  /// Writes what it holds, or reads it, for checkpoints on disk. False: it cannot; what holds nothing can.
  virtual bool remember(hal::Archive& /*archive*/) { return keep() == nullptr; }

  /// What it is made of, for pictures that show it as it is; 0 x 0: nothing of that kind.
  virtual FieldGrid grid() const noexcept { return {}; }
};

/// The fields of a space, by name.
class Fields {
 public:
  struct Entry {
    std::string name;
    std::unique_ptr<Field> field;
    std::shared_ptr<const void> start;  ///< what it held when it came
  };

  void add(std::string_view name, std::unique_ptr<Field> field) {
    auto start = field->keep();
    all_.push_back({std::string(name), std::move(field), std::move(start)});
  }
  /// Null: there is none of that name.
  Field* find(std::string_view name) const noexcept {
    for (const Entry& entry : all_) {
      if (entry.name == name) return entry.field.get();
    }
    return nullptr;
  }
  const std::vector<Entry>& all() const noexcept { return all_; }
  /// All as they came.
  void begin_anew() {
    for (const Entry& entry : all_) entry.field->put_back(entry.start);
  }

 private:
  std::vector<Entry> all_;
};

}  // namespace tandem::core
