#include "core/view/record_drawing.hpp"

#include <utility>

#include "core/view/picture.hpp"
#include "hal/json/json_access.hpp"
#include "hal/time.hpp"

namespace tandem::core {

using hal::Json;

std::vector<Drawing::Area> areas_of_json(const Json& areas) {
  std::vector<Drawing::Area> all;
  if (!areas.is_array()) return all;
  for (const Json& a : areas) {
    Drawing::Area area;
    const std::string kind = hal::text_of(a, "kind");
    area.kind = kind == "fence"      ? Drawing::Area::Kind::Fence
                : kind == "keep_out" ? Drawing::Area::Kind::KeepOut
                                     : Drawing::Area::Kind::Zone;
    area.id = hal::text_of(a, "id");
    area.from_m = hal::number_of(a, "from");
    area.to_m = hal::number_of(a, "to");
    area.max_speed_m_s = hal::number_of(a, "max_speed");
    for (const Json& corner : hal::list_of(a, "corners"))
      area.corners.push_back({hal::item_of(corner, 0), hal::item_of(corner, 1)});
    if (area.corners.size() > 2) all.push_back(std::move(area));
  }
  return all;
}

Json to_json(const std::vector<Drawing::Area>& areas) {
  Json all = Json::array();
  for (const Drawing::Area& area : areas) {
    const char* const kind = area.kind == Drawing::Area::Kind::Fence     ? "fence"
                             : area.kind == Drawing::Area::Kind::KeepOut ? "keep_out"
                                                                         : "zone";
    Json json = {{"kind", kind}, {"id", area.id}, {"from", area.from_m}, {"to", area.to_m}, {"corners", Json::array()}};
    for (const Drawing::Point& p : area.corners) json["corners"].push_back({p.x_m, p.y_m});
    if (area.max_speed_m_s > 0.0) json["max_speed"] = area.max_speed_m_s;
    all.push_back(std::move(json));
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
  drawing.areas = areas_of_json(hal::list_of(record.moments().start(), "areas"));
  return drawing;
}

PictureLook::Area arena_of(const Space& space) {
  const double half_x_m = 0.5 * space.arena_size_x_m(), half_y_m = 0.5 * space.arena_size_y_m();
  return {space.arena_center_x_m() - half_x_m, space.arena_center_y_m() - half_y_m, space.arena_center_x_m() + half_x_m,
          space.arena_center_y_m() + half_y_m};
}

}  // namespace tandem::core
