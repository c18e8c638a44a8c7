#include "core/view/record_drawing.hpp"

#include <utility>

#include "core/record/scene_json.hpp"
#include "core/view/picture.hpp"
#include "hal/json/json_access.hpp"
#include "hal/time.hpp"

namespace tandem::core {

using hal::Json;

std::vector<Drawing::Area> areas_of(const SafetyConfig& safety) {
  using Kind = Drawing::Area::Kind;
  std::vector<Drawing::Area> all;
  for (const auto& [kind, areas] : {std::pair{Kind::Fence, &safety.fences}, std::pair{Kind::KeepOut, &safety.keep_outs},
                                    std::pair{Kind::Zone, &safety.zones}}) {
    for (const SafetyArea& area : *areas) {
      Drawing::Area drawn{kind, area.id, {}, area.from_m, area.to_m, area.max_speed_m_s};
      for (const Point2& p : area.corners) drawn.corners.push_back({p[0], p[1]});
      all.push_back(std::move(drawn));
    }
  }
  return all;
}

Drawing drawing_of(RecordSource& record, const PictureLook& look, const Trails* trails) {
  PictureOptions options{record.experiment(), record.seed()};
  options.time_ns = hal::time_of_tick(record.ticks_done(), record.ticks_per_second());
  options.look = look;
  options.trails = trails;
  options.ticks_done = record.ticks_done();
  Drawing drawing = drawing_of(record.space(), options);
  drawing.areas = areas_of(areas_of_json(hal::list_of(record.moments().start(), "areas")));
  return drawing;
}

PictureLook::Area arena_of(const Space& space) {
  const double half_x_m = 0.5 * space.arena_size_x_m(), half_y_m = 0.5 * space.arena_size_y_m();
  return {space.arena_center_x_m() - half_x_m, space.arena_center_y_m() - half_y_m, space.arena_center_x_m() + half_x_m,
          space.arena_center_y_m() + half_y_m};
}

}  // namespace tandem::core
