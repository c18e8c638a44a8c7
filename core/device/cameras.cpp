// Cameras that see coloured blobs: the lit LEDs of robots and objects, and lamps.
#include "hal/device/cameras.hpp"

#include <bit>
#include <span>

#include "core/device/types.hpp"
#include "core/medium/led/led.hpp"
#include "core/random/random.hpp"
#include "core/space/mechanisms.hpp"
#include "core/space/sight.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/pan_tilt.hpp"

namespace tandem::core {

namespace {

/// Radius of the disc on the ground that the camera on the axis sees.
double omni_reach_m(const hal::RobotKind& kind) noexcept {
  const auto& camera = *kind.part<hal::OmniCameraPart>();
  return camera.height_m * std::tan(camera.aperture_rad);
}

/// Where robots of a kind carry their lights, numbered as in ShownLeds.
class LampPlaces {
 public:
  explicit LampPlaces(const hal::RobotKind& kind) : kind_(&kind) {
    double widest2 = 0.0;
    const auto place = [&](const std::vector<hal::Mount>& ring) {
      for (const hal::Mount& led : ring) widest2 = std::max(widest2, led.x_m * led.x_m + led.y_m * led.y_m);
      return std::span<const hal::Mount>(ring);
    };
    if (const auto* leds = kind.part<hal::LedsPart>(); leds != nullptr) {
      ring_ = place(leds->mounts);
      ring_spread_ = leds->spread;
      on_turret_ = leds->on_turret;
    }
    if (const auto* upper = kind.part<hal::UpperLedsPart>(); upper != nullptr) {
      upper_ = place(upper->mounts);
      upper_spread_ = upper->spread;
    }
    const auto* const body = kind.part<hal::BodyLedPart>();
    const auto* const front = kind.part<hal::FrontLedPart>();
    const auto* const camera = kind.part<hal::CameraPart>();
    if (body != nullptr) body_ = body->mount;
    if (front != nullptr) front_ = front->mount;
    if (camera != nullptr) camera_ = {0.0, camera->usual.x_m, 0.0, camera->usual.z_m};
    widest_m_ = std::max(std::sqrt(widest2), body != nullptr || front != nullptr ? kind.body.radius_m : 0.0);
  }

  const hal::RobotKind& kind() const noexcept { return *kind_; }
  /// How far they sit from the axis.
  double widest_m() const noexcept { return widest_m_; }
  bool on_turret() const noexcept { return on_turret_; }
  const hal::Mount& mount(std::size_t i) const noexcept {
    return i == ShownLeds::kBody     ? body_
           : i == ShownLeds::kFront  ? front_
           : i == ShownLeds::kCamera ? camera_
           : i >= ShownLeds::kUpper  ? upper_[i - ShownLeds::kUpper]
                                     : ring_[i];
  }
  const hal::LightSpread& spread(std::size_t i) const noexcept {
    static constexpr hal::LightSpread kEverywhere;
    if (i == ShownLeds::kBody || i == ShownLeds::kFront) return kEverywhere;
    return i >= ShownLeds::kUpper && i < ShownLeds::kCamera ? upper_spread_ : ring_spread_;
  }

 private:
  const hal::RobotKind* kind_;
  std::span<const hal::Mount> ring_, upper_;
  hal::LightSpread ring_spread_, upper_spread_;
  hal::Mount body_, front_, camera_;
  double widest_m_ = 0.0;
  bool on_turret_ = false;
};

constexpr double kSurface_m = 0.002;  // an LED this deep in a surface is seen all the same: it sits on it

using Point = std::array<double, 3>;

bool same_medium(std::uint16_t led, std::uint16_t camera) noexcept {
  return led == 0 || camera == 0 || led == camera;
}

/// Finds the lights that a camera has in sight. One a block of robots.
///
/// Bodies that may stand between the camera and a robot are looked up once for all of that robot's LEDs.
class Lookout {
 public:
  /// `sense`: real robots that its own camera sees are left out of what a real robot's twin sees.
  Lookout(RealSense sense, const DeviceSetup& setup, const BlockColumns& columns)
      : sense_(sense),
        leds_(setup.medium_as<LedMedium>()),
        medium_(setup.channel),
        turrets_(columns.of_all<TurretState>()) {
    between_.reserve(kRoom);
    lamps_.reserve(kRoom);
  }

