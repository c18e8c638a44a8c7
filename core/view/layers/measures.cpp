// What hooks publish, as a panel.
#include "core/view/layers/types.hpp"

namespace tandem::core {
namespace {

class MeasuresPanel final : public Layer {
 public:
  void panel(const LayerView& now, Panel& out) override {
    out.set_title("measures of hooks");
    for (const auto& [name, value] : now.measures.all()) out.row(name, value);
  }
};

}  // namespace

LayerType measures_layer() {
  return layer_type<MeasuresPanel>("measures", "Numbers that hooks publish.");
}

}  // namespace tandem::core
