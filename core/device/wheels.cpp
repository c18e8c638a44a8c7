// Wheels: the actuator that drives the engine, the encoders that count what was rolled, and where that should have led.
#include "hal/device/wheels.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/device/each_robot.hpp"
#include "core/device/fitted_drive.hpp"
#include "core/device/types.hpp"
#include "core/random/random.hpp"
#include "core/space/mechanisms.hpp"
#include "hal/angle.hpp"
#include "hal/device/steppers.hpp"
#include "hal/open_params.hpp"

namespace tandem::core {
namespace {

// --- actuator ---

/// A number for each wheel: `name` for both, `name_left` and `name_right` for one.
struct WheelPair {
  double left = 0.0, right = 0.0;
  void describe(hal::ParamVisitor& v, const std::string& name, const hal::Unit& bare, hal::Range range,
                const std::string& doc) {
    double both = left;
    v.number(name, both, bare, range, doc);
    if (both != left) left = right = both;
    v.number(name + "_left", left, bare, range, "The same of the left wheel.");
    v.number(name + "_right", right, bare, range, "The same of the right wheel.");
  }
  bool operator==(const WheelPair&) const = default;
};

/// speed' = factor * (speed + bias) * (1 + noise), and the model of ARGoS: then speed'' = f * (speed' + b), where b is
/// normal and drawn once for each wheel, and f is normal and drawn for each wheel every tick.
struct WheelErrors {
  double bias_left_m_s = 0.0, bias_right_m_s = 0.0;
  double factor_left = 1.0, factor_right = 1.0;
  double noise_std_dev = 0.0;
  WheelPair bias_avg_m_s = {}, bias_stddev_m_s = {}, factor_avg = {1.0, 1.0}, factor_stddev = {};
  bool stepped = true;
  static WheelErrors noisy() { return {.noise_std_dev = 50 * 1e-3}; }
  bool as_argos() const noexcept {
    return bias_avg_m_s != WheelPair{} || bias_stddev_m_s != WheelPair{} || factor_avg != WheelPair{1.0, 1.0} ||
           factor_stddev != WheelPair{};
  }
  void describe_always(hal::ParamVisitor& v) {
    if (hal::in_argos_file(v)) stepped = false;
    v.flag("stepped", stepped,
           "Stepper motors turn at the next speed that their timer has, as real ones do. Left out in an ARGoS file: "
           "they turn as told.");
  }
  void describe(hal::ParamVisitor& v) {
    v.number("bias_left", bias_left_m_s, hal::unit::cm_s, hal::kAny, "Added to the left wheel's speed while it turns.");
    v.number("bias_right", bias_right_m_s, hal::unit::cm_s, hal::kAny,
             "Added to the right wheel's speed while it turns.");
    v.number("factor_left", factor_left, hal::unit::none, hal::kNotNegative, "Multiplies the left wheel's speed.");
    v.number("factor_right", factor_right, hal::unit::none, hal::kNotNegative, "Multiplies the right wheel's speed.");
    v.number("noise_std_dev", noise_std_dev, hal::unit::none, {0.0, 1.0},
             "Standard deviation of each wheel's relative speed error, drawn every tick.");
    bias_avg_m_s.describe(v, "bias_avg", hal::unit::m_s, hal::kAny,
                          "Mean of a bias that every robot has of its own, added to each wheel while one turns.");
    bias_stddev_m_s.describe(v, "bias_stddev", hal::unit::m_s, hal::kNotNegative, "Its standard deviation.");
    factor_avg.describe(v, "factor_avg", hal::unit::none, hal::kAny,
                        "Mean of a factor that is drawn for each wheel every tick.");
    factor_stddev.describe(v, "factor_stddev", hal::unit::none, hal::kNotNegative, "Its standard deviation.");
  }
};

/// Speeds of wheels that stepper motors turn. The last result is kept: most robots of a block are told the same.
class SteppedSpeeds {
 public:
  SteppedSpeeds(const hal::SteppersPart& steppers, double wheel_radius_m)
      : steppers_(&steppers), step_m_(steppers.step_m(wheel_radius_m)) {}

  double turned_m_s(double told_m_s) noexcept {
    const double told = std::fabs(told_m_s);
    if (told == told_m_s_) return std::copysign(turned_m_s_, told_m_s);
    if (told == 0.0) return 0.0;
    told_m_s_ = told;
    turned_m_s_ = look_up(*steppers_, step_m_, told);
    return std::copysign(turned_m_s_, told_m_s);
  }

