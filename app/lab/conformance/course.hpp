// One trial run again and again: with other numbers of threads, from checkpoints, from a reset.
#pragma once
#include <optional>

#include "app/lab/conformance/judgement.hpp"
#include "app/lab/conformance/trial.hpp"

namespace tandem::app {

/// Runs a trial in all the ways in which it must come out alike, and adds what was found to `all`.
class Course {
 public:
  /// `part` is what the judgements are of. All must outlive this.
  Course(std::string part, const TrialMaker& maker, Judgements& all)
      : part_(std::move(part)), maker_(maker), all_(all) {}

  /// False: the world cannot be made or fails, which was reported; nothing else is to be tried.
  bool runs();
  /// The same seed again, and any number of threads. False: they differ.
  bool repeats();
  void checkpoints();
  /// `usual`: allocations that a world without the part makes.
  void allocates(std::optional<std::uint64_t> usual);
  /// Every value that the world keeps for its robots in columns that are not of `known` counts in the fingerprint, and
  /// nothing else is kept there.
  void counts_state(const std::vector<std::string>& known);

  /// Of the part's own kind, for what only its category is asked.
  void say(Verdict verdict, std::string what, std::string found) {
    all_.push_back({verdict, part_, std::move(what), std::move(found)});
  }

 private:
  /// Steps both side by side. @returns where they part, in words; empty: nowhere
  static std::string difference(core::World& a, core::World& b, std::int64_t until);

  std::string part_;
  const TrialMaker& maker_;
  Judgements& all_;
};

/// What the trial's world allocates once it has settled; nothing: it cannot be told.
std::optional<std::uint64_t> allocations_of(const TrialMaker& maker);
/// The names of the columns that hold rows in the trial's world.
std::vector<std::string> columns_of(const TrialMaker& maker);

}  // namespace tandem::app
