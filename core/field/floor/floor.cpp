#include "core/field/floor/floor.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/scenario/field_type.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

struct Settings {
  std::string id, source = "none", path;
  double pixels_per_m = 200.0;
  void describe(hal::ParamVisitor& v) {
    static constexpr std::array<std::string_view, 3> kSources = {"none", "image", "loop_functions"};
    v.text("id", id, "Name.");
    v.choice("source", source, kSources,
             "Where the floor's shade comes from: even grey, a PNG image, or a hook's floor().");
    v.text("path", path, "The PNG image, laid over the whole arena, its top to the north (+y).");
    v.number(
        "pixels_per_meter", pixels_per_m, hal::unit::none, {0.01, 10000.0},
        "Resolution of a floor painted by a hook; where nothing is said a floor of more than 4 million pixels gets "
        "fewer, down to 100 per metre.");
  }
};

/// Of a hook's floor whose element does not say it: painting takes a call of the hook a pixel.
double usual_pixels_per_m(const FieldArea& area) {
  constexpr double kMost = 200.0, kLeast = 100.0, kPixels = 4e6;
  return std::clamp(std::sqrt(kPixels / (area.size_x_m * area.size_y_m)), kLeast, kMost);
}

std::string too_many_pixels(const FieldArea& area, double per_m) {
  const double area_m2 = area.size_x_m * area.size_y_m;
  if (area_m2 * per_m * per_m <= Raster::kMostPixels) return "";
  return "the floor would have " + std::to_string(std::llround(area.size_x_m * per_m)) + " x " +
         std::to_string(std::llround(area.size_y_m * per_m)) +
         " pixels, at most 100 million can be painted: choose pixels_per_meter=\"" +
         hal::format_number(std::floor(100.0 * std::sqrt(Raster::kMostPixels / area_m2)) / 100.0) + "\" or less";
}

std::unique_ptr<Field> make_floor(const Element& element, const FieldArea& area, Problems& problems) {
  auto settings = read_settings<Settings>(element, problems);
  if (element.attribute("pixels_per_meter") == nullptr) settings.pixels_per_m = usual_pixels_per_m(area);
  const RasterArea rectangle{area.min_x_m, area.min_y_m, area.size_x_m, area.size_y_m};
  std::string problem;
  Raster picture;
  if (settings.source == "image") {
    const auto loaded = settings.path.empty() ? hal::Error{"with source=\"image\" needs the attribute 'path'"}
                                              : Raster::from_png(settings.path, rectangle);
    if (loaded.ok())
      picture = loaded.value();
    else
      problem = "<floor> " + loaded.error().message;
  }
  const bool by_hooks = settings.source == "loop_functions";
  if (by_hooks) problem = too_many_pixels(area, settings.pixels_per_m);
  if (!problem.empty()) problems.push_back(problem_at(element, problem));
  const float bare = element.argos ? 1.0F : FloorField::kGrey;  // ARGoS' loop functions paint white by themselves
  return std::make_unique<FloorField>(rectangle, by_hooks ? settings.pixels_per_m : 0.0, std::move(picture), bare);
}

}  // namespace

void FloorField::paint(const Painter& painter) {
  unpainted_ = false;
  raster_ = Raster::painted(area_, pixels_per_m_,
                            [&](double x_m, double y_m) { return painter(x_m, y_m, static_cast<double>(bare_)); });
}

std::shared_ptr<const void> FloorField::keep() const {
  return std::make_shared<const Kept>(Kept{raster_, unpainted_});
}

void FloorField::put_back(const std::shared_ptr<const void>& kept) {
  const Kept& was = *static_cast<const Kept*>(kept.get());
  raster_ = was.raster;
  unpainted_ = was.unpainted;
}

void register_floor(hal::Registrar& registrar) {
  static constexpr FieldType kType{"floor", "The floor's shade, 0 black to 1 white.",
                                   [](hal::ParamVisitor& v) { Settings{}.describe(v); }, &make_floor};
  registrar.add(kType);
}

}  // namespace tandem::core