 private:
  /// Out of line, and by value: the rest stays in registers.
  [[gnu::noinline]] static double look_up(const hal::SteppersPart& steppers, double step_m, double told_m_s) noexcept {
    return steppers.turned_steps_s(told_m_s / step_m) * step_m;
  }

  const hal::SteppersPart* steppers_;  // of the kind, which lives as long as the world
  double step_m_;
  double told_m_s_ = 0.0, turned_m_s_ = 0.0;
};

class WheelActuator final : public Actuator {
 public:
  WheelActuator(const WheelErrors& errors, std::optional<SteppedSpeeds> stepped, std::optional<FittedDrive> fitted)
      : errors_(errors), stepped_(stepped), fitted_(std::move(fitted)) {
    exact_ = errors.bias_left_m_s == 0.0 && errors.bias_right_m_s == 0.0 && errors.factor_left == 1.0 &&
             errors.factor_right == 1.0 && errors.noise_std_dev == 0.0 && !errors.as_argos();
  }

  void act(const DeviceContext& context, SpaceStores& stores, const void* ports) noexcept override {
    const auto* const wheels = static_cast<const hal::WheelSpeeds*>(ports);
    if (!exact_ || fitted_)
      roll(context, stores, wheels, [&](std::size_t i, bool drives, hal::WheelSpeeds& speeds) {
        if (stepped_) speeds.set(stepped_->turned_m_s(speeds.left_m_s), stepped_->turned_m_s(speeds.right_m_s));
        err(context, i, drives, wheels[i], speeds);
      });
    else if (stepped_)
      roll(context, stores, wheels, [stepped = *stepped_](std::size_t, bool, hal::WheelSpeeds& speeds) mutable {
        speeds.set(stepped.turned_m_s(speeds.left_m_s), stepped.turned_m_s(speeds.right_m_s));
      });
    else
      roll(context, stores, wheels, [](std::size_t, bool, hal::WheelSpeeds&) {});
  }

 private:
  /// Every robot's wheels, as `change(i, drives, speeds)` makes them of what it was told.
  template <class Change>
  static void roll(const DeviceContext& context, SpaceStores& stores, const hal::WheelSpeeds* wheels, Change change) {
    const std::size_t first = context.block.first_row, used = context.block.used;
    const std::uint8_t* const halted = context.block.halted.data();
    const std::uint8_t* const flags = stores.bodies.flags.data() + first;
    double* const left_m_s = stores.bodies.left_m_s.data() + first;
    double* const right_m_s = stores.bodies.right_m_s.data() + first;
    for (std::size_t i = 0; i < used; ++i) {
      const bool drives = (flags[i] & (kAlive | kExternal)) == kAlive && halted[i] == 0;
      hal::WheelSpeeds speeds;
      if (drives) speeds = wheels[i];
      change(i, drives, speeds);
      left_m_s[i] = speeds.left_m_s;
      right_m_s[i] = speeds.right_m_s;
    }
  }

  void err(const DeviceContext& context, std::size_t i, bool drives, const hal::WheelSpeeds& told,
           hal::WheelSpeeds& speeds) noexcept {
    const Bodies& b = context.stores.bodies;
    const std::size_t row = context.block.first_row + i;
    if (!exact_ && drives) distort(context, b.entity[row], speeds.left_m_s, speeds.right_m_s);
    if (!fitted_) return;
    // A twin's commands are remembered, too: it may go on as a simulated robot.
    const hal::WheelSpeeds& heard = (b.flags[row] & kExternal) != 0 ? told : speeds;
    fitted_->tell(context, i, heard.left_m_s, heard.right_m_s);
    if (drives)
      fitted_->drive(context, i, speeds.left_m_s, speeds.right_m_s);
    else
      fitted_->stand(i);
  }
  void distort(const DeviceContext& context, std::uint32_t entity, double& left, double& right) const noexcept {
    const auto bits = draw(context.seed, entity, Stream::WheelNoise, context.tick);
    const auto noise = to_normal(bits[0], bits[1]);
    if (left != 0.0)
      left = errors_.factor_left * (left + errors_.bias_left_m_s) * (1.0 + errors_.noise_std_dev * noise[0]);
    if (right != 0.0)
      right = errors_.factor_right * (right + errors_.bias_right_m_s) * (1.0 + errors_.noise_std_dev * noise[1]);
    if (errors_.as_argos() && (left != 0.0 || right != 0.0)) distort_as_argos(context, entity, left, right);
  }
  void distort_as_argos(const DeviceContext& context, std::uint32_t entity, double& left,
                        double& right) const noexcept {
    const auto own = draw(context.seed, entity, Stream::WheelBias, 0);
    const auto now = draw(context.seed, entity, Stream::WheelNoise, context.tick, 1);
    const auto bias = to_normal(own[0], own[1]);
    const auto factor = to_normal(now[0], now[1]);
    left = (errors_.factor_avg.left + errors_.factor_stddev.left * factor[0]) *
           (left + errors_.bias_avg_m_s.left + errors_.bias_stddev_m_s.left * bias[0]);
    right = (errors_.factor_avg.right + errors_.factor_stddev.right * factor[1]) *
            (right + errors_.bias_avg_m_s.right + errors_.bias_stddev_m_s.right * bias[1]);
  }

