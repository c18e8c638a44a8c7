// Crowds: robots that a tick left deep in one another, pushed apart in passes.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tandem::core {

/// For solvers whose sub-steps are too few for a crowd: what they leave is pushed apart without forces, and who is deep
/// in another even then goes back to where it was before the tick. So robots that press on one another stand, and those
/// that have room slide. It begins where two are in one another by more than `kDeep`, and works on those alone that are
/// near such a place. Bodies have numbers; the same on every machine, in whatever order pushes are computed.
class CrowdPasses {
 public:
  static constexpr double kDeep = 0.01;             ///< overlap, in parts of the narrower one's diameter
  static constexpr double kShallow = 0.25 * kDeep;  ///< deeper ones, and those near them, go on
  static constexpr double kSlack_m = 0.02;          ///< moves together after which neighbours are looked for again
  static constexpr int kMostPasses = 400;           ///< of pushing
  static constexpr std::uint8_t kHalvings = 5;      ///< of a way back; the last one is all of it

  /// For so many bodies: settling as many allocates nothing.
  void reserve(std::size_t bodies) {
    overlap_.reserve(bodies);
    marks_.reserve(bodies);
    list_.reserve(bodies);
  }

  /// Overlap of two robots whose rims are in one another by `depth_m`.
  static double overlap(double depth_m, double radius_m, double other_radius_m) noexcept {
    return depth_m / (2.0 * std::min(radius_m, other_radius_m));
  }

  /// Passes until no body is deeper than `kDeep` in another, or none can go back further.
  ///   find(back)          finds the neighbours of all, within `kSlack_m`; with `back` also those on the way to where
  ///                       all were before the tick; returns the numbers of those that have any and give way
  ///   push(list)          computes what each of these is pushed by, and notes the overlaps found by `note`
  ///   move(list)          moves these by their pushes; returns the longest way
  ///   go_back(i, share)   leaves body `i` this share of its way since the tick's start
  ///   near(i)             neighbours of body `i`, as they were found last
  /// @returns the deepest overlap that is left.
  template <class Find, class Push, class Move, class GoBack, class Near>
  double settle(std::size_t bodies, Find&& find, Push&& push, Move&& move, GoBack&& go_back, Near&& near) {
    overlap_.assign(bodies, 0.0);
    const std::vector<std::uint32_t>* all = &find(false);
    bool whole = true;  // `list_` is all
    list_ = *all;
    double moved_m = 0.0;
    for (int pass = 0; pass < kMostPasses; ++pass) {
      look(list_, push);
      if (deepest_ <= kDeep && whole) return deepest_;
      const bool looks_again = deepest_ <= kDeep;  // what was pushed out of there may be in others, not near then
      if (!looks_again) {
        mark_deep(bodies, near);
        moved_m += move(list_);
      }
      if (looks_again || moved_m > 0.5 * kSlack_m) {
        all = &find(false);
        moved_m = 0.0;
      }
      list_.clear();
      for (const std::uint32_t i : *all) {
        if (looks_again || marks_[i] != 0) list_.push_back(i);
      }
      whole = list_.size() == all->size();
    }
    return send_back(bodies, find(true), push, go_back);
  }

  /// Body `i` was found so deep in another.
  void note(std::uint32_t i, double overlap) noexcept {
    overlap_[i] = std::max(overlap_[i], overlap);
    deepest_ = std::max(deepest_, overlap);
  }

 private:
  template <class Push>
  void look(const std::vector<std::uint32_t>& who, Push& push) {
    deepest_ = 0.0;
    for (const std::uint32_t i : who) overlap_[i] = 0.0;
    push(who);
  }

  /// Marks those that are deep in others, and those near them.
  template <class Near>
  void mark_deep(std::size_t bodies, Near& near) {
    marks_.assign(bodies, 0);
    for (const std::uint32_t i : list_) {
      if (overlap_[i] <= kShallow) continue;
      marks_[i] = 1;
      for (const std::uint32_t k : near(i)) marks_[k] = 1;
    }
  }

  /// A body deep in another goes back, half its way each time and at last all of it, then those that it meets
  /// there, and so on. No body was deep before the tick.
  template <class Push, class GoBack>
  double send_back(std::size_t bodies, const std::vector<std::uint32_t>& all, Push& push, GoBack& go_back) {
    marks_.assign(bodies, 0);  // how often they went back
    for (;;) {
      look(all, push);
      bool more = false;
      for (const std::uint32_t i : all) {
        if (overlap_[i] <= kDeep || marks_[i] == kHalvings) continue;
        go_back(i, ++marks_[i] == kHalvings ? 0.0 : 0.5);
        more = true;
      }
      if (!more) return deepest_;
    }
  }

  double deepest_ = 0.0;
  std::vector<double> overlap_;
  std::vector<std::uint8_t> marks_;
  std::vector<std::uint32_t> list_;
};

}  // namespace tandem::core
