// The appearance of a robot beside its body: links, joints that move them, lamps, and the columns that drive these.
//
//   void appear(const RobotKind& kind, Appearance& look) const {          of a part (hal/robot_kind.hpp)
//     look.joints.push_back({.name = "fork", .slides = true, .axis = {0, 0, 1}, .by = {"fork", "height"}});
//     look.links.push_back({.name = "fork", .shape = "fork", .low_m = …, .high_m = …, .on = "fork"});
//   }
//
// Pictures, films, scenes, the window and records show it of every kind.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/params.hpp"

namespace tandem::hal {

class RobotKind;

/// A value that moves or lights something: a field of a port that the robot's controller took, or of what the
/// simulation keeps for the robot. Where the robot has no such row the value is 0.
struct Driver {
  std::string row = {};  ///< "actuator leds"; of what is kept its name alone, as "battery"; empty: nothing drives it
  std::string field = {};
  std::int64_t index = 0;  ///< in the field
  bool as_switch = false;  ///< the value is 1 where the field is other than `off`, and 0 where it is that
  double off = 0.0;

  bool operator==(const Driver&) const = default;
  void describe(ParamVisitor& v);
};

/// Lengths in m and angles in rad, in the body frame: x forward, y left, z up from the ground.
struct Appearance {
  using Point = std::array<double, 3>;
  static constexpr int kBody = -1;

  /// Turns, or slides, what sits on it by the driver's value, counter-clockwise about the axis or along it.
  struct Joint {
    std::string name = {};
    bool slides = false;
    Point at_m = {};  ///< where the axis goes through, as the body stands when all values are 0
    Point axis = {0.0, 0.0, 1.0};
    Driver by = {};
    double scale = 1.0;   ///< of the value
    std::string on = {};  ///< the joint that it sits on; empty: the body
    int parent = kBody;   ///< that joint's number, which is lower than its own; set by `appearance_of`

    bool operator==(const Joint&) const = default;
    void describe(ParamVisitor& v);
  };
  /// A rigid piece, given by the corners of the upright box around it.
  struct Link {
    /// An upright cylinder is as wide as the box is long, and cut flat where the box is narrower. A fork has two prongs
    /// along x; a wheel turns about y; a ring is hollow; the front of a shield is an arc; an arrow points along x.
    static constexpr std::array<std::string_view, 8> kShapes = {"box",  "cylinder", "fork",   "wheel",
                                                                "ball", "ring",     "shield", "arrow"};
    std::string name = {};
    std::string shape = "box";
    Point low_m = {}, high_m = {};
    std::string on = {};
    std::string color = {};   ///< "#rrggbb"; empty: that of the kind
    Driver held = {};         ///< drawn dark and filled while the value is not 0: it holds something
    double turned_rad = 0.0;  ///< about the upright line through its middle
    bool fine = false;        ///< pictures from above leave it out
    int joint = kBody;

    bool operator==(const Link&) const = default;
    void describe(ParamVisitor& v);
  };
  struct Lamp {
    Point at_m = {};
    std::string on = {};
    Driver by = {};          ///< of its red; green and blue are the next two in the field
    std::string color = {};  ///< "#rrggbb"; then the driver only switches it: lit where the value is not 0
    int joint = kBody;

    bool operator==(const Lamp&) const = default;
    void describe(ParamVisitor& v);
  };

  std::vector<Joint> joints;
  std::vector<Link> links;
  std::vector<Lamp> lamps;
  std::string upper = {};  ///< the joint that turns the upper half of the body; empty: none does
  bool whole = false;      ///< the links are all that is seen: body and locomotion add none
  int upper_joint = kBody;

  /// What moves: of each joint, then of each link that holds something, in their order.
  std::vector<const Driver*> drivers() const;
  bool operator==(const Appearance&) const = default;
};

/// A fine link: a piece of a body, for near views.
Appearance::Link piece(std::string_view shape, std::string_view color, Appearance::Point low_m,
                       Appearance::Point high_m);
/// One that is round seen from above, on an axis through (x, y).
Appearance::Link round_piece(std::string_view shape, std::string_view color, double x_m, double y_m, double radius_m,
                             double low_m, double high_m);

/// The looks of body, locomotion and all parts of the kind together, with the numbers of the joints that things sit
/// on. Things on a joint that no part has sit on the body.
Appearance appearance_of(const RobotKind& kind);

/// Whether it is written "#rrggbb".
bool is_color(std::string_view text) noexcept;

/// A part that has looks and does nothing.
struct LookPart {
  static constexpr std::string_view kName = "look";
  static constexpr std::string_view kDoc = "What is seen of the robot beside its body, and what moves it.";
  std::vector<Appearance::Joint> joints = {};
  std::vector<Appearance::Link> links = {};
  std::vector<Appearance::Lamp> lamps = {};
  std::string upper = {};
  bool whole = false;
  std::string source = {};

  void describe(ParamVisitor& v);
  std::string flaw() const;
  void appear(const RobotKind& kind, Appearance& look) const;
};

}  // namespace tandem::hal
