#include "app/window/source_view.hpp"

#include <utility>

namespace tandem::app {
namespace {

using hal::Json;
constexpr std::chrono::milliseconds kInspectionEvery{100};

}  // namespace

Json SourceView::layers_json() const {
  Json all = Json::array();
  for (const core::LayerType* layer : layers_.types())
    all.push_back({{"name", layer->name}, {"summary", layer->summary}, {"on", false}, {"panel", layer->panels}});
  return all;
}

void SourceView::apply_wishes(window::Window& window) {
  const std::uint64_t version = window.wishes_version();
  if (version == wishes_) return;
  wishes_ = version;
  window::Wishes wishes = window.wishes();
  (void)layers_.switch_on(wishes.layers);  // the window knows which there are; one that has failed was told
  layers_.choose_robots(wishes.all_robots ? std::vector<std::string>{"*"} : std::move(wishes.layer_robots));
  inspected_ = std::move(wishes.inspected);
  inspection_told_ = {};
}

void SourceView::show(window::Window& window, const core::Observation& now, hal::Tick done, bool settled,
                      const Inspect& inspect) {
  apply_wishes(window);
  window::Frame frame = window.spare_frame();
  frames_.fill(now.space, done, now.ticks_per_second, settled, frame);
  std::vector<Json> panels = window::add_layers(layers_, now, layers_shown_, frame);
  window.show(std::move(frame));
  for (Json& panel : panels) window.tell(std::move(panel));
  const Clock::time_point told = Clock::now();
  if (inspected_.empty() || (!settled && told - inspection_told_ < kInspectionEvery)) return;
  inspection_told_ = told;
  Json message = {{"type", "inspection"}};
  message.update(inspect(inspected_));
  window.tell(std::move(message));
}

}  // namespace tandem::app
