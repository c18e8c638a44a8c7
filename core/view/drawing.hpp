// Contents of a picture as plain data: filled from a space, drawn as SVG.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/space/sketch.hpp"
#include "core/space/space.hpp"
#include "hal/appearance.hpp"
#include "hal/rgb.hpp"

namespace tandem::core {

/// What a picture shows of a drawing, and how large.
struct PictureLook {
  struct Area {
    double min_x_m = 0.0, min_y_m = 0.0, max_x_m = 0.0, max_y_m = 0.0;
  };
  int size_px = 1000;               ///< of the longer side of what is shown
  std::optional<Area> region = {};  ///< only this part of the arena
  double trails_s = 0.0;            ///< where robots were in so many seconds before; 0: no trails
  bool axes = false;                ///< coordinates along the frame
  bool ids = false;                 ///< beside every robot
  bool title = true;
  bool legend = true;  ///< with the scale
  int height_px = 0;   ///< of the page; 0: as high as its contents need
};

/// A space seen from above. Lengths in metres, in W (x east, y north, so up on the picture); headings in radians.
struct Drawing {
  /// One kind of robot, in the legend.
  struct Kind {
    std::string name;
    double radius_m = 0.0;
    hal::Appearance look;
    double height_m = 0.0;
  };
  struct Robot {
    double x_m = 0.0, y_m = 0.0;
    double heading_rad = 0.0;
    std::uint32_t kind = 0;         ///< index into `kinds`
    std::uint32_t first_light = 0;  ///< its lit lamps: `lit[first_light, first_light + lights)`
    std::uint32_t lights = 0;
    bool halted = false;
    double z_m = 0.0;               ///< of its base above the ground
    std::uint32_t first_value = 0;  ///< what moves on it: `values` from there on, in the order of its look's drivers
  };
  struct Point {
    double x_m = 0.0, y_m = 0.0;
    double z_m = 0.0;
  };
  /// Where a robot was: `trail_points[first, first + count)`, the oldest first.
  struct Trail {
    std::size_t robot = 0;  ///< index into `robots`
    std::size_t first = 0, count = 0;
  };
  struct LitLamp {
    std::uint32_t lamp = 0;  ///< of its kind
    hal::Rgb color;
  };
  /// Said of a robot that stands for a real one.
  struct RealRobot {
    std::size_t robot = 0;  ///< index into `robots`
    std::string id;
    std::string state;  ///< what is wrong with it, e.g. "link lost"; empty: all is well
  };
  /// One side of an engine's region.
  struct Border {
    double ax_m = 0.0, ay_m = 0.0, bx_m = 0.0, by_m = 0.0;
    bool wall = false;  ///< else a gate
  };
  /// Where real robots may go, and what they keep from.
  struct Area {
    enum class Kind : std::uint8_t { Fence, KeepOut, Zone };
    Kind kind = Kind::Fence;
    std::string id;
    std::vector<Point> corners;
    double from_m = 0.0, to_m = 0.0;  ///< heights
    double max_speed_m_s = 0.0;       ///< of a zone; 0: it has none

    std::string label() const;       ///< "dock: 0.05 m/s"
    std::string_view color() const;  ///< "#rrggbb"
  };

  PictureLook::Area arena() const { return {min_x_m, min_y_m, max_x_m, max_y_m}; }

  std::string title;
  double min_x_m = -1.0, min_y_m = -1.0, max_x_m = 1.0, max_y_m = 1.0;  ///< the arena
  std::vector<Object> objects;                                          ///< those that are there
  std::vector<Border> borders;
  std::vector<LightSource> lights;  ///< the same
  std::vector<Area> areas;
  std::vector<Kind> kinds;
  std::vector<Robot> robots;
  std::vector<LitLamp> lit;
  std::vector<double> values;
  std::vector<RealRobot> real;
  std::vector<std::string> ids;  ///< of the robots, in their order; empty: not asked for
  std::vector<Trail> trails;
  std::vector<Point> trail_points;
  std::vector<Sketch::Shape> shapes;  ///< that hooks and layers drew
  /// Reflectance at (x, y), 0 black to 1 white; empty: a uniform floor, which is not drawn.
  std::function<double(double, double)> floor;
  std::function<hal::Rgb(double, double)> floor_color;  ///< empty: it is grey
  std::uint64_t floor_mark = 0;                         ///< differs when the floor does
  double floor_pixels_per_m = 200.0;                    ///< finer it is not
};

/// `drawing` as an SVG document. Up to 20,000 robots are drawn with heading and lit LEDs; more of them as dots, in the
/// colour of the LED that is lit. Real robots are always drawn in full.
std::string to_svg(const Drawing& drawing, const PictureLook& look = {});

/// How high that document would be, in pixels.
int svg_height_px(const Drawing& drawing, const PictureLook& look);

/// Makes the floor a copy, which refers to nothing; as fine as `look` shows it.
void keep_floor(Drawing& drawing, const PictureLook& look);

/// Colours of the bodies of a kind, as "#rrggbb".
struct BodyColors {
  std::string_view fill, edge;
};
const BodyColors& body_colors(std::size_t kind);

/// The longest of 1, 2, 5, 10, 20, … (or a decimal fraction of them) that is not above `limit_m`. `limit_m` is
/// positive.
double round_length(double limit_m);

/// "2 m", "50 cm" or "5 mm", as a person would say it.
std::string length_text(double length_m);

}  // namespace tandem::core
