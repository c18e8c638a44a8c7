#include "core/view/povray.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "hal/program.hpp"

namespace tandem::core {
namespace {

constexpr double kLeastHeight_m = 0.02;     // of what has none in its data
constexpr double kMostFloorCells = 1000.0;  // along the longer side
constexpr double kFloorShades = 16.0;
constexpr std::size_t kMostFloorRuns = 40'000;  // more take POV-Ray long to read
constexpr double kCameraAngle_deg = 40.0;
constexpr double kTilt_rad = 0.78;          // of the view, below the horizon
constexpr std::size_t kShiningRobots = 60;  // more light sources than that take long

double degrees(double rad) {
  return rad * 180.0 / std::numbers::pi;
}

/// Text of a scene. POV-Ray's y is up; a point (x, y, z) of W is <x, z, y> there.
class Scene {
 public:
  Scene& operator<<(std::string_view text) {
    out_ += text;
    return *this;
  }
  Scene& operator<<(double value) {
    const double rounded = std::round(value * 1e5) / 1e5;
    char digits[40];
    out_.append(digits, std::to_chars(digits, digits + sizeof digits, rounded == 0.0 ? 0.0 : rounded).ptr);
    return *this;
  }
  Scene& point(double x_m, double y_m, double z_m) { return *this << "<" << x_m << ", " << z_m << ", " << y_m << ">"; }
  Scene& color(hal::Rgb c) {
    return *this << "srgb <" << c.r / 255.0 << ", " << c.g / 255.0 << ", " << c.b / 255.0 << ">";
  }
  /// "#rrggbb"
  Scene& color(std::string_view hex) {
    const auto part = [&](std::size_t at) {
      std::uint8_t value = 0;
      std::from_chars(hex.data() + at, hex.data() + at + 2, value, 16);
      return value;
    };
    return color(hal::Rgb{part(1), part(3), part(5)});
  }
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

class Writer {
 public:
  Writer(const Drawing& drawing, const PictureLook& look)
      : d_(drawing), shown_(look.region.value_or(drawing.arena())) {}

  std::string write() {
    s_ << "// " << one_line(d_.title) << "\n// povray +I<this file> +W1200 +H900 +A0.3\n#version 3.7;\n"
       << "global_settings { assumed_gamma 1.0 ambient_light srgb <1, 1, 1> max_trace_level 6 }\n"
       << "background { srgb <0.93, 0.94, 0.96> }\n";
    camera_and_sky();
    textures();
    ground();
    for (const Drawing::Area& area : d_.areas) this->area(area);
    things();
    for (const LightSource& light : d_.lights) lamp(light);
    for (std::size_t k = 0; k < d_.kinds.size(); ++k) declare(k);
    for (const Drawing::Robot& robot : d_.robots) {
      if (shows(robot.x_m, robot.y_m)) this->robot(robot);
    }
    return s_.take();
  }

 private:
  static std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 0x20; }, ' ');
    return text;
  }
  double width_m() const { return shown_.max_x_m - shown_.min_x_m; }
  double depth_m() const { return shown_.max_y_m - shown_.min_y_m; }
  bool shows(double x_m, double y_m) const {
    return x_m >= shown_.min_x_m && x_m <= shown_.max_x_m && y_m >= shown_.min_y_m && y_m <= shown_.max_y_m;
  }

  // As far away as it takes to see all of it.
  void camera_and_sky() {
    const double x_m = 0.5 * (shown_.min_x_m + shown_.max_x_m);
    const double y_m = 0.5 * (shown_.min_y_m + shown_.max_y_m) - 0.04 * depth_m();
    const double half_rad = 0.5 * kCameraAngle_deg * std::numbers::pi / 180.0;
    const double near_m = 0.5 * depth_m() * std::cos(kTilt_rad);
    const double for_width_m = 0.5 * width_m() / std::tan(half_rad) + near_m;
    const double for_depth_m = 0.5 * depth_m() * std::sin(kTilt_rad) / std::tan(0.75 * half_rad) + near_m;
    const double away_m = 1.04 * std::max(for_width_m, for_depth_m);
    s_ << "camera {\n  location ";
    s_.point(x_m, y_m - away_m * std::cos(kTilt_rad), away_m * std::sin(kTilt_rad));
    s_ << "\n  right 4/3*x up y angle " << kCameraAngle_deg << "\n  look_at ";
    s_.point(x_m, y_m, 0.0);
    s_ << "\n}\nlight_source { ";
    s_.point(x_m - 0.7 * away_m, y_m - 0.5 * away_m, 1.6 * away_m);
    s_ << ", srgb <0.86, 0.85, 0.82> area_light ";
    s_.point(0.2 * away_m, 0.0, 0.0) << ", ";
    s_.point(0.0, 0.2 * away_m, 0.0) << ", 3, 3 adaptive 1 jitter }\nlight_source { ";
    s_.point(x_m + away_m, y_m + 0.3 * away_m, 1.2 * away_m) << ", srgb <0.35, 0.37, 0.42> shadowless }\n";
  }