  /// To be called in every tick before it looks.
  void measure(const SpaceStores& stores) noexcept {
    widest_body_m_ = widest_body_m(stores);
    widest_ring_m_ = 0.0;
    lamps_.clear();
    for (const RobotGroup& group : stores.groups)
      widest_ring_m_ = std::max(widest_ring_m_, lamps_.emplace_back(*group.kind).widest_m());
  }

  /// Calls `see(p, color)`, p from the camera to the light in W, for every light of the camera's medium that robot
  /// `row` has in sight from `from` (W) and for which `covers(p)` holds. The order depends on the space alone.
  /// `reach_m`: `covers` holds for nothing that is farther along the ground.
  template <class Covers, class See>
  void look(const SpaceStores& stores, std::size_t row, const Point& from, double reach_m, Covers&& covers,
            See&& see) noexcept {
    const auto consider = [&](const Point& at, hal::Rgb color) {
      const Point p{at[0] - from[0], at[1] - from[1], at[2] - from[2]};
      if (covers(p) && open(stores, from, at)) see(p, color);
    };
    look_at_robots(stores, row, from, reach_m, consider);
    look_at_objects(stores, row, from, reach_m, consider);
    for (const LightSource& light : stores.lights) {
      if (!light.alive || light.intensity <= 0.0 || !same_medium(light.medium, medium_)) continue;
      if (!near(light.x_m, light.y_m, from, reach_m)) continue;
      gather(stores, row, row, from, light.x_m, light.y_m, 0.0);
      consider({light.x_m, light.y_m, light.z_m}, light.color);
    }
  }

 private:
  static constexpr std::size_t kRoom = 256;

  /// A body that may stand between.
  struct Blocker {
    double x_m, y_m, radius_m, low_m, high_m;
  };

  static bool near(double x_m, double y_m, const Point& from, double reach_m) noexcept {
    const double dx = x_m - from[0];
    const double dy = y_m - from[1];
    return dx * dx + dy * dy <= reach_m * reach_m;
  }

  template <class Consider>
  void look_at_robots(const SpaceStores& stores, std::size_t row, const Point& from, double reach_m,
                      Consider&& consider) noexcept {
    if (leds_.silent()) return;
    const Bodies& b = stores.bodies;
    stores.body_index.for_each_near(from[0], from[1], reach_m + widest_ring_m_, [&](const IndexEntry& o) {
      const std::size_t other = o.row();
      const ShownLeds& shown = leds_.of(other);
      if (other == row || shown.lit == 0 || stores.senses_really(row, other, sense_)) return;
      const LampPlaces& lamps = lamps_[stores.blocks[stores.robots[b.entity[other]].block].group];
      const double spread_m = lamps.widest_m();
      if (!near(b.x_m[other], b.y_m[other], from, reach_m + spread_m)) return;
      gather(stores, row, other, from, b.x_m[other], b.y_m[other], spread_m);
      for (std::uint64_t left = shown.lit; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        if (!same_medium(shown.medium(i), medium_)) continue;
        const Point at = place_of(stores, other, lamps, i);
        const hal::LightSpread& spread = lamps.spread(i);
        if (!shines_at(spread, at, from)) continue;
        // A robot's body hides the LEDs on its far side, but not the light in it.
        const bool hidden =
            i != ShownLeds::kBody && !spread.past_body && behind_own_body(stores, other, lamps.kind(), from, at);
        if (!hidden) consider(at, shown.color[i]);
      }
    });
  }

  template <class Consider>
  void look_at_objects(const SpaceStores& stores, std::size_t row, const Point& from, double reach_m,
                       Consider&& consider) noexcept {
    for (const std::uint32_t k : leds_.objects_near(from[0], from[1])) {
      const Object& object = stores.objects[k];
      double spread2 = 0.0;
      for (const ObjectLed& led : object.leds) spread2 = std::max(spread2, led.x_m * led.x_m + led.y_m * led.y_m);
      const double spread_m = std::sqrt(spread2);
      if (!object.alive || !near(object.x_m, object.y_m, from, reach_m + spread_m)) continue;
      gather(stores, row, row, from, object.x_m, object.y_m, spread_m);
      for (const ObjectLed& led : object.leds) {
        if (led.color == hal::kBlack || !same_medium(led.medium, medium_)) continue;
        consider({object.x_m + object.cos_h * led.x_m - object.sin_h * led.y_m,
                  object.y_m + object.sin_h * led.x_m + object.cos_h * led.y_m, object.z_low_m + led.z_m},
                 led.color);
      }
    }
  }

