#include "bridges/camera/camera_file.hpp"

#include <cmath>

#include "hal/input_file.hpp"
#include "hal/json/json.hpp"
#include "hal/json/json_access.hpp"
#include "hal/output_file.hpp"

namespace tandem::bridges::camera {
namespace {

/// So many finite numbers; false: they are not there.
template <std::size_t n>
bool read_numbers(const hal::Json& json, const char* name, std::array<double, n>& values) {
  const auto at = json.find(name);
  if (at == json.end() || !at->is_array() || at->size() != n) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (!(*at)[i].is_number()) return false;
    values[i] = (*at)[i].template get<double>();
    if (!std::isfinite(values[i])) return false;
  }
  return true;
}

bool read_lens(const hal::Json& json, Lens& lens) {
  std::array<double, 2> size{}, focal{}, centre{};
  if (!read_numbers(json, "size_px", size) || !read_numbers(json, "focal_px", focal) ||
      !read_numbers(json, "centre_px", centre) || !read_numbers(json, "distortion", lens.distortion))
    return false;
  if (!(size[0] >= 1.0 && size[0] <= 65536.0 && size[1] >= 1.0 && size[1] <= 65536.0 && focal[0] > 0.0 &&
        focal[1] > 0.0))
    return false;
  lens.width = static_cast<std::size_t>(size[0]);
  lens.height = static_cast<std::size_t>(size[1]);
  lens.fx = focal[0];
  lens.fy = focal[1];
  lens.cx = centre[0];
  lens.cy = centre[1];
  return true;
}

}  // namespace

hal::Result<CameraFile> read_camera_file(const std::string& path) {
  const auto text = hal::read_whole_file(path, "the camera's file");
  if (!text.ok()) return hal::Error{text.error().message + "; `tandem calibrate camera -o " + path + "` makes it"};
  const auto parsed = hal::parse_json_object(text.value());
  if (!parsed.ok()) return hal::Error{"the camera's file '" + path + "': " + parsed.error().message};
  const hal::Json& json = parsed.value();
  const hal::Error wrong{"'" + path + "' is no file of a camera, or a number in it makes no sense"};
  const auto lens = json.find("lens");
  CameraFile file;
  if (lens == json.end() || !lens->is_object() || !read_lens(*lens, file.lens)) return wrong;
  file.residual_px = hal::number_of(*lens, "residual_px");
  file.views = static_cast<std::size_t>(std::max(0.0, hal::number_of(*lens, "views")));
  const auto place = json.find("arena");
  if (place == json.end()) return file;
  std::array<double, 3> p{};
  std::array<double, 4> q{};
  if (!place->is_object() || !read_numbers(*place, "position_m", p) || !read_numbers(*place, "quaternion_wxyz", q))
    return wrong;
  file.place = Placement{hal::quaternion_of(q), hal::vector_of(p)};
  if (!(std::fabs(file.place->q_WC.norm() - 1.0) < 1e-3)) return wrong;
  file.place->q_WC.normalize();
  file.place_residual_px = hal::number_of(*place, "residual_px");
  return file;
}

hal::Status write_camera_file(const std::string& path, const CameraFile& file) {
  const Lens& lens = file.lens;
  hal::Json json;
  json["lens"] = {{"size_px", {lens.width, lens.height}}, {"focal_px", {lens.fx, lens.fy}},
                  {"centre_px", {lens.cx, lens.cy}},      {"distortion", lens.distortion},
                  {"residual_px", file.residual_px},      {"views", file.views}};
  if (file.place) {
    json["arena"] = {{"position_m", hal::array_of(file.place->p_WC)},
                     {"quaternion_wxyz", hal::array_of(file.place->q_WC)},
                     {"residual_px", file.place_residual_px}};
  }
  return hal::write_whole_file(path, "camera", hal::to_text(json, 2) + "\n");
}

hal::Result<Camera> read_camera(const std::string& path) {
  const auto read = read_camera_file(path);
  if (!read.ok()) return read.error();
  const CameraFile& file = read.value();
  if (!file.place)
    return hal::Error{"'" + path + "' does not say where the camera hangs; `tandem calibrate arena --camera " + path +
                      "` finds it"};
  return Camera{file.lens, *file.place, std::max(file.residual_px, file.place_residual_px)};
}

}  // namespace tandem::bridges::camera
