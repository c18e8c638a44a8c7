#include "app/window/projector_fit.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "hal/input_file.hpp"
#include "hal/output_file.hpp"
#include "hal/sha256.hpp"

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

std::string projector_file(const std::string& experiment) {
  namespace fs = std::filesystem;
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  fs::path folder;
  if (state != nullptr && *state != 0)
    folder = state;
  else if (home != nullptr && *home != 0)
    folder = fs::path(home) / ".local" / "state";
  else
    return {};
  std::error_code error;
  const fs::path path = fs::weakly_canonical(experiment, error);
  constexpr std::size_t kDigits = 12;
  const std::string digits = hal::sha256((error ? fs::path(experiment) : path).string()).substr(0, kDigits);
  return folder / "tandem" / "projector" / (path.stem().string() + "-" + digits + ".json");
}

ProjectorFit::ProjectorFit(const std::string& experiment) : file_(projector_file(experiment)) {
  constexpr std::size_t kMostBytes = std::size_t{64} << 10;
  const auto text = hal::read_whole_file(file_, "the corners", kMostBytes);
  if (!text.ok()) return;
  const auto kept = hal::parse_json_object(text.value());
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
  if (file_.empty()) return hal::Error{"the corners count, and are not kept: neither XDG_STATE_HOME nor HOME is set"};
  std::error_code error;  // told by who writes
  std::filesystem::create_directories(std::filesystem::path(file_).parent_path(), error);
  return hal::write_whole_file(file_, "where the projector shows the arena",
                               hal::to_text({{"corners", corners_}}) + "\n");
}

}  // namespace tandem::app
