#include "core/view/layers/layer_set.hpp"

#include <algorithm>
#include <exception>
#include <utility>

#include "core/record/trajectory.hpp"
#include "core/scenario/element.hpp"
#include "hal/plugin_call.hpp"

namespace tandem::core {
namespace {

void name_layer(const void* type, std::size_t /*part*/, std::size_t /*index*/, hal::FixedText& out) noexcept {
  out << "layer '" << static_cast<const LayerType*>(type)->name << "'";
}

}  // namespace

LayerSet::LayerSet(const hal::Catalog& catalog, hal::Log log)
    : log_(std::move(log)), types_(catalog.all<LayerType>()), all_(types_.size()) {
  for (const LayerType* type : types_) origins_.push_back(catalog.origin_of(type));
}

/// @returns false when it threw; the layer is off then.
template <class Call>
bool LayerSet::call(std::size_t number, Call&& call) {
  std::string why;
  try {
    const hal::PluginCall marked(&name_layer, types_[number]);
    call();
    return true;
  } catch (const std::exception& e) {
    why = ": " + std::string(e.what());
  } catch (...) {
  }
  One& one = all_[number];
  one.failed = true;
  if (one.layer != nullptr) {
    --on_;
    noting_ -= types_[number]->notes ? 1 : 0;
    one.layer.reset();
  }
  log_.error("layer '" + std::string(types_[number]->name) + "'" +
             (origins_[number] == hal::Catalog::kInside ? "" : " (library '" + origins_[number] + "')") + " threw" +
             why + "; it is off");
  return false;
}

hal::Status LayerSet::switch_on(const std::vector<std::string>& names) {
  std::vector<bool> wanted(types_.size(), false);
  for (const std::string& name : names) {
    const auto found =
        std::find_if(types_.begin(), types_.end(), [&](const LayerType* type) { return type->name == name; });
    if (found == types_.end()) {
      std::vector<std::string> there;
      for (const LayerType* type : types_) there.emplace_back(type->name);
      return hal::Error{"there is no layer '" + name + "'; there are: " + listed(there) + did_you_mean(name, there)};
    }
    const auto number = static_cast<std::size_t>(found - types_.begin());
    if (all_[number].failed) return hal::Error{"the layer '" + name + "' has failed, and stays off in this run"};
    wanted[number] = true;
  }
  on_ = noting_ = 0;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (!wanted[i]) all_[i].layer.reset();
    if (all_[i].layer != nullptr || wanted[i]) {
      ++on_;
      noting_ += types_[i]->notes ? 1 : 0;
    }
  }
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (!wanted[i] || all_[i].layer != nullptr) continue;
    std::unique_ptr<Layer> made;
    const bool good = call(i, [&] { made = types_[i]->make(); });
    if (good && made != nullptr) {
      all_[i].layer = std::move(made);
      continue;
    }
    --on_;
    noting_ -= types_[i]->notes ? 1 : 0;
    all_[i].failed = true;
    return hal::Error{"the layer '" + std::string(types_[i]->name) + "' could not be made"};
  }
  return {};
}

void LayerSet::choose_robots(std::vector<std::string> patterns) {
  patterns_ = std::move(patterns);
}

std::vector<std::size_t> LayerSet::on() const {
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (all_[i].layer != nullptr) numbers.push_back(i);
  }
  return numbers;
}

LayerView LayerSet::view_of(const Observation& now) {
  robots_.clear();
  const auto add = [this](RobotId robot) {
    if (robots_.size() < kMostRobots) robots_.push_back(robot);
  };
  const auto is_pattern = [](const std::string& text) { return text.find('*') != std::string::npos; };
  if (std::find(patterns_.begin(), patterns_.end(), "*") != patterns_.end()) {
    for (std::size_t i = 0; i < std::min(now.space.robot_count(), kMostRobots); ++i) add(now.space.robot(i));
  } else if (std::none_of(patterns_.begin(), patterns_.end(), is_pattern)) {
    for (const std::string& id : patterns_) {
      const RobotId robot = now.space.find_robot(id);
      if (now.space.contains(robot)) add(robot);
    }
  } else {
    for (std::size_t i = 0; i < now.space.robot_count() && robots_.size() < kMostRobots; ++i) {
      const std::string name = now.space.robot_name(now.space.robot(i));
      const auto fits = [&name](const std::string& pattern) { return fits_pattern(name, pattern); };
      if (std::any_of(patterns_.begin(), patterns_.end(), fits)) add(now.space.robot(i));
    }
  }
  return {now, robots_};
}

void LayerSet::note(const Observation& now) {
  if (noting_ == 0) return;
  const LayerView view = view_of(now);
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (all_[i].layer != nullptr && types_[i]->notes) call(i, [&] { all_[i].layer->note(view); });
  }
}

std::vector<LayerPicture> LayerSet::show(const Observation& now) {
  std::vector<LayerPicture> pictures;
  if (on_ == 0) return pictures;
  const LayerView view = view_of(now);
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (all_[i].layer == nullptr) continue;
    LayerPicture picture{i, {}, {}};
    const bool good = call(i, [&] {
      if (types_[i]->draws) all_[i].layer->draw(view, picture.sketch);
      if (!types_[i]->panels) return;
      picture.panel.emplace();
      picture.panel->set_title(types_[i]->name);
      all_[i].layer->panel(view, *picture.panel);
    });
    if (good) pictures.push_back(std::move(picture));
  }
  return pictures;
}

}  // namespace tandem::core