  WheelErrors errors_;
  std::optional<SteppedSpeeds> stepped_;  // nothing: they turn as told
  std::optional<FittedDrive> fitted_;     // nothing: they are as their kind says
  bool exact_ = true;
};

/// Treels that draw to one side because their motors are not alike [Pinciroli et al. 2012, "ARGoS: a modular, parallel,
/// multi-engine simulator for multi-robot systems", Swarm Intelligence 6(4), section 4.2.2]: going forward the right
/// one is faster than commanded, going backward the left one, by a part of its speed that is drawn from a Rayleigh
/// distribution at the start and anew whenever the robot has gripped something. The encoders do not see it.
///
/// Both ways the robot turns to its left: forward its path bends to its left, backward to its right, and there and back
/// is an S, as it is with the real robots [figure 10 there]. A left treel that was slower going backward, the other way
/// to read "subtracted from the desired left treel speed", would lead back along the very arc that led there. Faster is
/// also what motors are that sit mirrored and run better in one sense of rotation.
struct Slant {
  double sigma = 0.0134;
  void describe(hal::ParamVisitor& v) {
    v.number("sigma", sigma, hal::unit::none, {0.0, 1.0},
             "Scale of the Rayleigh distribution that the relative error of the speed is drawn from.");
  }
};

class SlantedActuator final : public Actuator {
 public:
  SlantedActuator(double sigma, const BlockColumns& columns)
      : sigma_(sigma), hidden_rolls_(columns.find<HiddenRoll>()), grips_(columns.find<GripState>()) {}

  void act(const DeviceContext& context, SpaceStores& stores, const void* ports) noexcept override {
    const auto* wheels = static_cast<const hal::WheelSpeeds*>(ports);
    Bodies& b = stores.bodies;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      const hal::WheelSpeeds told = obeys(context, i) ? wheels[i] : hal::WheelSpeeds{};
      const double sum = told.left_m_s + told.right_m_s;
      HiddenRoll& hidden = hidden_rolls_[i];
      hidden.left_m_s = 0.0;
      hidden.right_m_s = 0.0;
      if (sum != 0.0) {
        const double part = drawn(context.seed, b.entity[row], i);
        if (sum > 0.0)
          hidden.right_m_s = part * told.right_m_s;
        else
          hidden.left_m_s = part * told.left_m_s;
      }
      hidden.left_m += hidden.left_m_s * context.tick_s;
      hidden.right_m += hidden.right_m_s * context.tick_s;
      b.left_m_s[row] = told.left_m_s + hidden.left_m_s;
      b.right_m_s[row] = told.right_m_s + hidden.right_m_s;
    }
  }

 private:
  double drawn(std::uint64_t seed, std::uint32_t entity, std::size_t slot) const noexcept {
    const std::uint32_t grips = grips_ == nullptr ? 0 : grips_[slot].grips;
    const auto bits = draw(seed, entity, Stream::TreelSlant, grips);
    return sigma_ * std::sqrt(-2.0 * std::log(1.0 - to_unit(bits[0], bits[1])));
  }