  void textures() {
    s_ << "#declare Body = finish { diffuse 0.75 ambient 0.14 specular 0.25 roughness 0.03 }\n"
       << "#declare Dull = finish { diffuse 0.75 ambient 0.16 }\n#declare Glow = finish { emission 1.4 diffuse 0.2 }\n";
  }

  // A painted floor as squares of one shade, in runs along x.
  void ground() {
    const double x0 = std::max(shown_.min_x_m, d_.min_x_m), x1 = std::min(shown_.max_x_m, d_.max_x_m);
    const double y0 = std::max(shown_.min_y_m, d_.min_y_m), y1 = std::min(shown_.max_y_m, d_.max_y_m);
    const auto slab = [&](double ax, double ay, double bx, double by, double low_m, double high_m, double grey) {
      s_ << "box { ";
      s_.point(ax, ay, low_m) << ", ";
      s_.point(bx, by, high_m) << " pigment { srgb " << grey << " } finish { Dull } }\n";
    };
    slab(x0, y0, x1, y1, -0.02, 0.0, 0.95);
    if (!d_.floor) return;
    const double longer_m = std::max(x1 - x0, y1 - y0);
    double cells = std::clamp(longer_m * d_.floor_pixels_per_m, 1.0, kMostFloorCells);
    std::vector<FloorRun> runs = floor_runs({x0, y0, x1, y1}, longer_m / cells);
    for (; runs.size() > kMostFloorRuns; cells *= 0.7) runs = floor_runs({x0, y0, x1, y1}, longer_m / cells);
    for (const FloorRun& run : runs) slab(run.x0, run.y0, run.x1, run.y1, 0.0, 1e-4, 0.06 + 0.9 * run.level);
  }

  struct FloorRun {
    double x0, y0, x1, y1, level;
  };
  std::vector<FloorRun> floor_runs(const PictureLook::Area& area, double cell_m) const {
    std::vector<FloorRun> runs;
    const auto shade = [&](double x_m, double y_m) {
      return std::round(kFloorShades * std::clamp(d_.floor(x_m, y_m), 0.0, 1.0)) / kFloorShades;
    };
    for (double y_m = area.min_y_m; y_m < area.max_y_m - 1e-9; y_m += cell_m) {
      const double top_m = std::min(y_m + cell_m, area.max_y_m), middle_m = 0.5 * (y_m + top_m);
      for (double x_m = area.min_x_m; x_m < area.max_x_m - 1e-9;) {
        const double level = shade(x_m + 0.5 * cell_m, middle_m);
        double end_m = x_m + cell_m;
        while (end_m < area.max_x_m - 1e-9 && shade(end_m + 0.5 * cell_m, middle_m) == level) end_m += cell_m;
        runs.push_back({x_m, y_m, std::min(end_m, area.max_x_m), top_m, level});
        x_m = end_m;
      }
    }
    return runs;
  }

  void things() {
    for (const Object& o : d_.objects) {
      if (!shows(o.x_m, o.y_m)) continue;
      const bool round = o.kind == Object::Kind::Cylinder;
      const double half_x_m = round ? 0.0 : o.half_x_m, half_y_m = round ? 0.0 : o.half_y_m;
      const double height_m = std::max(o.z_high_m - o.z_low_m, kLeastHeight_m);
      s_ << (round ? "cylinder { " : "box { ");
      s_.point(-half_x_m, -half_y_m, 0.0) << ", ";
      s_.point(half_x_m, half_y_m, height_m);
      if (round) s_ << ", " << o.radius_m;
      s_ << " pigment { " << (o.movable ? "srgb <0.85, 0.70, 0.52>" : "srgb <0.52, 0.56, 0.62>")
         << " } finish { Dull } ";
      place(o.x_m, o.y_m, o.z_low_m, std::atan2(o.sin_h, o.cos_h));
      s_ << " }\n";
    }
  }

