// Accelerometers: the specific force on a body, from how its velocity changed within the tick.
#include <cmath>

#include "core/device/each_robot.hpp"
#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "hal/device/body_sensors.hpp"
#include "hal/elementary.hpp"
#include "hal/vector.hpp"

namespace tandem::core {
namespace {

constexpr double kGravity_m_s2 = 9.81;  // of bodies in no engine's region
constexpr double kLongestWay_m = 0.2;   // in a tick: farther away a body was put, and did not move
constexpr double kNoTurn = 1e-9;        // sine of half an angle below which nothing turned

constexpr ErrorText kForceNoise{"noise_level", 200 * 1e-3, hal::unit::m_s2, hal::kNotNegative,
                                "Standard deviation on each axis."};
using ForceNoise = OneError<kForceNoise>;

/// A body's velocity, and its attitude at the same moment.
struct MotionBefore {
  static constexpr std::string_view kName = "motion_before";
  static constexpr std::string_view kDoc = "Motion of robots with accelerometers, a tick ago.";

  bool seen = false;  ///< the rest is known
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, heading_rad = 0.0;
  std::array<double, 3> v_m_s{};
  std::array<double, 4> q_WB{1.0, 0.0, 0.0, 0.0};

  void describe(hal::FieldList& f) const {
    f.add("seen", seen, hal::unit::none, "the rest is known");
    f.add("x", x_m, hal::unit::m, "in W");
    f.add("y", y_m, hal::unit::m, "in W");
    f.add("z", z_m, hal::unit::m, "in W");
    f.add("heading", heading_rad, hal::unit::rad, "in W");
    f.add("v", v_m_s, hal::unit::m_s, "in W");
    f.add("q_WB", q_WB, hal::unit::none, "w, x, y, z; when the body had this velocity");
  }
};

/// sin(a) / a.
double sinc(double a) noexcept {
  return std::fabs(a) < 1e-4 ? 1.0 - a * a / 6.0 : hal::sin(a) / a;
}

/// The constant force in the body's frame that changes its velocity from one moment to another, gravity apart, while it
/// turns evenly between both attitudes. Exact on arcs, in free fall and at rest, at any length of tick.
hal::Vector3 specific_force(const MotionBefore& from, const MotionBefore& to, double gravity_m_s2,
                            double tick_s) noexcept {
  const hal::Vector3 mean_W =
      (hal::vector_of(to.v_m_s) - hal::vector_of(from.v_m_s)) / tick_s + hal::Vector3(0.0, 0.0, gravity_m_s2);
  const hal::Quaternion q_from = hal::quaternion_of(from.q_WB);
  hal::Quaternion turn = q_from.conjugate() * hal::quaternion_of(to.q_WB);
  if (turn.w() < 0.0) turn.coeffs() = -turn.coeffs();
  const hal::Vector3 along = turn.vec();
  const double sine = std::sqrt(along.dot(along));
  if (sine < kNoTurn) return q_from.conjugate() * mean_W;
  hal::Quaternion half(1.0 + turn.w(), turn.x(), turn.y(), turn.z());
  half.coeffs() /= std::sqrt(half.coeffs().squaredNorm());
  const hal::Vector3 mean_B = (q_from * half).conjugate() * mean_W;
  // A force that turns with the body adds up to less than one that does not, but for its part along the axis.
  const hal::Vector3 axis = along / sine;
  const hal::Vector3 on_axis = axis * axis.dot(mean_B);
  return on_axis + (mean_B - on_axis) / sinc(hal::atan2(sine, turn.w()));
}

/// Reads at the middle of the body, averaged over the tick. Engines with forces know velocities; of other bodies, and
/// of those that are led from outside, the way within the tick is one.
class AccelerometerSensor final : public EachSensor<AccelerometerSensor, hal::Accelerometer, ForceNoise, MotionBefore> {
 public:
  using Part = hal::AccelerometerPart;

  AccelerometerSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : EachSensor(setup, errors, columns),
        fastest_m_s_(setup.kind.drive() != nullptr ? setup.kind.drive()->max_speed_m_s : 0.0) {}

  void read(const RobotAt& robot, hal::Accelerometer& port) const noexcept {
    MotionBefore& before = kept_[robot.i];
    const MotionBefore now = motion_of(robot.context, robot.row(), before);
    hal::Vector3 force = specific_force(before.seen ? before : at_rest(now), now,
                                        gravity(robot.context.stores, robot.row()), robot.context.tick_s);
    before = now;
    if (errors_.amount > 0.0) {
      const auto bits = robot.draw(Stream::AccelerometerNoise);
      const auto xy = to_normal(bits[0], bits[1]);
      force += errors_.amount * hal::Vector3(xy[0], xy[1], to_normal(bits[2], bits[3])[0]);
    }
    for (int k = 0; k < 3; ++k) port.force_m_s2[static_cast<std::size_t>(k)] = static_cast<float>(force[k]);
  }

 private:
  static double gravity(const SpaceStores& stores, std::size_t row) noexcept {
    const std::uint16_t region = stores.bodies.region[row];
    return region == kNoRegion ? kGravity_m_s2 : stores.regions[region].gravity_m_s2;
  }
  static MotionBefore at_rest(MotionBefore motion) noexcept {
    motion.v_m_s = {};
    return motion;
  }

  MotionBefore motion_of(const DeviceContext& context, std::size_t row, const MotionBefore& last) const noexcept {
    const SpaceStores& s = context.stores;
    const Bodies& b = s.bodies;
    MotionBefore now{true, b.x_m[row], b.y_m[row], s.base_m(row), hal::atan2(b.sin_h[row], b.cos_h[row])};
    const std::uint16_t region = b.region[row];
    const bool known = !b.motion.empty() && region != kNoRegion && s.regions[region].listed;
    if (known && (b.flags[row] & kExternal) == 0) {
      now.v_m_s = b.motion[row].v_m_s;
      now.q_WB = s.regions[region].plane ? hal::array_of(hal::about_z(now.heading_rad)) : b.motion[row].q_WB;
      return now;
    }
    const std::array<double, 3> way_m{now.x_m - last.x_m, now.y_m - last.y_m, now.z_m - last.z_m};
    const double longest_m = std::max(kLongestWay_m, 2.0 * fastest_m_s_ * context.tick_s);
    if (!last.seen || way_m[0] * way_m[0] + way_m[1] * way_m[1] + way_m[2] * way_m[2] > longest_m * longest_m) {
      now.v_m_s = last.v_m_s;
      now.q_WB = last.seen ? last.q_WB : hal::array_of(hal::about_z(now.heading_rad));
      return now;
    }
    // In the middle of the arc it went the way of the chord, and as much faster as the arc is longer.
    const double half_rad = 0.5 * std::remainder(now.heading_rad - last.heading_rad, 2.0 * M_PI);
    const double per_s = 1.0 / (context.tick_s * sinc(half_rad));
    now.v_m_s = {way_m[0] * per_s, way_m[1] * per_s, way_m[2] / context.tick_s};
    now.q_WB = hal::array_of(hal::about_z(last.heading_rad + half_rad));
    return now;
  }

  double fastest_m_s_;
};

}  // namespace

std::vector<DeviceType> accelerometer_types() {
  std::vector<DeviceType> types;
  add_levels<AccelerometerSensor>(types, "From the body's motion; noise where asked for.", "From the body's motion.",
                                  "From the body's motion, with normal noise.");
  return types;
}

}  // namespace tandem::core