  double sigma_;
  HiddenRoll* hidden_rolls_;
  const GripState* grips_;  // null: they have no grippers
};

BlockFactory<Actuator> make_slanted(const Element& element, Problems& problems, const DeviceSetup&) {
  const auto options = read_options<Slant>(element, problems);
  const auto make = [sigma = options.sigma](const BlockColumns& columns) {
    return std::make_unique<SlantedActuator>(sigma, columns);
  };
  return {make, {keeps<HiddenRoll>()}};
}

template <Level kLevel>
BlockFactory<Actuator> make_wheels(const Element& element, Problems& problems, const DeviceSetup& setup) {
  const WheelErrors errors = read_options<LevelOptions<WheelErrors, kLevel>>(element, problems);
  const auto* const part = setup.kind.part<hal::FittedWheels>();
  if (part == nullptr || kLevel == Level::Ideal) {
    std::optional<SteppedSpeeds> stepped;
    const auto* const steppers = setup.kind.part<hal::SteppersPart>();
    if (steppers != nullptr && kLevel != Level::Ideal && errors.stepped)
      stepped.emplace(*steppers, setup.kind.drive()->wheel_radius_m);
    return [errors, stepped](const BlockColumns&) {
      return std::make_unique<WheelActuator>(errors, stepped, std::nullopt);
    };
  }
  if (const std::string flaw = FittedDrive::flaw(*part, setup.tick_s); !flaw.empty())
    problems.push_back(problem_at(element, flaw));
  const auto make = [errors, part](const BlockColumns& columns) {
    return std::make_unique<WheelActuator>(errors, std::nullopt, FittedDrive(*part, columns));
  };
  return {make, FittedDrive::columns()};
}

template <Level kLevel>
DeviceType wheels_type(std::string_view implementation, std::string_view summary) {
  return actuator_type("differential_steering", implementation, summary, &has<hal::DifferentialDrive>,
                       &make_wheels<kLevel>, &describe_options<LevelOptions<WheelErrors, kLevel>>);
}

// --- encoders ---

struct EncoderErrors {
  hal::Interval vel_noise_m_s = {};
  hal::Interval dist_noise_m = {};
  static EncoderErrors noisy() {
    return {.vel_noise_m_s = hal::Interval::around(100 * 1e-5), .dist_noise_m = hal::Interval::around(100 * 1e-6)};
  }
  void describe(hal::ParamVisitor& v) {
    v.interval("vel_noise_range", vel_noise_m_s, hal::unit::cm_s, "Uniform noise on each speed.");
    v.interval("dist_noise_range", dist_noise_m, hal::unit::cm,
               "Uniform noise on the distance rolled in each tick; it adds up.");
  }
};

/// What noisy encoders have counted beyond what was rolled.
struct EncoderDrift {
  static constexpr std::string_view kName = "encoder_drift";
  static constexpr std::string_view kDoc = "What noisy encoders have counted beyond what was rolled.";

  double left_m = 0.0, right_m = 0.0;

  void describe(hal::FieldList& f) const {
    f.add("left", left_m, hal::unit::m, "since the start");
    f.add("right", right_m, hal::unit::m, "since the start");
  }
};

class EncoderSensor final : public EachSensor<EncoderSensor, hal::WheelEncoders, EncoderErrors> {
 public:
  using Part = hal::DifferentialDrive;
  static void prepare(BlockFactory<Sensor>& factory, const DeviceSetup&, const Errors& errors) {
    if (!errors.dist_noise_m.empty()) factory.columns = {keeps<EncoderDrift>()};
  }

  EncoderSensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : EachSensor(setup, errors, columns),
        drifts_(columns.find<EncoderDrift>()),
        hidden_rolls_(columns.find<HiddenRoll>()) {}

  void read(const RobotAt& robot, hal::WheelEncoders& port) const noexcept {
    const Bodies& b = robot.bodies();
    const std::size_t row = robot.row();
    port.left_m = b.left_m[row];
    port.right_m = b.right_m[row];
    port.left_m_s = static_cast<float>(b.left_m_s[row]);
    port.right_m_s = static_cast<float>(b.right_m_s[row]);
    if (hidden_rolls_ != nullptr) hide(hidden_rolls_[robot.i], port);
    if (!errors_.vel_noise_m_s.empty() || !errors_.dist_noise_m.empty()) add_noise(robot, port);
  }

 private:
  static void hide(const HiddenRoll& hidden, hal::WheelEncoders& port) noexcept {
    port.left_m -= hidden.left_m;
    port.right_m -= hidden.right_m;
    port.left_m_s -= static_cast<float>(hidden.left_m_s);
    port.right_m_s -= static_cast<float>(hidden.right_m_s);
  }

  void add_noise(const RobotAt& robot, hal::WheelEncoders& port) const noexcept {
    const auto bits = robot.draw(Stream::EncoderNoise);
    port.left_m_s += static_cast<float>(errors_.vel_noise_m_s.at(to_symmetric(bits[0])));
    port.right_m_s += static_cast<float>(errors_.vel_noise_m_s.at(to_symmetric(bits[1])));
    if (drifts_ == nullptr) return;
    EncoderDrift& drift = drifts_[robot.i];
    drift.left_m += errors_.dist_noise_m.at(to_symmetric(bits[2]));
    drift.right_m += errors_.dist_noise_m.at(to_symmetric(bits[3]));
    port.left_m += drift.left_m;
    port.right_m += drift.right_m;
  }

