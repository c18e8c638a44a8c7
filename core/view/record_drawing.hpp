// Drawings from a record of a run.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/record/record_reader.hpp"
#include "core/view/drawing.hpp"
#include "core/view/trails.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// Goes through the ticks of a record that have poses. Shown is what a record holds: LEDs where the port `leds` is in
/// it, turrets where `turret_encoder` is; floors, what hooks drew and what grippers hold are not.
class RecordDrawings {
 public:
  /// Stands at the first of them. Errors: no record, no poses in it.
  static hal::Result<RecordDrawings> open(const std::string& path);

  /// Goes to the next one; false: there is none, and it stays where it was.
  bool next();
  /// After so many ticks of the run.
  std::int64_t ticks_done() const noexcept { return tick_ + 1; }
  std::int64_t ticks_per_second() const noexcept { return ticks_per_second_; }
  /// With the trails that are given; of `look`, whether ids are asked for counts.
  Drawing drawing(const PictureLook& look, const Trails* trails) const;
  std::vector<Trails::Place> places() const;
  const PictureLook::Area& arena() const noexcept { return arena_; }
  /// Of the part that was read.
  std::vector<std::string> damage() const { return reader_.damage(); }

 private:
  explicit RecordDrawings(RecordReader reader);
  void take(RecordEntry entry);
  void take_scene(const hal::Json& scene);

  struct Thing {
    std::string id;
    bool box = false;
    std::size_t index = 0;  // in the boxes or cylinders of `scene_`
  };
  RecordReader reader_;
  std::string title_;
  std::int64_t ticks_per_second_ = 10;
  PictureLook::Area arena_{-1.0, -1.0, 1.0, 1.0};
  Drawing scene_;  // all but the robots
  std::vector<Thing> movables_;
  hal::Tick tick_ = -1;
  std::optional<RecordRows> poses_, objects_, leds_, turrets_;
  std::optional<RecordEntry> ahead_;
};

}  // namespace tandem::core
