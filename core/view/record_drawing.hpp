// Drawings from a record of a run.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/record/record_moments.hpp"
#include "core/view/drawing.hpp"
#include "core/view/trails.hpp"
#include "hal/json/json.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// Areas as records and the view protocol have them: [{`kind` ("fence", "keep_out", "zone"), `id`, `corners` [[x, y]],
/// `from`, `to`, `max_speed`}]. What is none is left out.
std::vector<Drawing::Area> areas_of_json(const hal::Json& areas);
hal::Json to_json(const std::vector<Drawing::Area>& areas);

/// Goes through the ticks of a record that have poses. They are what the run would have drawn, but for what is wrong
/// with real robots.
class RecordDrawings {
 public:
  /// Stands at the first of them. Errors: no record, no poses in it.
  static hal::Result<RecordDrawings> open(const std::string& path);

  /// Goes to the next one; false: there is none, and it stays where it was.
  bool next() { return moments_.next(); }
  /// Goes to where so many ticks were done, or to the last that has poses before that.
  void go_to(std::int64_t ticks_done) { moments_.go_to(ticks_done - 1); }
  /// After so many ticks of the run.
  std::int64_t ticks_done() const noexcept { return moments_.tick() + 1; }
  std::int64_t ticks_per_second() const noexcept { return moments_.ticks_per_second(); }
  /// With the trails that are given; of `look`, whether ids are asked for counts.
  Drawing drawing(const PictureLook& look, const Trails* trails);
  std::vector<Trails::Place> places() const;
  const PictureLook::Area& arena();
  /// Of the part that was read.
  std::vector<std::string> damage() const { return moments_.damage(); }

 private:
  explicit RecordDrawings(RecordMoments moments);
  void take_scene();

  struct Thing {
    std::string id;
    bool box = false;
    std::size_t index = 0;  // in the boxes or cylinders of `scene_`
  };
  RecordMoments moments_;
  std::string title_;
  PictureLook::Area arena_{-1.0, -1.0, 1.0, 1.0};
  Drawing scene_;  // all but the robots
  std::vector<Thing> movables_;
  std::uint64_t scene_number_ = 0, floor_number_ = 0;  // of what they were made of
};

}  // namespace tandem::core
