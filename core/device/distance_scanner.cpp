// Distance scanners: the actuator that turns them, and what their heads measured during the tick.
#include "hal/device/distance_scanner.hpp"

#include "core/device/each_robot.hpp"
#include "core/device/far_rays.hpp"
#include "core/device/types.hpp"
#include "core/space/mechanisms.hpp"
#include "core/space/sight.hpp"
#include "hal/angle.hpp"

namespace tandem::core {
namespace {

using hal::DistanceScanner;
using hal::ScannerMode;

// --- actuator ---

constexpr ErrorText kTurnErrors{"noise_std_dev",
                                50 * 1e-3,
                                hal::unit::none,
                                {0.0, 1.0},
                                "Standard deviation of the turn rate's relative error, drawn every tick."};
using TurnErrors = OneError<kTurnErrors>;

class ScannerActuator final : public EachActuator<ScannerActuator, hal::ScannerDrive, TurnErrors, ScannerState> {
 public:
  using Part = hal::ScannerPart;

  ScannerActuator(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : EachActuator(setup, errors, columns), fastest_rad_s_(setup.kind.part<Part>()->turn_rad_s) {}

  void obey(const RobotAt& robot, const hal::ScannerDrive& drive) const noexcept {
    if (led_from_outside(robot.context, robot.i)) return;
    ScannerState& scanner = kept_[robot.i];
    scanner.mode = obeys(robot.context, robot.i) ? drive.mode : ScannerMode::Off;
    scanner.swept_rad = step_rad(robot, scanner, drive);
    scanner.angle_rad = hal::wrapped(scanner.angle_rad + scanner.swept_rad);
  }

 private:
  double step_rad(const RobotAt& robot, const ScannerState& scanner, const hal::ScannerDrive& drive) const noexcept {
    const double tick_s = robot.context.tick_s;
    if (scanner.mode == ScannerMode::Position) {
      const double most_rad = fastest_rad_s_ * tick_s;
      return std::clamp(hal::wrapped(drive.angle_rad - scanner.angle_rad), -most_rad, most_rad);
    }
    if (scanner.mode != ScannerMode::Speed) return 0.0;
    double error = 0.0;
    if (errors_.amount > 0.0) {
      const auto bits = robot.draw(Stream::ScannerDriveNoise);
      error = errors_.amount * to_normal(bits[0], bits[1])[0];
    }
    return drive.speed_rad_s * (1.0 + error) * tick_s;
  }

  double fastest_rad_s_;
};

// --- sensor ---

struct ScanNoise {
  bool show_rays = false;
  hal::Interval noise_range_m = {};
  static ScanNoise noisy() { return {.noise_range_m = hal::Interval::around(100 * 1e-4)}; }
  void describe_always(hal::ParamVisitor& v) {
    v.flag("show_rays", show_rays, "Draw the rays in a view; no effect on readings.");
  }
  void describe(hal::ParamVisitor& v) {
    v.interval("noise_range", noise_range_m, hal::unit::cm, "Uniform noise on each distance.");
  }
};

/// Rays of all heads from the robot's axis. The heads measure evenly through the tick, while the scanner turns; the
/// robot itself is where it is at the tick's end.
class ScannerSensor final : public Sensor {
 public:
  using Port = DistanceScanner;
  using Part = hal::ScannerPart;
  using Errors = ScanNoise;
  using Kept = ScannerState;

  ScannerSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : part_(*setup.kind.part<hal::ScannerPart>()),
        scanners_(columns.find<ScannerState>()),
        middle_m_(static_cast<float>(0.5 * (errors.noise_range_m.least + errors.noise_range_m.most))),
        noise_m_(static_cast<float>(0.5 * (errors.noise_range_m.most - errors.noise_range_m.least))),
        samples_(static_cast<std::uint32_t>(
            std::clamp<double>(std::round(part_.rate_hz * setup.tick_s), 1.0, DistanceScanner::kSamples))) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* scanners = static_cast<DistanceScanner*>(ports);
    const double widest_m = widest_body_m(context.stores);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      DistanceScanner& port = scanners[i];
      stamp(context, port);
      port.short_min_m = static_cast<float>(part_.heads[0].min_m);
      port.short_max_m = static_cast<float>(part_.heads[0].max_m);
      port.long_min_m = static_cast<float>(part_.heads[1].min_m);
      port.long_max_m = static_cast<float>(part_.heads[1].max_m);
      aim(scanners_[i], port);
      if (port.count == 0) continue;
      rays_.look(context.stores, row, widest_m, RealSense::Scanner);
      if (noise_m_ > 0.0F || middle_m_ != 0.0F) add_noise(context, context.stores.bodies.entity[row], port);
      keep_in_range(port);
    }
  }

 private:
  void aim(const ScannerState& scanner, DistanceScanner& port) noexcept {
    port.turn_rad = static_cast<float>(scanner.angle_rad);
    port.samples = scanner.mode == ScannerMode::Off ? 0 : scanner.swept_rad == 0.0 ? 1 : samples_;
    port.count = port.samples * static_cast<std::uint32_t>(DistanceScanner::kHeads);
    rays_.aim(port.count, part_.height_m);
    for (std::size_t head = 0; head < DistanceScanner::kHeads; ++head) {
      for (std::size_t k = 0; k < port.samples; ++k) {
        const double back = scanner.swept_rad * (1.0 - static_cast<double>(k + 1) / port.samples);
        const double angle = hal::wrapped(scanner.angle_rad - back + part_.heads[head].bearing_rad);
        const std::size_t ray = port.at(head, k);
        port.angle_rad[ray] = static_cast<float>(angle);
        rays_.set(ray, angle, part_.heads[head].max_m);
      }
    }
  }

  void add_noise(const DeviceContext& context, std::uint32_t entity, const DistanceScanner& port) noexcept {
    for (std::uint32_t k = 0; k < port.count; k += 4) {
      const auto bits = draw(context.seed, entity, Stream::ScannerNoise, context.tick, k);
      for (std::uint32_t j = 0; j < 4; ++j)
        rays_.distance_m[k + j] += middle_m_ + noise_m_ * (2.0F * to_unit_float(bits[j]) - 1.0F);
    }
  }

  void keep_in_range(DistanceScanner& port) const noexcept {
    for (std::size_t head = 0; head < DistanceScanner::kHeads; ++head) {
      const auto least = static_cast<float>(part_.heads[head].min_m);
      const auto most = static_cast<float>(part_.heads[head].max_m);
      for (std::size_t k = 0; k < port.samples; ++k) {
        const std::size_t ray = port.at(head, k);
        port.distance_m[ray] = std::min(std::max(rays_.distance_m[ray], least), most);
      }
    }
  }

  const hal::ScannerPart& part_;
  const ScannerState* scanners_;
  float middle_m_, noise_m_;  // of the noise, and how far to both sides
  std::uint32_t samples_;     // of each head, in a tick in which the scanner turns
  FarRays rays_;              // of the robot at hand
};

static_assert(RayRing::kCapacity >= DistanceScanner::kHeads * DistanceScanner::kSamples);

}  // namespace

std::vector<DeviceType> scanner_types() {
  std::vector<DeviceType> types;
  add_levels<ScannerActuator>(types, "Turns as told; errors where asked for.", "Turns as told.",
                              "Turns with an error of its speed every tick.");
  add_levels<ScannerSensor>(types, "Exact distances; noise where asked for.",
                            "Exact distances to bodies, boxes and cylinders.", "Distances with uniform noise.");
  types.push_back(device_type<ScannerSensor, Level::Default>("rot_z_only", "ARGoS' name for the default."));
  return types;
}

}  // namespace tandem::core