  /// A line along its edge, at the height from which it applies; what is to be kept out of, or crossed slowly, is
  /// tinted.
  void area(const Drawing::Area& area) {
    const double line_m = 0.0025 * std::max(width_m(), depth_m());
    const double z_m = area.from_m + line_m;
    const std::size_t count = area.corners.size();
    s_ << "union { // " << one_line(area.label()) << "\n";
    for (std::size_t i = 0; i < count; ++i) {
      const Drawing::Point &a = area.corners[i], &b = area.corners[(i + 1) % count];
      s_ << "  sphere { ";
      s_.point(a.x_m, a.y_m, z_m) << ", " << line_m << " }\n  cylinder { ";
      s_.point(a.x_m, a.y_m, z_m) << ", ";
      s_.point(b.x_m, b.y_m, z_m) << ", " << line_m << " }\n";
    }
    s_ << "  pigment { ";
    s_.color(area.color()) << " } finish { Dull } no_shadow }\n";
    if (area.kind == Drawing::Area::Kind::Fence) return;
    s_ << "prism { linear_spline " << area.from_m + 1e-3 << ", " << area.from_m + 2e-3 << ", "
       << static_cast<double>(count + 1);
    for (std::size_t i = 0; i <= count; ++i)
      s_ << ", <" << area.corners[i % count].x_m << ", " << area.corners[i % count].y_m << ">";
    s_ << " pigment { ";
    s_.color(area.color()) << " transmit 0.8 } finish { Dull } no_shadow }\n";
  }

  /// Turns counter-clockwise, seen from above: the axes of W are right-handed, POV-Ray's are not.
  void place(double x_m, double y_m, double z_m, double heading_rad) {
    s_ << "rotate -y*" << degrees(heading_rad) << " translate ";
    s_.point(x_m, y_m, z_m);
  }

  void lamp(const LightSource& light) {
    const double radius_m = 0.012 * std::max(width_m(), depth_m());
    const double z_m = std::max(light.z_m, radius_m);
    s_ << "light_source { ";
    s_.point(light.x_m, light.y_m, z_m) << ", ";
    s_.color(light.color) << "*0.6 fade_distance " << 0.15 * std::max(width_m(), depth_m())
                          << " fade_power 2 looks_like { sphere { 0, " << radius_m << " pigment { ";
    s_.color(light.color) << " } finish { Glow } } } }\n";
  }

  double body_height_m(const Drawing::Kind& kind) const { return std::max(kind.height_m, 0.4 * kind.radius_m); }

  /// What does not move on a body, at the origin and looking along x.
  void declare(std::size_t number) {
    s_ << "#declare Kind" << static_cast<double>(number) << " = union {\n";
    for (const hal::Appearance::Link& link : d_.kinds[number].look.links) {
      if (stays(link)) this->link(link, number, false);
      if (stays(link)) s_ << " }\n";
    }
    s_ << "}\n";
  }
  static bool stays(const hal::Appearance::Link& link) {
    return link.joint == hal::Appearance::kBody && link.held.row.empty();
  }

  void robot(const Drawing::Robot& r) {
    const Drawing::Kind& kind = d_.kinds[r.kind];
    const double h = body_height_m(kind);
    s_ << "union { object { Kind" << static_cast<double>(r.kind) << " }\n";
    const bool real = std::any_of(d_.real.begin(), d_.real.end(),
                                  [&](const Drawing::RealRobot& other) { return &d_.robots[other.robot] == &r; });
    if (real) {
      s_ << "  torus { " << 1.25 * kind.radius_m << ", " << 0.08 * kind.radius_m
         << " translate y*0.004 pigment { srgb <0.91, 0.35, 0.05> } finish { Glow } }\n";
    }
    links(r, kind);
    for (std::uint32_t i = 0; i < r.lights; ++i) lamp(r, kind, d_.lit[r.first_light + i]);
    if (r.lights > 0 && shining_++ < kShiningRobots) {
      s_ << "  light_source { ";
      s_.point(0.0, 0.0, 1.6 * h) << ", ";
      s_.color(d_.lit[r.first_light].color)
          << "*0.9 fade_distance " << 1.2 * kind.radius_m << " fade_power 2 shadowless }\n";
    }
    s_ << "  ";
    place(r.x_m, r.y_m, r.z_m, r.heading_rad);
    s_ << " }\n";
  }