  Point place_of(const SpaceStores& stores, std::size_t row, const LampPlaces& lamps, std::size_t i) const noexcept {
    const Bodies& b = stores.bodies;
    const hal::Mount& mount = lamps.mount(i);
    double c = b.cos_h[row];
    double s = b.sin_h[row];
    const TurretState* turret = lamps.on_turret() ? stores.state_of(turrets_, row) : nullptr;
    if (turret != nullptr && turret->angle_rad != 0.0) {
      const double ct = std::cos(turret->angle_rad);
      const double st = std::sin(turret->angle_rad);
      const double turned = c * ct - s * st;
      s = s * ct + c * st;
      c = turned;
    }
    return {b.x_m[row] + c * mount.x_m - s * mount.y_m, b.y_m[row] + s * mount.x_m + c * mount.y_m,
            stores.base_m(row) + mount.z_m};
  }

  /// Whether an LED there sends light to a camera.
  static bool shines_at(const hal::LightSpread& spread, const Point& at, const Point& from) noexcept {
    if (spread.sin_lowest <= -1.0 && spread.sin_highest >= 1.0) return true;
    const double dx = from[0] - at[0];
    const double dy = from[1] - at[1];
    const double dz = from[2] - at[2];
    const double distance_m = std::sqrt(dx * dx + dy * dy + dz * dz);
    return dz >= spread.sin_lowest * distance_m && dz <= spread.sin_highest * distance_m;
  }

  static bool behind_own_body(const SpaceStores& stores, std::size_t row, const hal::RobotKind& kind, const Point& from,
                              const Point& at) noexcept {
    const Bodies& b = stores.bodies;
    const double low_m = stores.base_m(row);
    return disc_on_line(b.x_m[row], b.y_m[row], static_cast<double>(b.radius_m[row]) - kSurface_m, low_m,
                        low_m + kind.body.height_m - kSurface_m, from, at);
  }

  /// Notes the bodies, but the camera's own and `bearer`, that a line from the camera to anywhere within `spread_m` of
  /// (x, y) may touch.
  void gather(const SpaceStores& stores, std::size_t row, std::size_t bearer, const Point& from, double x_m, double y_m,
              double spread_m) noexcept {
    const Bodies& b = stores.bodies;
    between_.clear();
    const double dx = x_m - from[0];
    const double dy = y_m - from[1];
    const double length2 = dx * dx + dy * dy;
    any_body_near_line(stores, widest_body_m_ + spread_m, from, {x_m, y_m, from[2]}, [&](std::uint32_t other) {
      if (other == row || other == bearer) return false;
      const double wx = b.x_m[other] - from[0];
      const double wy = b.y_m[other] - from[1];
      const double t = length2 > 0.0 ? std::clamp((wx * dx + wy * dy) / length2, 0.0, 1.0) : 0.0;
      const double radius_m = static_cast<double>(b.radius_m[other]);
      if (!Lookout::near(wx - t * dx, wy - t * dy, {}, radius_m + spread_m)) return false;
      const double low_m = stores.base_m(other);
      between_.push_back(
          {b.x_m[other], b.y_m[other], radius_m, low_m, low_m + stores.kind_of_row(other).body.height_m});
      return false;
    });
  }

  /// Whether none of the gathered bodies and no object is on the line.
  bool open(const SpaceStores& stores, const Point& from, const Point& at) const noexcept {
    for (const Blocker& body : between_) {
      if (disc_on_line(body.x_m, body.y_m, body.radius_m, body.low_m, body.high_m, from, at)) return false;
    }
    const double dx = at[0] - from[0];
    const double dy = at[1] - from[1];
    const double dz = at[2] - from[2];
    const double length_m = std::sqrt(dx * dx + dy * dy + dz * dz);
    const double t = length_m > kSurface_m ? 1.0 - kSurface_m / length_m : 0.0;
    return in_sight(stores, from[0], from[1], from[2], from[0] + t * dx, from[1] + t * dy, from[2] + t * dz);
  }

