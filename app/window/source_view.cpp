#include "app/window/source_view.hpp"

#include <algorithm>
#include <utility>

#include "core/live/inspection.hpp"
#include "core/space/stores.hpp"

namespace tandem::app {
namespace {

using hal::Json;
constexpr std::chrono::milliseconds kInspectionEvery{100};

}  // namespace

Json SourceView::layers_json(const core::Space& space) const {
  const auto has = [&space](std::string_view sensor) {
    return std::ranges::any_of(space.stores().groups, [sensor](const core::RobotGroup& group) {
      return std::ranges::any_of(group.ports, [sensor](const hal::PortType* port) {
        return port->role == hal::Role::Sensor && port->name == sensor;
      });
    });
  };
  Json all = Json::array();
  for (const core::LayerType* layer : layers_.types()) {
    all.push_back({{"name", layer->name}, {"summary", layer->summary}, {"on", false}, {"panel", layer->panels}});
    if (!layer->sensors.empty() && std::ranges::none_of(layer->sensors, has)) all.back()["idle"] = true;
  }
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
  states_ = std::move(wishes.states);
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
  if (!settled && told - inspection_told_ < kInspectionEvery) return;
  inspection_told_ = told;
  for (const std::string& name : states_) {
    Json message = {{"type", "states"}};
    message.update(core::published_values(now.space, name));
    window.tell(std::move(message));
  }
  if (inspected_.empty()) return;
  Json message = {{"type", "inspection"}};
  message.update(inspect(inspected_));
  window.tell(std::move(message));
}

}  // namespace tandem::app
