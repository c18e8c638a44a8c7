#include "window/frame.hpp"

namespace tandem::window {

hal::Json texts_json(const core::Sketch& sketch) {
  hal::Json texts;
  for (const core::PlacedText& text : core::texts_of(sketch)) {
    texts.push_back({{"x", text.at.x_m},
                     {"y", text.at.y_m},
                     {"z", text.at.z_m},
                     {"text", text.text},
                     {"color", {text.color.r, text.color.g, text.color.b}}});
  }
  return texts;
}

void Frame::clear() noexcept {
  tick = 0;
  time_s = 0.0;
  scene.reset();
  members.reset();
  for (std::vector<double>* axis : {&x_m, &y_m, &cos_h, &sin_h}) axis->clear();
  z_m.clear();
  q_WB.clear();
  leds.clear();
  values.clear();
  halted.clear();
  objects.clear();
  layers.clear();
}

}  // namespace tandem::window
