// The layers of one run: which are on, for which robots, and their present drawings.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/view/layers/layer.hpp"
#include "hal/catalog.hpp"
#include "hal/log.hpp"
#include "hal/result.hpp"

namespace tandem::core {

/// What one layer shows.
struct LayerPicture {
  std::size_t layer = 0;       ///< its number: its place in `LayerSet::types`
  Sketch sketch;               ///< of a layer that draws
  std::optional<Panel> panel;  ///< of one that has a panel
};

/// Used by the thread that steps alone.
class LayerSet {
 public:
  /// Robots that layers are asked for, at most; the first ones.
  static constexpr std::size_t kMostRobots = 2000;

  /// All layers of the catalog, which must outlive this; all off.
  explicit LayerSet(const hal::Catalog& catalog, hal::Log log = {});

  /// In the order of their numbers.
  const std::vector<const LayerType*>& types() const noexcept { return types_; }

  /// Switches on these layers, and no others. Error: there is none of a name, or it has failed before; nothing has
  /// changed then.
  hal::Status switch_on(const std::vector<std::string>& names);
  /// Robots by id, or patterns with '*'; at first: "*". Those that are not there have no effect.
  void choose_robots(std::vector<std::string> patterns);
  /// Numbers of those that are on.
  std::vector<std::size_t> on() const;
  bool any_on() const noexcept { return on_ > 0; }

  /// After every tick. Returns at once when no layer that is on depends on the past.
  void note(const Observation& now);
  /// What all that are on show, in the order of their numbers.
  std::vector<LayerPicture> show(const Observation& now);

 private:
  struct One {
    std::unique_ptr<Layer> layer;  // null: off
    bool failed = false;
  };
  LayerView view_of(const Observation& now);
  template <class Call>
  bool call(std::size_t number, Call&& call);

  hal::Log log_;
  std::vector<const LayerType*> types_;
  std::vector<std::string> origins_;
  std::vector<One> all_;
  std::size_t on_ = 0, noting_ = 0;
  std::vector<std::string> patterns_{"*"};
  std::vector<RobotId> robots_;
};

}  // namespace tandem::core
