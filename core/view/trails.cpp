#include "core/view/trails.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace tandem::core {
namespace {

constexpr std::int64_t kMostPlaces = 200;

}  // namespace

Trails::Trails(double seconds, std::int64_t ticks_per_second)
    : span_(std::llround(seconds * static_cast<double>(ticks_per_second))),
      every_(std::max<std::int64_t>(1, span_ / kMostPlaces)) {}

bool Trails::wants(std::int64_t ticks_done) const noexcept {
  return span_ > 0 && ticks_done % every_ == 0;
}

void Trails::note(std::int64_t ticks_done, std::vector<Place> places) {
  if (!wants(ticks_done)) return;
  if (!kept_.empty() && kept_.back().ticks_done >= ticks_done) kept_.clear();
  while (!kept_.empty() && kept_.front().ticks_done < ticks_done - span_) kept_.pop_front();
  kept_.push_back({ticks_done, std::move(places)});
}

void Trails::note(std::int64_t ticks_done, const Space& space) {
  if (!wants(ticks_done)) return;
  std::vector<Place> places(space.robot_count());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const RobotId id = space.robot(i);
    const Pose pose = space.pose(id);
    places[i] = {number_of(id), pose.x_m, pose.y_m, pose.z_m};
  }
  note(ticks_done, std::move(places));
}

void Trails::add_to(Drawing& drawing, std::span<const std::uint64_t> who, std::int64_t ticks_done) const {
  std::vector<std::vector<Drawing::Point>> points(who.size());
  for (const Kept& kept : kept_) {
    if (kept.ticks_done < ticks_done - span_ || kept.ticks_done >= ticks_done) continue;
    std::unordered_map<std::uint64_t, std::size_t> at;  // only where the order has changed
    for (std::size_t i = 0; i < who.size(); ++i) {
      std::size_t place = i;
      if (place >= kept.places.size() || kept.places[place].who != who[i]) {
        if (at.empty()) {
          for (std::size_t k = 0; k < kept.places.size(); ++k) at.emplace(kept.places[k].who, k);
        }
        const auto found = at.find(who[i]);
        if (found == at.end()) continue;
        place = found->second;
      }
      points[i].push_back({kept.places[place].x_m, kept.places[place].y_m, kept.places[place].z_m});
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].empty()) continue;
    drawing.trails.push_back({i, drawing.trail_points.size(), points[i].size()});
    drawing.trail_points.insert(drawing.trail_points.end(), points[i].begin(), points[i].end());
  }
}

void Trails::add_to(Drawing& drawing, const Space& space, std::int64_t ticks_done) const {
  if (span_ == 0) return;
  std::vector<std::uint64_t> who(space.robot_count());
  for (std::size_t i = 0; i < who.size(); ++i) who[i] = number_of(space.robot(i));
  add_to(drawing, who, ticks_done);
}

}  // namespace tandem::core