  void links(const Drawing::Robot& r, const Drawing::Kind& kind) {
    std::size_t held = kind.look.joints.size();
    for (const hal::Appearance::Link& link : kind.look.links) {
      const bool holds = !link.held.row.empty() && d_.values[r.first_value + held++] != 0.0;
      if (stays(link)) continue;
      this->link(link, r.kind, holds);
      moved(r, kind, link.joint);
      s_ << " }\n";
    }
  }

  /// Its form and paint; the brace is left open for where it goes.
  void link(const hal::Appearance::Link& link, std::size_t kind, bool holds) {
    const hal::Appearance::Point &low = link.low_m, &high = link.high_m;
    const double x_m = 0.5 * (low[0] + high[0]), y_m = 0.5 * (low[1] + high[1]), z_m = 0.5 * (low[2] + high[2]);
    const double half_x_m = 0.5 * (high[0] - low[0]), half_y_m = 0.5 * (high[1] - low[1]);
    const double half_z_m = 0.5 * (high[2] - low[2]);
    const auto upright = [&](double radius_m) {
      s_ << "cylinder { ";
      s_.point(0.0, 0.0, -half_z_m) << ", ";
      s_.point(0.0, 0.0, half_z_m) << ", " << radius_m;
    };
    const auto box = [&](double left_m) {
      s_ << "box { ";
      s_.point(-half_x_m, left_m, -half_z_m) << ", ";
      s_.point(half_x_m, half_y_m, half_z_m);
    };
    s_ << "  ";
    if (link.shape == "cylinder" && half_y_m < half_x_m) {
      s_ << "intersection { ";
      upright(half_x_m);
      s_ << " } ";
      box(-half_y_m);
      s_ << " }";
    } else if (link.shape == "cylinder") {
      upright(half_x_m);
    } else if (link.shape == "ring") {
      s_ << "difference { ";
      upright(half_x_m);
      s_ << " } cylinder { ";
      s_.point(0.0, 0.0, -2.0 * half_z_m) << ", ";
      s_.point(0.0, 0.0, 2.0 * half_z_m) << ", " << 0.88 * half_x_m << " }";
    } else if (link.shape == "wheel") {
      s_ << "cylinder { ";
      s_.point(0.0, -half_y_m, 0.0) << ", ";
      s_.point(0.0, half_y_m, 0.0) << ", " << half_x_m;
    } else if (link.shape == "ball") {
      s_ << "sphere { 0, 1 scale ";
      s_.point(half_x_m, half_y_m, half_z_m);
    } else if (link.shape == "shield" || link.shape == "arrow") {
      outline(link.shape, half_x_m, half_y_m, half_z_m);
    } else {
      box(-half_y_m);
    }
    s_ << " pigment { ";
    if (holds)
      s_ << "srgb 0.15";
    else
      s_.color(link.color.empty() ? std::string_view(body_colors(kind).fill) : std::string_view(link.color));
    s_ << " } finish { Body } rotate -y*" << degrees(link.turned_rad) << " translate ";
    s_.point(x_m, y_m, z_m);
  }

  /// A prism: flat behind and an arc ahead, or an arrow.
  void outline(std::string_view shape, double half_x_m, double half_y_m, double half_z_m) {
    std::vector<std::pair<double, double>> corners = {{-half_x_m, -half_y_m}};
    if (shape == "arrow") {
      corners.insert(corners.end(), {{half_x_m, 0.0}, {-half_x_m, half_y_m}, {-0.5 * half_x_m, 0.0}});
    } else {
      for (int i = -6; i <= 6; ++i)
        corners.emplace_back(half_x_m - 0.4 * half_y_m * (i / 6.0) * (i / 6.0), half_y_m * i / 6.0);
      corners.emplace_back(-half_x_m, half_y_m);
    }
    s_ << "prism { linear_spline " << -half_z_m << ", " << half_z_m << ", " << static_cast<double>(corners.size() + 1);
    corners.push_back(corners.front());
    for (const auto& [x_m, y_m] : corners) s_ << ", <" << x_m << ", " << y_m << ">";
  }

