// A distance scanner: range sensors on a ring that turns about the robot's vertical axis.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "hal/port.hpp"

namespace tandem::hal {

/// A range sensor of a scanner.
struct ScannerHead {
  double bearing_rad = 0.0;  ///< where it looks while the scanner is at angle 0
  double min_m = 0.0;        ///< nearest and farthest distance that it measures, from the robot's axis
  double max_m = 0.0;
  void describe(ParamVisitor& v) {
    v.number("bearing", bearing_rad, unit::deg, kAny, "Where it looks while the scanner is at angle 0.");
    v.number("min", min_m, unit::m, kNotNegative, "Nearest distance that it measures, from the robot's axis.");
    v.number("max", max_m, unit::m, kNotNegative, "Farthest distance.");
  }
};

/// The scanner: four heads on a ring with a motor.
struct ScannerPart {
  static constexpr std::string_view kName = "distance_scanner";
  static constexpr std::string_view kDoc = "Range sensors on a ring that turns about the robot's axis.";
  static constexpr std::size_t kHeads = 4;
  double height_m = 0.0;
  double turn_rad_s = 0.0;  ///< fastest turn
  double rate_hz = 0.0;     ///< measurements a second of each head
  std::vector<ScannerHead> heads = {};
  std::string source = {};

  void describe(ParamVisitor& v) {
    v.number("height", height_m, unit::m, kNotNegative, "Of the heads above the ground.");
    v.number("turn", turn_rad_s, unit::rad_s, kNotNegative, "Fastest turn.");
    v.number("rate", rate_hz, unit::hz, kNotNegative, "Measurements a second of each head.");
    v.list("head", heads, "A head; short distances and long ones by turns.");
    v.text("source", source, "Where these figures come from.");
  }
  std::string flaw() const {
    if (heads.size() != kHeads) return "has " + std::to_string(heads.size()) + " heads; give it 4";
    const auto blind = [](const ScannerHead& head) { return !(head.min_m < head.max_m); };
    const bool any = std::any_of(heads.begin(), heads.end(), blind);
    return any ? "has a head that measures no distance; give each a min below its max" : "";
  }
  /// A dark drum.
  void appear(const RobotKind& kind, Appearance& look) const {
    const double r = kind.body.radius_m, half_m = 0.1 * r;
    look.links.push_back(round_piece("cylinder", "#2b2f35", 0.0, 0.0, 0.55 * r, height_m - half_m, height_m + half_m));
  }
};

/// Drive mode of a scanner. The numbers are part of the port.
enum class ScannerMode : std::uint8_t {
  Off = 0,      ///< it stays where it is and measures nothing
  Speed = 1,    ///< it turns with `speed_rad_s`
  Position = 2  ///< it goes to `angle_rad` by the shorter way
};

/// Command of the scanner. Angles are relative to the body, counter-clockwise from forward. Safe value: off.
struct ScannerDrive : Command {
  static constexpr std::string_view kName = "distance_scanner";
  static constexpr std::string_view kDoc = "How the distance scanner is to turn.";

  ScannerMode mode = ScannerMode::Off;
  double speed_rad_s = 0.0;  ///< in mode Speed
  double angle_rad = 0.0;    ///< in mode Position

  void turn_off() noexcept { *this = {}; }
  void turn(double rad_s) noexcept {
    mode = ScannerMode::Speed;
    speed_rad_s = rad_s;
  }
  void go_to(double rad) noexcept {
    mode = ScannerMode::Position;
    angle_rad = rad;
  }
  using LimitedBy = ScannerPart;
  Limited limit(const ScannerPart& scanner) noexcept {
    return limit_turn(*this, ScannerMode::Position, scanner.turn_rad_s);
  }
  void describe(FieldList& f) const {
    f.add("mode", mode, unit::none, Frame::None, Fusion::Real, "0 off, 1 speed, 2 position");
    f.add("speed", speed_rad_s, unit::rad_s, Frame::Body, Fusion::Real, "turn rate, counter-clockwise from above");
    f.add("angle", angle_rad, unit::rad, Frame::Body, Fusion::Real, "where to turn to, counter-clockwise from forward");
  }
};

/// Measurements of each head during the last tick, oldest first. Heads 0 and 2 see short distances, 1 and 3 long ones;
/// at angle 0 they look forward, left, back, right. Distances are from the robot's axis. Where a head sees nothing it
/// reads the most that it can measure, where something is too near the least.
struct DistanceScanner : Reading {
  static constexpr std::string_view kName = "distance_scanner";
  static constexpr std::string_view kDoc = "Distances that the scanner's four heads measured during the last tick.";
  static constexpr std::size_t kHeads = ScannerPart::kHeads;
  static constexpr std::size_t kSamples = 6;  ///< of one head in one tick, at most

