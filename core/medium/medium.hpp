// Interface of a medium: carries signals from actuators at the start of a tick to sensors of others at its end.
#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scenario/medium_type.hpp"
#include "core/space/stores.hpp"
#include "hal/catalog.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// Holds nothing from tick to tick: publishers publish in every tick before listeners listen. So snapshots and
/// fingerprints need none of it.
class Medium {
 public:
  Medium() noexcept { hal::detail::note_surface<StoresSurface>(); }
  virtual ~Medium() = default;
  /// Robots or what their devices ask for have changed, or blocks have: makes room for those that publish.
  virtual void fit(const SpaceStores& stores) = 0;
  /// Once all bodies have moved, and before anybody listens.
  virtual void index(const SpaceStores& /*stores*/) {}
};

/// A medium in which a robot publishes one `T` a tick; `T{}` is silence.
template <class T>
class RowMedium : public Medium {
 public:
  /// Where the robots of a block publish, one row each, every row in every tick; null: there are no listeners.
  T* publish(const RobotBlock& block) noexcept { return silent() ? nullptr : &rows_[block.first_row - first_row_]; }
  /// What the robot in this row publishes in this tick.
  const T& of(std::size_t row) const noexcept {
    return row - first_row_ < rows_.size() ? rows_[row - first_row_] : silence_;
  }
  /// Whether publishers or listeners are missing.
  bool silent() const noexcept { return rows_.empty(); }

  void fit(const SpaceStores& stores) override {
    std::size_t first = stores.bodies.size();
    std::size_t past = 0;
    bool heard = false;
    for (const RobotGroup& group : stores.groups) {
      const MediumUse* use = group.use_of(*this);
      if (use == nullptr) continue;
      heard = heard || use->listens;
      if (!use->publishes) continue;
      for (const std::size_t b : group.blocks) {
        first = std::min(first, stores.blocks[b].first_row);
        past = std::max(past, stores.blocks[b].first_row + stores.blocks[b].capacity);
      }
    }
    first_row_ = first;
    rows_.assign(heard && past > first ? past - first : 0, T{});
  }

 protected:
  std::size_t first_row() const noexcept { return first_row_; }
  std::size_t rows() const noexcept { return rows_.size(); }

 private:
  std::size_t first_row_ = 0;  // of the first block that publishes; those of the last end the rows
  std::vector<T> rows_;
  T silence_{};
};

/// The media of a world: one of each kind that its robots' devices ask for.
class Media {
 public:
  /// Made where there is none yet. Error: the catalog has none of that kind.
  hal::Result<Medium*> of(const hal::Catalog& catalog, std::string_view kind);

  void fit(const SpaceStores& stores) const {
    for (const auto& [type, medium] : all_) medium->fit(stores);
  }
  void index(const SpaceStores& stores) const {
    for (const auto& [type, medium] : all_) medium->index(stores);
  }

 private:
  std::vector<std::pair<const MediumType*, std::unique_ptr<Medium>>> all_;
};

/// Media of ARGoS' that files may name and nothing here uses.
void register_unused_media(hal::Registrar& registrar);

}  // namespace tandem::core
