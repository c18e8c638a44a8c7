// A record as the space of its run: displays, lists and measures work on it as on a world's.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "core/record/observer.hpp"
#include "core/record/record_moments.hpp"
#include "core/space/space.hpp"
#include "hal/catalog.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// Goes through the ticks of a record that have poses. The space has all that the record says of a tick: robots with
/// ports, published state and what moves on them, objects, lights, floor, drawings of hooks. It has no controllers,
/// belongs to no world and is never stepped.
class RecordSource {
 public:
  /// Stands at the first of them. Kinds and ports are those of `catalog`, which outlives this, where they are as the
  /// record describes them; else, and without a catalog, they are made of what it says. Errors: no record, no poses in
  /// it.
  static hal::Result<RecordSource> open(const std::string& path, const hal::Catalog* catalog = nullptr);
  RecordSource(RecordSource&&) noexcept;
  RecordSource& operator=(RecordSource&&) noexcept;
  ~RecordSource();

  /// Goes to the next one; false: there is none, and it stays where it was.
  bool next() { return moments_.next(); }
  /// Goes to where so many ticks were done, or to the last that has poses before that.
  void go_to(std::int64_t ticks_done) { moments_.go_to(ticks_done - 1); }
  /// After so many ticks of the run.
  std::int64_t ticks_done() const noexcept { return moments_.tick() + 1; }
  std::int64_t ticks_per_second() const noexcept { return moments_.ticks_per_second(); }
  std::string experiment() const;
  std::uint64_t seed() const;
  RecordMoments& moments() noexcept { return moments_; }
  const RecordMoments& moments() const noexcept { return moments_; }

  /// The space at that tick; valid until the next call after another tick was gone to. A robot keeps its number as long
  /// as this. Velocities are those from where bodies were when it was called before, a second of the run ago at most.
  const Space& space();
  /// The same, as observers and layers see a run.
  Observation observation();

 private:
  class Shown;
  RecordSource(RecordMoments moments, const hal::Catalog* catalog);

  RecordMoments moments_;
  std::unique_ptr<Shown> shown_;
};

}  // namespace tandem::core