  std::uint32_t count = 0;    ///< entries in use, of all heads together: the first are head 0's
  std::uint32_t samples = 0;  ///< of each head; count is kHeads times this
  float short_min_m = 0.0F, short_max_m = 0.0F;
  float long_min_m = 0.0F, long_max_m = 0.0F;
  float turn_rad = 0.0F;                              ///< of the scanner on the body, at the end of the tick
  std::array<float, kHeads * kSamples> angle_rad{};   ///< where the head looked: in the body frame
  std::array<float, kHeads * kSamples> distance_m{};  ///< from the robot's axis

  static constexpr bool is_short(std::size_t head) noexcept { return head % 2 == 0; }
  std::size_t at(std::size_t head, std::size_t sample) const noexcept { return head * samples + sample; }
  float angle(std::size_t head, std::size_t sample) const noexcept { return angle_rad[at(head, sample)]; }
  float distance(std::size_t head, std::size_t sample) const noexcept { return distance_m[at(head, sample)]; }
  bool too_near(std::size_t head, std::size_t sample) const noexcept {
    return distance(head, sample) <= (is_short(head) ? short_min_m : long_min_m);
  }
  bool sees_nothing(std::size_t head, std::size_t sample) const noexcept {
    return distance(head, sample) >= (is_short(head) ? short_max_m : long_max_m);
  }
  /// Shortens each distance to the nearest that a head of the same sort measured in `other` in about the same
  /// direction: within half of what `other` turned from one measurement to the next, at least kSameWay_rad. The two
  /// need not have measured equally often, nor begin at the same angle.
  void merge(const DistanceScanner& other) noexcept {
    const std::size_t theirs = std::min<std::size_t>(other.samples, kSamples);
    const std::size_t ours = std::min<std::size_t>(samples, kSamples);
    if (theirs == 0) return;
    const float step_rad = theirs > 1 ? std::fabs(turned(other.angle(0, 1), other.angle(0, 0))) : 0.0F;
    const float within_rad = std::max(kSameWay_rad, 0.5F * step_rad + 1e-4F);
    for (std::size_t head = 0; head < kHeads; ++head) {
      for (std::size_t i = 0; i < ours; ++i) {
        float& mine = distance_m[at(head, i)];
        for (std::size_t k = head % 2; k < kHeads; k += 2) {
          for (std::size_t j = 0; j < theirs; ++j) {
            const bool same_way = std::fabs(turned(other.angle(k, j), angle(head, i))) <= within_rad;
            if (same_way) mine = std::min(mine, other.distance(k, j));
          }
        }
      }
    }
  }
  void describe(FieldList& f) const {
    f.add("count", count, unit::none, Frame::None, Fusion::Real, "measurements of all heads");
    f.add("samples", samples, unit::none, Frame::None, Fusion::Real, "measurements of each head");
    f.add("short_min", short_min_m, unit::m, Frame::None, Fusion::Real, "heads 0 and 2 read this where too near");
    f.add("short_max", short_max_m, unit::m, Frame::None, Fusion::Real, "heads 0 and 2 read this where nothing is");
    f.add("long_min", long_min_m, unit::m, Frame::None, Fusion::Real, "heads 1 and 3 read this where too near");
    f.add("long_max", long_max_m, unit::m, Frame::None, Fusion::Real, "heads 1 and 3 read this where nothing is");
    f.add("turn", turn_rad, unit::rad, Frame::Body, Fusion::Real, "of the scanner, counter-clockwise from forward");
    f.add("angle", angle_rad, unit::rad, Frame::Body, Fusion::Real, "where the head looked").used_by = "count";
    f.add("distance", distance_m, unit::m, Frame::Body, Fusion::ByAngle, "from the robot's axis").used_by = "count";
  }

 private:
  static constexpr float kSameWay_rad = 0.05F;  // 3 degrees: at 1.5 m what an e-puck hides to both sides of its axis

  static float turned(float to_rad, float from_rad) noexcept {
    return std::remainder(to_rad - from_rad, 2.0F * std::numbers::pi_v<float>);
  }
};

}  // namespace tandem::hal