  RealSense sense_;
  const LedMedium& leds_;
  std::uint16_t medium_;  // of the camera
  Column<TurretState> turrets_;
  double widest_body_m_ = 0.0, widest_ring_m_ = 0.0;  // of all kinds of robots
  std::vector<LampPlaces> lamps_;                     // of each group
  std::vector<Blocker> between_;
};

/// What the configuration of a camera says.
struct CameraOptions {
  std::string medium = {};
  bool show_rays = false;
  double noise = 0.0;  ///< what a reading lacks in quality: in m, or pixels
  double miss_prob = 0.0;
  void describe_always(hal::ParamVisitor& v) {
    v.text("medium", medium, "Id of the LED medium: only its LEDs are seen. Empty: all are.");
    v.flag("show_rays", show_rays, "Draw the lines in a view; no effect on readings.");
  }
  void describe_miss(hal::ParamVisitor& v) {
    v.number("miss_prob", miss_prob, hal::unit::none, {0.0, 1.0}, "Probability that a blob is missed.");
  }
};

/// Whether the `number`th light that a robot sees in this tick is missed.
bool missed(const CameraOptions& flaws, const DeviceContext& context, std::size_t row, Stream stream,
            std::uint32_t number) noexcept {
  if (flaws.miss_prob <= 0.0) return false;
  const std::uint32_t entity = context.stores.bodies.entity[row];
  return to_unit(draw(context.seed, entity, stream, context.tick, number)[0]) < flaws.miss_prob;
}

/// Two errors of the `number`th light.
std::array<double, 2> errors(const CameraOptions& flaws, const DeviceContext& context, std::size_t row, Stream stream,
                             std::uint32_t number) noexcept {
  if (flaws.noise <= 0.0) return {0.0, 0.0};
  const auto bits = draw(context.seed, context.stores.bodies.entity[row], stream, context.tick, number);
  const auto normal = to_normal(bits[0], bits[1]);
  return {flaws.noise * normal[0], flaws.noise * normal[1]};
}

// --- all around ---

struct OmniOptions : CameraOptions {
  static OmniOptions noisy() { return {{.noise = 10 * 1e-3, .miss_prob = 10 * 1e-3}}; }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise, hal::unit::m, hal::kNotNegative,
             "Standard deviation of a blob's apparent place, along x and along y.");
    describe_miss(v);
  }
};

/// Lights below it whose distance along the ground is within reach.
template <class OfPort>
class OmniSensor final : public Sensor {
 public:
  using Port = OfPort;
  using Part = hal::OmniCameraPart;
  using Errors = OmniOptions;
  static constexpr std::string_view kMedium = LedMedium::kKind;
  static void prepare(BlockFactory<Sensor>& factory, const DeviceSetup& setup, const Errors&) {
    factory.listens = true;
    factory.reach_m = omni_reach_m(setup.kind);
  }

  OmniSensor(const DeviceSetup& setup, const Errors& flaws, const BlockColumns& columns)
      : lookout_(RealSense::OmniCamera, setup, columns),
        height_m_(setup.kind.part<hal::OmniCameraPart>()->height_m),
        reach_m_(omni_reach_m(setup.kind)),
        flaws_(flaws) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* cameras = static_cast<Port*>(ports);
    lookout_.measure(context.stores);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      if ((context.stores.bodies.flags[row] & kAlive) == 0) continue;
      stamp(context, cameras[i]);
      cameras[i].count = 0;
      cameras[i].dropped = 0;
      see_around(context, row, cameras[i]);
    }
  }

 private:
  void see_around(const DeviceContext& context, std::size_t row, Port& port) noexcept {
    const Bodies& b = context.stores.bodies;
    const Point from{b.x_m[row], b.y_m[row], context.stores.base_m(row) + height_m_};
    const auto covers = [this](const Point& p) {
      return p[2] <= 0.0 && p[0] * p[0] + p[1] * p[1] <= reach_m_ * reach_m_;
    };
    std::uint32_t number = 0;
    lookout_.look(context.stores, row, from, reach_m_, covers, [&](const Point& p, hal::Rgb color) {
      const std::uint32_t n = number++;
      if (missed(flaws_, context, row, Stream::OmniCameraMiss, n)) return;
      const auto error = errors(flaws_, context, row, Stream::OmniCameraNoise, n);
      const double wx = p[0] + error[0];
      const double wy = p[1] + error[1];
      const double bx = b.cos_h[row] * wx + b.sin_h[row] * wy;
      const double by = b.cos_h[row] * wy - b.sin_h[row] * wx;
      port.insert(static_cast<float>(std::sqrt(wx * wx + wy * wy)), static_cast<float>(std::atan2(by, bx)), color);
    });
  }

  Lookout lookout_;
  double height_m_, reach_m_;
  Errors flaws_;
};

