// Comparisons of cameras, distance scanners and ground sensors, for the parts of sensors and of noise.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "validate/row.hpp"

namespace tandem::validate {

/// A light and a camera in whose reach it is, or which says that it sees it.
struct Sighting {
  enum class Camera { AllAround, Ahead, Up, Down };
  Camera camera = Camera::AllAround;
  std::optional<bool> should;     ///< whether it is in sight; nothing where the line passes by an edge
  bool found = false;             ///< the camera sees it
  std::array<double, 2> error{};  ///< of its place, where found: in m along two axes, or in pixels
  bool inside = true;             ///< farther than 8 pixels from the border of the image
};
/// What cameras with that implementation see of foot-bots and eye-bots whose lights all have colours of their own.
/// `strangers`: blobs of colours that no light has.
std::vector<Sighting> sightings(const std::string& implementation, std::uint64_t seed, int ticks,
                                std::size_t& strangers);
Table camera_table(Depth depth);

/// What a ground sensor reads, and the shade of the pixel beneath it.
struct Shade {
  double read = 0.0, is = 0.0;
  bool edge = false;  ///< between two pixels
};
std::vector<Shade> shades(const std::string& implementation, std::uint64_t seed, int ticks);
Row floor_row(Depth depth);

/// A measurement of a distance scanner whose ring turns steadily, and what it should be.
struct Echo {
  double read_m = 0.0, is_m = 0.0;
  double off_rad = 0.0;  ///< between where the head says that it looked and where it should have
  bool edge = false;     ///< passes by an edge
  bool inside = true;    ///< well between the least and the most that the head measures
};
std::vector<Echo> echoes(const std::string& implementation, std::uint64_t seed, int ticks);
std::vector<Row> scanner_rows(Depth depth);

}  // namespace tandem::validate