  EncoderDrift* drifts_;            // null: their distances are exact
  const HiddenRoll* hidden_rolls_;  // null: their wheels roll as they count
};

// --- odometry ---

constexpr ErrorText kOdometryErrors{"dist_noise_range", 100 * 1e-6, hal::unit::cm, hal::kAny,
                                    "Uniform noise on the distance that each wheel rolled in a tick; it adds up."};
using OdometryErrors = OneInterval<kOdometryErrors>;

/// Where odometry believes the robot to be.
struct Reckoned {
  static constexpr std::string_view kName = "odometry";
  static constexpr std::string_view kDoc = "Where odometry believes robots to be.";

  double x_m = 0.0, y_m = 0.0, heading_rad = 0.0;
  double left_m = 0.0, right_m = 0.0;  ///< that were taken into account

  void describe(hal::FieldList& f) const {
    f.add("x", x_m, hal::unit::m, "from where the robot started, ahead");
    f.add("y", y_m, hal::unit::m, "from where the robot started, to the left");
    f.add("heading", heading_rad, hal::unit::rad, "relative to that at the start");
    f.add("left", left_m, hal::unit::m, "that was taken into account");
    f.add("right", right_m, hal::unit::m, "that was taken into account");
  }
};

/// Adds up what the encoders saw in each tick as an arc [Siegwart et al. 2011, Introduction to Autonomous Mobile
/// Robots, section 5.2.4].
class OdometrySensor final : public EachSensor<OdometrySensor, hal::Odometry, OdometryErrors, Reckoned> {
 public:
  using Part = hal::DifferentialDrive;

  OdometrySensor(const DeviceSetup& setup, const Errors& errors, const BlockColumns& columns)
      : EachSensor(setup, errors, columns),
        wheel_base_m_(setup.kind.drive()->wheel_base_m),
        hidden_rolls_(columns.find<HiddenRoll>()) {}

  void read(const RobotAt& robot, hal::Odometry& port) const noexcept {
    Reckoned& r = kept_[robot.i];
    double left_m = robot.bodies().left_m[robot.row()];
    double right_m = robot.bodies().right_m[robot.row()];
    if (hidden_rolls_ != nullptr) {
      left_m -= hidden_rolls_[robot.i].left_m;
      right_m -= hidden_rolls_[robot.i].right_m;
    }
    double rolled_left_m = left_m - r.left_m;
    double rolled_right_m = right_m - r.right_m;
    r.left_m = left_m;
    r.right_m = right_m;
    if (!errors_.amount.empty()) {
      const auto bits = robot.draw(Stream::OdometryNoise);
      rolled_left_m += errors_.amount.at(to_symmetric(bits[0]));
      rolled_right_m += errors_.amount.at(to_symmetric(bits[1]));
    }
    go(r, 0.5 * (rolled_left_m + rolled_right_m), (rolled_right_m - rolled_left_m) / wheel_base_m_);
    port.x_m = r.x_m;
    port.y_m = r.y_m;
    port.heading_rad = r.heading_rad;
  }

 private:
  /// Along an arc: its chord points half of the turn to the side.
  static void go(Reckoned& r, double way_m, double turn_rad) noexcept {
    const double half = 0.5 * turn_rad;
    const double chord_m = std::fabs(half) < 1e-6 ? way_m : way_m * std::sin(half) / half;
    r.x_m += chord_m * std::cos(r.heading_rad + half);
    r.y_m += chord_m * std::sin(r.heading_rad + half);
    r.heading_rad = hal::wrapped(r.heading_rad + turn_rad);
  }

  double wheel_base_m_;
  const HiddenRoll* hidden_rolls_;  // null: their wheels roll as they count
};

}  // namespace

std::vector<DeviceType> wheel_types() {
  std::vector<DeviceType> types = {
      wheels_type<Level::Default>(
          "default", "The commanded speeds as the kind's motors turn, with bias, factor and noise where asked for."),
      wheels_type<Level::Ideal>("ideal", "The commanded speeds, exactly."),
      wheels_type<Level::Noisy>("noisy", "Each wheel with a relative error of its own every tick."),
      actuator_type(hal::WheelSpeeds::kName, "slanted",
                    "Draws to one side by an error that the encoders do not see and every grip changes.",
                    &has<hal::DifferentialDrive>, &make_slanted, &describe_options<Slant>)};
  add_levels<EncoderSensor>(types, "What the wheels rolled, with noise where asked for.", "What the wheels rolled.",
                            "What the wheels rolled, with noise that adds up.");
  add_levels<OdometrySensor>(types, "Reckoned from the encoders; noise where asked for.", "Reckoned from the encoders.",
                             "Reckoned from encoders with noise that adds up.");
  return types;
}

}  // namespace tandem::core