// --- through a lens ---

struct LensOptions : CameraOptions {
  static LensOptions noisy() { return {{.noise = 10 * 0.1, .miss_prob = 10 * 1e-3}}; }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise, hal::unit::none, hal::kNotNegative,
             "Standard deviation of a blob's place in the image, in pixels to the right and downwards.");
    describe_miss(v);
  }
};

/// A pinhole camera. What it sees is nearer than its range and falls into its image.
template <class OfPort>
class LensSensor final : public Sensor {
 public:
  using Port = OfPort;
  using Part = hal::CameraPart;
  using Errors = LensOptions;
  static constexpr std::string_view kMedium = LedMedium::kKind;
  static void prepare(BlockFactory<Sensor>& factory, const DeviceSetup& setup, const Errors&) {
    factory.listens = true;
    factory.reach_m = setup.kind.part<Part>()->range_m;
  }

  LensSensor(const DeviceSetup& setup, const Errors& flaws, const BlockColumns& columns)
      : lookout_(RealSense::LensCamera, setup, columns),
        heads_(columns.find<HeadState>()),
        camera_(*setup.kind.part<hal::CameraPart>()),
        in_head_(setup.kind.part<hal::HeadPart>() != nullptr && !camera_.in_front),
        flaws_(flaws) {
    const auto width = static_cast<double>(camera_.width_px);
    const auto height = static_cast<double>(camera_.height_px);
    px_per_tangent_ = 0.5 * std::sqrt(width * width + height * height) / std::tan(camera_.aperture_rad);
    aim_.cos_tilt = std::cos(camera_.mount().tilt_rad);
    aim_.sin_tilt = std::sin(camera_.mount().tilt_rad);
  }

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* cameras = static_cast<Port*>(ports);
    lookout_.measure(context.stores);
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      if ((context.stores.bodies.flags[row] & kAlive) == 0) continue;
      Port& port = cameras[i];
      stamp(context, port);
      port.width_px = static_cast<std::uint32_t>(camera_.width_px);
      port.height_px = static_cast<std::uint32_t>(camera_.height_px);
      found_ = 0;
      port.dropped = 0;
      see_ahead(context, row, port);
      port.count = 0;
      for (std::size_t k = 0; k < found_; ++k) port.append(blobs_[k].x_px, blobs_[k].y_px, blobs_[k].color);
    }
  }

 private:
  struct Blob {
    double distance2;
    float x_px, y_px;
    hal::Rgb color;
  };
  struct Pixel {
    double x, y;
    bool inside;
  };
  /// Where the axis points: a heading in W, and a tilt above it.
  struct Aim {
    double cos_h = 1.0, sin_h = 0.0;
    double cos_tilt = 1.0, sin_tilt = 0.0;
  };

  Aim aim_of(const Bodies& b, std::size_t row, std::size_t slot) const noexcept {
    Aim aim = aim_;
    aim.cos_h = b.cos_h[row];
    aim.sin_h = b.sin_h[row];
    if (!in_head_ || heads_ == nullptr) return aim;
    const HeadState& head = heads_[slot];
    const double c = std::cos(head.pan_rad);
    const double s = std::sin(head.pan_rad);
    aim.cos_h = b.cos_h[row] * c - b.sin_h[row] * s;
    aim.sin_h = b.sin_h[row] * c + b.cos_h[row] * s;
    aim.cos_tilt = std::sin(head.tilt_rad);  // of a head that looks straight down at 0
    aim.sin_tilt = -std::cos(head.tilt_rad);
    return aim;
  }

  /// Where a point, from the lens in W, falls in the image.
  Pixel pixel(const Aim& aim, const Point& p) const noexcept {
    const double ahead = aim.cos_h * p[0] + aim.sin_h * p[1];
    const double left = aim.cos_h * p[1] - aim.sin_h * p[0];
    const double depth = aim.cos_tilt * ahead + aim.sin_tilt * p[2];
    if (depth <= 0.0) return {0.0, 0.0, false};
    const auto width = static_cast<double>(camera_.width_px);
    const auto height = static_cast<double>(camera_.height_px);
    const double x = 0.5 * width - px_per_tangent_ * left / depth;
    const double y = 0.5 * height + px_per_tangent_ * (aim.sin_tilt * ahead - aim.cos_tilt * p[2]) / depth;
    return {x, y, x >= 0.0 && x <= width && y >= 0.0 && y <= height};
  }

  void see_ahead(const DeviceContext& context, std::size_t row, Port& port) noexcept {
    const Bodies& b = context.stores.bodies;
    const hal::CameraMount& mount = camera_.mount();
    const Point from{b.x_m[row] + b.cos_h[row] * mount.x_m, b.y_m[row] + b.sin_h[row] * mount.x_m,
                     context.stores.base_m(row) + mount.z_m};
    const double range2 = camera_.range_m * camera_.range_m;
    const Aim aim = aim_of(b, row, row - context.block.first_row);
    const auto covers = [&](const Point& p) {
      return p[0] * p[0] + p[1] * p[1] + p[2] * p[2] <= range2 && pixel(aim, p).inside;
    };
    std::uint32_t number = 0;
    lookout_.look(context.stores, row, from, camera_.range_m, covers, [&](const Point& p, hal::Rgb color) {
      const std::uint32_t n = number++;
      if (missed(flaws_, context, row, Stream::CameraMiss, n)) return;
      const Pixel at = pixel(aim, p);
      const auto error = errors(flaws_, context, row, Stream::CameraNoise, n);
      insert({p[0] * p[0] + p[1] * p[1] + p[2] * p[2],
              static_cast<float>(std::clamp(at.x + error[0], 0.0, static_cast<double>(camera_.width_px))),
              static_cast<float>(std::clamp(at.y + error[1], 0.0, static_cast<double>(camera_.height_px))), color},
             port);
    });
  }

  void insert(const Blob& blob, Port& port) noexcept {
    if (found_ == blobs_.size()) {
      ++port.dropped;
      if (blob.distance2 >= blobs_[found_ - 1].distance2) return;
    } else {
      ++found_;
    }
    std::size_t at = found_ - 1;
    for (; at > 0 && blobs_[at - 1].distance2 > blob.distance2; --at) blobs_[at] = blobs_[at - 1];
    blobs_[at] = blob;
  }

  Lookout lookout_;
  const HeadState* heads_;  // null: their controllers turn none
  hal::CameraPart camera_;
  bool in_head_;
  Errors flaws_;
  double px_per_tangent_ = 1.0;
  Aim aim_;                                    // of a robot that looks along x, whose camera hangs in no head
  std::array<Blob, Port::kCapacity> blobs_{};  // nearest first, of one image
  std::size_t found_ = 0;
};

}  // namespace

namespace {

template <class Port>
void add_omni(std::vector<DeviceType>& types) {
  using Device = OmniSensor<Port>;
  add_levels<Device>(types, "Lights in reach and in sight; noise where asked for.", "Lights in reach and in sight.",
                     "Lights in reach and in sight, some missed, places uncertain.");
  types.push_back(device_type<Device, Level::Default>("rot_z_only", "ARGoS' name for the default."));
}

template <class Port>
void add_lens(std::vector<DeviceType>& types) {
  add_levels<LensSensor<Port>>(types, "Lights in the image and in sight; noise where asked for.",
                               "Lights in the image and in sight.",
                               "Lights in the image and in sight, some missed, places uncertain.");
}

}  // namespace

std::vector<DeviceType> camera_types() {
  std::vector<DeviceType> types;
  add_omni<hal::OmnidirectionalCamera>(types);
  add_lens<hal::PerspectiveCamera>(types);
  add_omni<hal::OmnidirectionalCameraMany>(types);
  add_lens<hal::PerspectiveCameraMany>(types);
  return types;
}

}  // namespace tandem::core
