#include "bridges/tracker_emulator/lens.hpp"

#include "hal/input_file.hpp"
#include "hal/json/json.hpp"

namespace tandem::bridges::tracker_emulator {

std::optional<hal::Vector2> Lens::shows(const hal::Vector3& point_W) const noexcept {
  const hal::Vector3 away = point_W - p_W;
  const double ahead = axes_W.col(2).dot(away);
  if (!(ahead > 0.01)) return {};
  const double a = axes_W.col(0).dot(away) / ahead, b = axes_W.col(1).dot(away) / ahead;
  const double square = a * a + b * b;
  if (square > 4.0) return {};
  const double stretch =
      1.0 + distortion[0] * square + distortion[1] * square * square + distortion[4] * square * square * square;
  const double shift_a = 2.0 * distortion[2] * a * b + distortion[3] * (square + 2.0 * a * a);
  const double shift_b = distortion[2] * (square + 2.0 * b * b) + 2.0 * distortion[3] * a * b;
  const hal::Vector2 seen{focal_px[0] * (a * stretch + shift_a) + centre_px[0],
                          focal_px[1] * (b * stretch + shift_b) + centre_px[1]};
  constexpr double kBeside = 0.5;  // of the picture's size
  const double w = static_cast<double>(width), h = static_cast<double>(height);
  const bool near = seen.x() > -kBeside * w && seen.x() < (1.0 + kBeside) * w && seen.y() > -kBeside * h &&
                    seen.y() < (1.0 + kBeside) * h;
  return near ? std::optional(seen) : std::nullopt;
}

hal::Result<Lens> read_lens(const std::string& path) {
  const auto text = hal::read_whole_file(path, "--camera: the file");
  if (!text.ok()) return text.error();
  const auto parsed = hal::parse_json_object(text.value());
  if (!parsed.ok()) return hal::Error{"--camera: '" + path + "': " + parsed.error().message};
  Lens lens;
  try {
    const hal::Json& seen = parsed.value().at("lens");
    const hal::Json& place = parsed.value().at("arena");
    lens.width = seen.at("size_px").at(0).get<std::size_t>();
    lens.height = seen.at("size_px").at(1).get<std::size_t>();
    lens.focal_px = seen.at("focal_px").get<std::array<double, 2>>();
    lens.centre_px = seen.at("centre_px").get<std::array<double, 2>>();
    lens.distortion = seen.at("distortion").get<std::array<double, 5>>();
    lens.p_W = hal::vector_of(place.at("position_m").get<std::array<double, 3>>());
    lens.axes_W =
        hal::quaternion_of(place.at("quaternion_wxyz").get<std::array<double, 4>>()).normalized().toRotationMatrix();
  } catch (const hal::JsonError& e) {
    return hal::Error{"--camera: '" + path + "' is no file of a camera that hangs somewhere: " + e.what()};
  }
  if (lens.width == 0 || lens.height == 0 || lens.width > 16384 || lens.height > 16384)
    return hal::Error{"--camera: '" + path + "' has a size that no picture has"};
  return lens;
}

}  // namespace tandem::bridges::tracker_emulator
