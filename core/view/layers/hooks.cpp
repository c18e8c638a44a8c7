// What hooks drew in the last step.
#include "core/view/layers/types.hpp"

namespace tandem::core {
namespace {

class HookDrawings final : public Layer {
 public:
  void draw(const LayerView& now, Sketch& out) override { out.add(now.space.sketch()); }
};

}  // namespace

LayerType hooks_layer() {
  return layer_type<HookDrawings>("hooks", "Drawings of hooks.");
}

}  // namespace tandem::core
