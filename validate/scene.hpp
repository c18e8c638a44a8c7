// Scenes of the validation: an experiment, what is done in it, what is measured and with which closed form it is
// compared. They are data, in validate/scenes, and experiments by themselves in validate/experiments; the program
// carries both.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/carried_file.hpp"
#include "hal/element.hpp"
#include "hal/result.hpp"
#include "validate/closed_forms.hpp"

namespace tandem::validate {

/// Those of validate/scenes and validate/experiments, by their paths in validate. Written by the build.
std::span<const hal::CarriedFile> scene_files();

/// The text of the file of that name. @throws std::out_of_range when there is none: the program's own mistake
inline std::string scene_text(std::string_view name) {
  return hal::carried_text(scene_files(), name);
}

/// A velocity that an object has at the start.
struct Push {
  std::string id;
  std::array<double, 3> velocity_m_s{};
};

/// Speeds of a robot's wheels, from the start until `until_s`, then 0.
struct Drive {
  std::string id;
  double left_m_s = 0.0, right_m_s = 0.0;
  double until_s = 1e9;
};

/// What a robot that flies is told, from the start on: a place, a thrust along its axis (in parts of its weight,
/// leaning forward by `pitch_rad`), or a velocity.
struct Flight {
  std::string id;
  std::optional<std::array<double, 3>> to_m;
  std::optional<double> thrust;
  double pitch_rad = 0.0;
  std::array<double, 3> velocity_m_s{};
  double turn_rad_s = 0.0;
  double until_s = 1e9;  ///< from when on it is to have no velocity
};

/// One varied setting, all others fixed; a run for each value.
struct Series {
  std::string engine;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< of the engine
  std::vector<std::pair<std::string, double>> figures;          ///< given otherwise than in the scene
  std::string over;                                             ///< "ticks" (a second), or an attribute of the engine
  std::vector<double> values;
  // The contract. In the unit of the scene.
  std::optional<double> within;  ///< error at the last value
  std::optional<double> worst;   ///< error at every value
  std::optional<double> order;   ///< least order of convergence over ticks
};

struct Scene {
  std::string name, title, form, measure, of, unit;
  double seconds = 0.0;
  Given given;
  std::vector<Push> pushes;
  std::vector<Drive> drives;
  std::vector<Flight> flights;
  double gather_m_s = 0.0;  ///< with more than 0: all robots drive to the middle, turning towards it
  struct Bisect {
    std::string path;  ///< that `--set` takes
    double low = 0.0, high = 0.0;
    double moved_m = 0.0;
  };
  std::optional<Bisect> bisect;
  hal::Element experiment;  ///< `<tandem>`, without an engine
  std::vector<Series> series;
};

/// Error: what is wrong with it, with its line.
hal::Result<Scene> read_scene(std::string_view name, const std::string& text);

/// The experiment with an engine, as text.
std::string experiment_of(const Scene& scene, const Series& series, double value);

/// 1,000 for "mm" of metres, "mrad" of radians, "g" of kilograms; 100 for "%"; else 1.
double per_si(std::string_view unit);

}  // namespace tandem::validate
