#include "app/view/projector_fit.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "hal/output_file.hpp"

namespace tandem::app {
namespace {

using hal::Json;
constexpr double kFarthest = 10.0;  // windows beside the window

/// Four corners that go once around.
bool is_sound(const Json& corners) {
  if (!corners.is_array() || corners.size() != 4) return false;
  std::array<std::array<double, 2>, 4> p{};
  for (std::size_t i = 0; i < 4; ++i) {
    if (!corners[i].is_array() || corners[i].size() != 2) return false;
    for (std::size_t k = 0; k < 2; ++k) {
      if (!corners[i][k].is_number()) return false;
      p[i][k] = corners[i][k].get<double>();
      if (!(std::abs(p[i][k]) <= kFarthest)) return false;
    }
  }
  int left = 0, right = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto &a = p[i], &b = p[(i + 1) % 4], &c = p[(i + 2) % 4];
    const double turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
    left += turn < 0.0 ? 1 : 0;
    right += turn > 0.0 ? 1 : 0;
  }
  return left == 4 || right == 4;
}

}  // namespace

ProjectorFit::ProjectorFit(const std::string& experiment)
    : file_(std::filesystem::path(experiment).replace_extension(".projector.json").string()) {
  std::ifstream in(file_);
  std::ostringstream text;
  text << in.rdbuf();
  const auto kept = hal::parse_json_object(text.str());
  if (!kept.ok()) return;
  const auto corners = kept.value().find("corners");
  if (corners != kept.value().end() && is_sound(*corners)) corners_ = *corners;
}

Json ProjectorFit::message() const {
  return {{"type", "projector"}, {"corners", corners_}};
}

hal::Status ProjectorFit::take(const Json& command) {
  const auto corners = command.find("corners");
  if (corners == command.end() || !is_sound(*corners))
    return hal::Error{
        "\"corners\" are four pairs of numbers, once around the arena: north-west, north-east, "
        "south-east, south-west"};
  corners_ = *corners;
  return hal::write_whole_file(file_, "where the projector shows the arena",
                               hal::to_text({{"corners", corners_}}) + "\n");
}

}  // namespace tandem::app