  /// As the joints do that it sits on, the nearest first.
  void moved(const Drawing::Robot& r, const Drawing::Kind& kind, int joint) {
    for (; joint != hal::Appearance::kBody; joint = kind.look.joints[static_cast<std::size_t>(joint)].parent) {
      const hal::Appearance::Joint& j = kind.look.joints[static_cast<std::size_t>(joint)];
      const double by = j.scale * d_.values[r.first_value + static_cast<std::size_t>(joint)];
      if (j.slides) {
        s_ << " translate ";
        s_.point(by * j.axis[0], by * j.axis[1], by * j.axis[2]);
        continue;
      }
      s_ << " translate ";
      s_.point(-j.at_m[0], -j.at_m[1], -j.at_m[2]) << " ";
      turned(j.axis, by);
      s_ << " translate ";
      s_.point(j.at_m[0], j.at_m[1], j.at_m[2]);
    }
  }

  /// About an axis of length 1 [Rodrigues' formula]; rows of the matrix are where POV-Ray's axes go.
  void turned(const hal::Appearance::Point& axis, double rad) {
    const double c = std::cos(rad), s = std::sin(rad);
    const auto at = [&](std::size_t row, std::size_t column) {
      const double cross = row == column                 ? 0.0
                           : (column + 3 - row) % 3 == 1 ? -axis[3 - row - column]
                                                         : axis[3 - row - column];
      return (row == column ? c : 0.0) + (1.0 - c) * axis[row] * axis[column] + s * cross;
    };
    s_ << "matrix <";
    for (const std::size_t column : {0U, 2U, 1U})
      s_ << at(0, column) << ", " << at(2, column) << ", " << at(1, column) << ", ";
    s_ << "0, 0, 0>";
  }

  void lamp(const Drawing::Robot& r, const Drawing::Kind& kind, const Drawing::LitLamp& lit) {
    const hal::Appearance::Lamp& mount = kind.look.lamps[lit.lamp];
    const bool beacon = std::hypot(mount.at_m[0], mount.at_m[1]) < 1e-6;  // it shines to all sides
    const double wide_m = (beacon ? 0.42 : 0.1) * kind.radius_m, high_m = (beacon ? 0.09 : 0.1) * kind.radius_m;
    s_ << "  sphere { 0, 1 scale ";
    s_.point(wide_m, wide_m, high_m) << " pigment { ";
    s_.color(lit.color) << " } finish { Glow } translate ";
    s_.point(mount.at_m[0], mount.at_m[1], mount.at_m[2] > 0.0 ? mount.at_m[2] : 0.6 * body_height_m(kind));
    moved(r, kind, mount.joint);
    s_ << " }\n";
  }

  const Drawing& d_;
  PictureLook::Area shown_;
  Scene s_;
  std::size_t shining_ = 0;
};

}  // namespace

std::string to_povray(const Drawing& drawing, const PictureLook& look) {
  return Writer(drawing, look).write();
}

hal::Status can_render_povray() {
  if (!hal::find_program("povray").empty()) return {};
  return hal::Error{
      "scenes are rendered by povray, which is not installed: sudo apt-get install povray; or write the scene alone, "
      "'FILE.pov'"};
}

hal::Status render_povray(const std::string& scene, const std::string& png, int width_px) {
  if (const hal::Status can = can_render_povray(); !can.ok()) return can;
  auto povray = hal::Program::start(hal::find_program("povray"),
                                    {"-D", "-V", "-GA", "+FN", "+A0.3", "+W" + std::to_string(width_px),
                                     "+H" + std::to_string(width_px * 3 / 4), "+I" + scene, "+O" + png});
  if (!povray.ok()) return povray.error();
  const hal::Status ended = povray.value()->finish();
  return ended.ok() ? ended : hal::Status(hal::Error{"scene '" + scene + "': " + ended.error().message});
}

}  // namespace tandem::core
