// When the faults of an emulated robot begin and end, and the chance in them.
#pragma once
#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "bridges/emulation/fault_table.hpp"

namespace tandem::bridges {

/// Base of emulators' fault plans. `Fault` is FaultOf its kinds.
template <class Fault>
class FaultSchedule {
 public:
  using Kind = typename Fault::Kind;

  FaultSchedule(std::vector<Fault> faults, std::uint64_t seed) : faults_(std::move(faults)), chance_(seed) {
    for (std::size_t i = 0; i < faults_.size(); ++i) {
      if (!faults_[i].since_drive) continue;
      waiting_.push_back({i, faults_[i]});
      faults_[i].from = faults_[i].until = kEndless;
    }
  }

  /// Times from here on are on the clock of `start`. The plan must stay where it is from then on.
  void begin(hal::TimeNs start) {
    changes_.clear();
    told_ = 0;
    for (Fault& fault : faults_) {
      if (!fault.since_drive) place(fault, fault, start);
    }
    sort_changes();
  }
  /// Whether there are faults that wait to be told since when the robot is driven: they are not active, and there is no
  /// time at which they will be.
  bool awaits_drive() const noexcept { return !waiting_.empty(); }
  /// The robot was first ordered to move at `at`, which is known at `now`. A fault that should have begun before `now`
  /// begins at `now`, and lasts as long. Does nothing from the second call on.
  void driven(hal::TimeNs at, hal::TimeNs now) {
    if (!awaits_drive()) return;
    for (const Waiting& w : std::exchange(waiting_, {}))
      place(faults_[w.fault], w.times, std::max(at, now - w.times.from));
    sort_changes();
  }

  struct Change {
    hal::TimeNs at = 0;
    bool begins = true;
    const Fault* fault = nullptr;
  };
  /// The next fault to begin or end by `now`, in order of time; each is reported once.
  std::optional<Change> next_change(hal::TimeNs now) {
    if (told_ == changes_.size() || changes_[told_].at > now) return std::nullopt;
    return changes_[told_++];
  }
  /// When `next_change` will have something.
  std::optional<hal::TimeNs> next_change_at() const {
    if (told_ == changes_.size()) return std::nullopt;
    return changes_[told_].at;
  }

  bool active(Kind kind, hal::TimeNs at) const {
    return std::any_of(faults_.begin(), faults_.end(),
                       [&](const Fault& f) { return f.kind == kind && is_at_work(f, at); });
  }
  /// Whether it happens now, where it does so with a probability; each call draws again.
  bool happens(Kind kind, hal::TimeNs at) {
    bool any = false;
    for (const Fault& f : faults_) {
      if (f.kind == kind && is_at_work(f, at)) any = chance_.hits(f.number) || any;
    }
    return any;
  }
  /// The longest time of those of that kind that are at work.
  hal::TimeNs longest_ns(Kind kind, hal::TimeNs at) const {
    hal::TimeNs longest = 0;
    for (const Fault& f : faults_) {
      if (f.kind == kind && is_at_work(f, at)) longest = std::max(longest, f.time_ns);
    }
    return longest;
  }

 protected:
  /// One direction of messages, which have a time `at`, and the kinds of faults that they meet there.
  template <class Message, class Key>
  struct Way {
    Kind lose, twice, swap, late;
    std::map<Key, Message> held{};
    hal::TimeNs last_at = 0;
  };
  /// What a message becomes on its way: nothing, itself, twice itself, or it waits for the next of its `key`, if it
  /// `may_wait`. Messages of a way leave in the order of their times.
  template <class Message, class Key>
  void pass(Way<Message, Key>& way, const Message& message, const Key& key, bool may_wait, std::vector<Message>& out) {
    if (happens(way.lose, message.at)) return;
    const auto deliver = [&](Message m) {
      m.at = way.last_at = std::max(way.last_at, message.at + longest_ns(way.late, message.at));
      out.push_back(std::move(m));
    };
    const auto held = way.held.find(key);
    if (held == way.held.end() && may_wait && happens(way.swap, message.at)) {
      way.held.emplace(key, message);
      return;
    }
    deliver(message);
    if (happens(way.twice, message.at)) deliver(message);
    if (held == way.held.end()) return;
    deliver(std::move(held->second));
    way.held.erase(held);
  }

  static bool is_at_work(const FaultTimes& fault, hal::TimeNs at) noexcept {
    return fault.from <= at && at < fault.until;
  }
  const std::vector<Fault>& faults() const noexcept { return faults_; }
  Chance& chance() noexcept { return chance_; }

 private:
  struct Waiting {
    std::size_t fault;
    FaultTimes times;
  };

  void place(Fault& fault, const FaultTimes times, hal::TimeNs base) {
    fault.from = base + times.from;
    fault.until = base + times.until;
    changes_.push_back({fault.from, true, &fault});
    if (times.until < kEndless && !fault.moment) changes_.push_back({fault.until, false, &fault});
  }
  void sort_changes() {
    std::stable_sort(changes_.begin() + static_cast<std::ptrdiff_t>(told_), changes_.end(),
                     [](const Change& a, const Change& b) { return a.at < b.at; });
  }

  std::vector<Fault> faults_;
  std::vector<Waiting> waiting_;  // for `driven`
  std::vector<Change> changes_;   // in order of time
  std::size_t told_ = 0;
  Chance chance_;
};

}  // namespace tandem::bridges
