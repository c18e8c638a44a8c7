// A record tick by tick: all that it says of the end of one, at any place of the run.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/record/record_reader.hpp"
#include "core/space/sketch.hpp"
#include "hal/json/json.hpp"
#include "hal/result.hpp"
#include "hal/time.hpp"

namespace tandem::core {

/// Stands at one of the ticks that have poses of robots.
class RecordMoments {
 public:
  /// At the first of them. Errors: as RecordReader::open; no poses in it.
  static hal::Result<RecordMoments> open(const std::string& path);

  const hal::Json& start() const noexcept { return reader_.start(); }
  std::int64_t ticks_per_second() const noexcept { return ticks_per_second_; }
  /// Those ticks, rising; -1: before the first.
  const std::vector<hal::Tick>& ticks() const noexcept { return reader_.ticks(); }
  const std::vector<RecordEvent>& events() { return reader_.events(); }

  /// Goes to the last of them that is not later, or to the first. The cost does not depend on how far away it is.
  void go_to(hal::Tick tick);
  /// Goes to the next one; false: there is none, and it stays where it was.
  bool next();
  hal::Tick tick() const noexcept { return tick_; }

  const RecordRows& poses() const noexcept { return *rows("pose"); }
  /// Rows of this tick, or those that still hold, by the stream's title: "object pose", "attitude", "look leds",
  /// "sensor proximity", …; null: none. Where groups of robots have a stream of this title each, as two do whose
  /// controllers are of one name: those of the group with this number among them.
  const RecordRows* rows(std::string_view title, std::size_t group = 0) const noexcept;
  /// Calls `visit(title, rows)` for each table that there is now; those of one title follow one another, by group.
  template <class Visit>
  void each(Visit&& visit) const {
    for (const auto& [title, rows] : rows_) visit(title, rows);
  }
  const hal::Json& scene() const noexcept { return scene_; }
  /// A PNG picture of 8 bits of grey over the arena; empty: the floor is uniform.
  std::string_view floor_png() const noexcept { return floor_; }
  /// What hooks drew.
  const hal::Json& sketch() const noexcept { return sketch_; }
  /// Differ when scene, floor or drawing do.
  std::uint64_t scene_number() const noexcept { return scene_number_; }
  std::uint64_t floor_number() const noexcept { return floor_number_; }
  std::uint64_t sketch_number() const noexcept { return sketch_number_; }

  /// Of the part that was read.
  std::vector<std::string> damage() const { return reader_.damage(); }
  bool cut() const noexcept { return reader_.cut(); }

 private:
  explicit RecordMoments(RecordReader reader);
  bool stand_at(std::size_t i);
  bool read_tick();
  void take(RecordEntry entry);

  RecordReader reader_;
  std::int64_t ticks_per_second_ = 10;
  std::size_t first_ = 0;  // of the reader's ticks: those before are damaged
  std::size_t at_ = 0;     // of them, too
  hal::Tick tick_ = -1;
  std::multimap<std::string, RecordRows, std::less<>> rows_;  // by title
  std::optional<RecordEntry> ahead_;                          // of the next tick
  hal::Json scene_ = hal::Json::object(), sketch_ = hal::Json::object();
  std::string_view floor_;
  std::uint64_t scene_number_ = 0, floor_number_ = 0, sketch_number_ = 0;
};

/// The field of that name which has a value for every row; nothing: there is none.
std::optional<std::size_t> field_of(const RecordRows& rows, std::string_view name) noexcept;

}  // namespace tandem::core
