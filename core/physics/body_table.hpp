// Table of the bodies that a solver holds, kept in step with what its region lists.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

#include "core/space/stores.hpp"

namespace tandem::core {

/// A solver's bodies in the order of their keys. `Kept` is whatever the solver keeps for one: cheap to move.
template <class Kept>
class BodyTable {
 public:
  struct Entry {
    BodyKey key;
    std::uint32_t identity = 0;  ///< tells a renewed row, or an object that changed, from what was there before
    bool owned = false;
    Kept body;
  };

  /// Makes the entries those of `region.owned` and `region.mirrored`. A body that passes from one list to the other
  /// keeps its double. `create(key)` makes a proxy of a body that came, `destroy(Kept&)` ends one that went; both
  /// are called in rising order of keys.
  template <class Create, class Destroy>
  void update(const Region& region, const SpaceStores& stores, Create&& create, Destroy&& destroy) {
    next_.clear();
    auto old = entries_.begin();
    auto own = region.owned.begin();
    auto mirror = region.mirrored.begin();
    while (own != region.owned.end() || mirror != region.mirrored.end()) {
      const bool owned = mirror == region.mirrored.end() || (own != region.owned.end() && own->value < mirror->value);
      const BodyKey key = owned ? *own++ : *mirror++;
      while (old != entries_.end() && old->key < key) destroy((old++)->body);
      const std::uint32_t identity =
          key.is_object() ? stores.objects[key.index()].version : stores.bodies.entity[key.index()];
      if (old != entries_.end() && old->key == key) {
        if (old->identity == identity) {
          next_.push_back(std::move(*old++));
          next_.back().owned = owned;
          continue;
        }
        destroy((old++)->body);
      }
      next_.push_back({key, identity, owned, create(key)});
    }
    while (old != entries_.end()) destroy((old++)->body);
    entries_.swap(next_);
  }

  std::vector<Entry>& entries() noexcept { return entries_; }
  const std::vector<Entry>& entries() const noexcept { return entries_; }
  void clear() noexcept { entries_.clear(); }
  /// `body(Kept&)` writes or reads what the solver keeps.
  template <class Archive, class Body>
  void remember(Archive& archive, Body&& body) {
    std::uint64_t count = entries_.size();
    archive(count);
    if (archive.reads()) entries_.clear();
    for (std::uint64_t i = 0; i < count && archive.ok(); ++i) {
      if (archive.reads()) entries_.emplace_back();
      Entry& entry = entries_[i];
      archive(entry.key, entry.identity, entry.owned);
      body(entry.body);
    }
  }

 private:
  std::vector<Entry> entries_, next_;
};

}  // namespace tandem::core
