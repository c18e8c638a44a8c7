// Range-and-bearing: messages heard from the robots in range, with where they came from.
#include "hal/device/range_and_bearing.hpp"

#include <array>
#include <limits>
#include <numbers>

#include "core/device/shadows.hpp"
#include "core/device/types.hpp"
#include "core/medium/range_and_bearing/range_and_bearing.hpp"
#include "core/random/random.hpp"
#include "core/space/sight.hpp"

namespace tandem::core {
namespace {

struct Hearing {
  std::string medium = {};
  bool check_occlusions = true;
  bool show_rays = false;
  double noise_std_dev_m = 0.0;
  double packet_drop_prob = 0.0;
  static Hearing noisy() { return {.noise_std_dev_m = 10 * 1e-3, .packet_drop_prob = 10 * 1e-3}; }
  void describe_always(hal::ParamVisitor& v) {
    v.text("medium", medium, "Id of the range-and-bearing medium.");
    v.flag("check_occlusions", check_occlusions, "Bodies, boxes and cylinders block messages.");
    v.flag("show_rays", show_rays, "Draw the lines in a view; no effect on readings.");
  }
  void describe(hal::ParamVisitor& v) {
    v.number("noise_std_dev", noise_std_dev_m, hal::unit::m, hal::kNotNegative,
             "Standard deviation of the sender's apparent place, along x and y; where robots fly, along z too.");
    v.number("packet_drop_prob", packet_drop_prob, hal::unit::none, {0.0, 1.0}, "Probability that a message is lost.");
    v.number("loss_probability", packet_drop_prob, hal::unit::none, {0.0, 1.0},
             "The same, as a plug-in of ARGoS names it.");
  }
};

/// Whether the line from a to b passes through an upright disc whose centre lies nearer to a than b does.
bool disc_blocks(double cx, double cy, double radius_m, double low_m, double high_m, const std::array<double, 3>& a,
                 const std::array<double, 3>& b) noexcept {
  const double dx = b[0] - a[0];
  const double dy = b[1] - a[1];
  const double wx = cx - a[0];
  const double wy = cy - a[1];
  if (wx * wx + wy * wy >= dx * dx + dy * dy) return false;
  return disc_on_line(cx, cy, radius_m, low_m, high_m, a, b);
}

/// Messages in range and in sight. Bodies block a line that passes through them; boards that sit on top of their robots
/// see over those of the same height.
///
/// On the ground all ends of most lines are about equally high. Those are judged for all senders at once: from the
/// nearest body on outwards, each adds its shadow, and a sender in the shadow of nearer ones is not heard. Other lines
/// are followed from end to end. Where robots fly, few are near and no two at the same height: there each line is
/// tested with every body that is near.
template <class OfPort>
class RabSensor final : public Sensor {
 public:
  using Port = OfPort;
  using Part = hal::RangeAndBearingPart;
  using Errors = Hearing;
  static constexpr std::string_view kMedium = RangeAndBearingMedium::kKind;
  static void prepare(BlockFactory<Sensor>& factory, const DeviceSetup&, const Errors&) { factory.listens = true; }

  RabSensor(const DeviceSetup& setup, const Errors& options, const BlockColumns&)
      : options_(options), medium_(setup.medium_as<RangeAndBearingMedium>()), channel_(setup.channel) {}

  void sense(const DeviceContext& context, void* ports) noexcept override {
    auto* receivers = static_cast<Port*>(ports);
    double farthest_m = 0.0;
    for (const RobotGroup& group : context.stores.groups) farthest_m = std::max(farthest_m, group.rab_range_m);
    const RobotGroup& first = context.stores.groups.front();
    like_all_ = &first;
    for (const RobotGroup& group : context.stores.groups) {
      if (group.kind != first.kind) like_all_ = nullptr;
    }
    flat_ = like_all_ != nullptr && std::all_of(context.stores.regions.begin(), context.stores.regions.end(),
                                                [](const Region& region) { return region.plane; });
    const bool shadows = options_.check_occlusions && bodies_block(context.stores);
    widest_m_ = widest_body_m(context.stores);
    space_ = std::any_of(context.stores.groups.begin(), context.stores.groups.end(),
                         [](const RobotGroup& group) { return group.kind->flies(); });
    for (std::size_t i = 0; i < context.block.used; ++i) {
      Port& port = receivers[i];
      stamp(context, port);
      port.count = 0;
      port.dropped = 0;
      if (medium_.silent()) continue;
      if (shadows && space_ && hear_in_space(context, context.block.first_row + i, farthest_m, port)) continue;
      if (shadows)
        hear_in_shadows(context, context.block.first_row + i, farthest_m, port);
      else
        hear_all(context, context.block.first_row + i, farthest_m, port);
    }
  }

 private:
  static constexpr std::size_t kCrowd = 96;  // from which on following lines costs less than testing with all
  static constexpr std::size_t kFew = 24;    // up to which sorting by insertion is all that is needed
  static constexpr double kSurelyAside = 1.0 + 1e-9;
  static constexpr double kLevel_m = 0.02;   // lines that rise by no more count as level
  static constexpr double kOnTop_m = 0.005;  // a board this little beneath a body's top sees over it

  /// A sender, seen from the receiver in W.
  struct Sender {
    std::uint32_t row;
    double wx, wy, wz;  ///< of its board relative to the receiver's
  };
  struct Neighbour {
    double distance2;
    std::uint32_t row;
    double wx, wy;
    float radius_m;
    bool operator<(const Neighbour& other) const noexcept {
      return distance2 != other.distance2 ? distance2 < other.distance2 : row < other.row;
    }
  };

  /// A body that is near in space, beside where it is seen from above; heights above the receiver's board.
  struct Around {
    double low_m, high_m;
    double board_m;
    double radius_m;
    std::uint32_t row;
  };

  /// A group of the robot's kind.
  const RobotGroup& group_of(const SpaceStores& stores, std::size_t row) const noexcept {
    return like_all_ != nullptr ? *like_all_ : stores.group_of_row(row);
  }
  double board_m(const SpaceStores& stores, std::size_t row) const noexcept {
    return group_of(stores, row).rab_height_m + stores.base_m(row);
  }

  /// False where all boards look over all bodies: robots of such kinds on level ground.
  static bool bodies_block(const SpaceStores& stores) noexcept {
    double lowest_m = std::numeric_limits<double>::infinity();
    double highest_m = 0.0;
    for (const RobotGroup& group : stores.groups) {
      if (group.kind->flies()) return true;
      if (group.rab_range_m > 0.0) lowest_m = std::min(lowest_m, group.rab_height_m);
      highest_m = std::max(highest_m, group.kind->body.height_m);
    }
    return lowest_m < highest_m - kOnTop_m;
  }

  bool hears(const Broadcast& message) const noexcept {
    return message.size != Broadcast::kSilent && (message.channel == channel_ || message.channel == 0 || channel_ == 0);
  }

  /// The sender in `other` if its message reaches so far.
  bool in_range(const DeviceContext& context, std::uint32_t other, double wx, double wy, double height_m,
                Sender& sender) const noexcept {
    const Broadcast& message = medium_.of(other);
    if (!hears(message)) return false;
    const double reach = static_cast<double>(message.range_m);
    if (wx * wx + wy * wy > reach * reach) return false;
    sender = {other, wx, wy, board_m(context.stores, other) - height_m};
    return wx * wx + wy * wy + sender.wz * sender.wz <= reach * reach;
  }

  /// The nearest first: so each message is put behind those that are there.
  void hear_all(const DeviceContext& context, std::size_t row, double farthest_m, Port& port) noexcept {
    const Bodies& b = context.stores.bodies;
    const double height_m = board_m(context.stores, row);
    if (near_.capacity() == 0) make_room(context.stores, farthest_m);
    near_.clear();
    context.stores.body_index.for_each_near(b.x_m[row], b.y_m[row], farthest_m, [&](const IndexEntry& o) {
      Sender sender{};
      if (o.row() != row && in_range(context, o.row(), o.x_m - b.x_m[row], o.y_m - b.y_m[row], height_m, sender)) {
        const double distance2 = sender.wx * sender.wx + sender.wy * sender.wy + sender.wz * sender.wz;
        near_.push_back({distance2, o.row(), sender.wx, sender.wy, o.radius_m});
      }
    });
    sort_near(farthest_m);
    for (const Neighbour& n : sorted_) {
      receive(context, row, height_m, {n.row, n.wx, n.wy, board_m(context.stores, n.row) - height_m}, port);
    }
  }

  void hear_in_shadows(const DeviceContext& context, std::size_t row, double farthest_m, Port& port) noexcept {
    const SpaceStores& stores = context.stores;
    const Bodies& b = stores.bodies;
    const double height_m = board_m(stores, row);
    if (near_.capacity() == 0) make_room(stores, farthest_m);
    near_.clear();
    stores.body_index.for_each_near(b.x_m[row], b.y_m[row], farthest_m, [&](const IndexEntry& o) {
      const double wx = o.x_m - b.x_m[row];
      const double wy = o.y_m - b.y_m[row];
      const double distance2 = wx * wx + wy * wy;
      if (o.row() != row && distance2 <= farthest_m * farthest_m)
        near_.push_back({distance2, o.row(), wx, wy, o.radius_m});
    });
    sort_near(farthest_m);
    shadows_.clear();
    partial_.clear();
    partial_.reserve(near_.capacity());  // grows when the other lists do, not later
    for (const Neighbour& n : sorted_) {
      if (flat_ && shadows_.full()) break;
      Sender sender{};
      const bool sends = in_range(context, n.row, n.wx, n.wy, height_m, sender);
      const bool level = std::fabs(sender.wz) <= kLevel_m;
      if (shadows_.full() && (!sends || level)) continue;
      const double direction = Shadows::direction(n.wx, n.wy);
      if (sends && (level ? !shadows_.covers(direction) && !behind_partial(stores, row, height_m, sender)
                          : !behind_any(stores, row, height_m, sender)))
        receive(context, row, height_m, sender, port);
      cast_shadow(stores, height_m, n);
    }
  }

  /// False: so many are near that nothing was done.
  bool hear_in_space(const DeviceContext& context, std::size_t row, double farthest_m, Port& port) noexcept {
    const SpaceStores& stores = context.stores;
    const Bodies& b = stores.bodies;
    const double height_m = board_m(stores, row);
    const double within_m = farthest_m + widest_m_;
    std::size_t count = 0;
    bool crowd = false;
    stores.body_index.for_each_near(b.x_m[row], b.y_m[row], within_m, [&](const IndexEntry& o) {
      const double wx = o.x_m - b.x_m[row];
      const double wy = o.y_m - b.y_m[row];
      const double flat2 = wx * wx + wy * wy;
      if (flat2 > within_m * within_m || o.row() == row || crowd) return;
      // Neither a sender nor in the way where no line leads.
      const double low_m = stores.base_m(o.row()) - height_m;
      if (low_m > farthest_m) return;
      const RobotGroup& group = group_of(stores, o.row());
      if (low_m + group.kind->body.height_m < -farthest_m) return;
      crowd = count == kCrowd;
      if (crowd) return;
      const auto radius_m = static_cast<double>(o.radius_m);
      around_x_[count] = wx;
      around_y_[count] = wy;
      around_flat2_[count] = flat2;
      around_aside2_[count] = kSurelyAside * radius_m * radius_m;
      around_[count++] = {low_m, low_m + group.kind->body.height_m - kOnTop_m, low_m + group.rab_height_m, radius_m,
                          o.row()};
    });
    if (crowd) return false;
    std::size_t heard = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Around& n = around_[i];
      const Broadcast& message = medium_.of(n.row);
      const auto reach_m = static_cast<double>(message.range_m);
      const double range2 = around_flat2_[i] + n.board_m * n.board_m;
      if (!hears(message) || range2 > reach_m * reach_m || something_between(i, count)) continue;
      std::size_t at = heard++;
      for (; at > 0 && range2 < heard_[at - 1].range2; --at) heard_[at] = heard_[at - 1];
      heard_[at] = {range2, i};
    }
    for (std::size_t k = 0; k < heard; ++k) {
      const std::size_t i = heard_[k].number;
      receive(context, row, height_m, {around_[i].row, around_x_[i], around_y_[i], around_[i].board_m}, port);
    }
    return true;
  }

  /// Whether the line to number `i` of those around passes through another. In space that may be farther, seen from
  /// above: over or under the sender.
  bool something_between(std::size_t i, std::size_t count) noexcept {
    const double tx = around_x_[i];
    const double ty = around_y_[i];
    const double t2 = around_flat2_[i];
    // Most lie aside of it by more than their radius, or behind the receiver: not above 0 is what may be in between.
    // One loop that the compiler makes vectors of, then one that picks.
    for (std::size_t k = 0; k < count; ++k) {
      const double cross = around_x_[k] * ty - around_y_[k] * tx;
      const double along = around_x_[k] * tx + around_y_[k] * ty;
      const double aside = cross * cross - around_aside2_[k] * t2;
      const double outside = around_flat2_[k] - around_aside2_[k];
      const double behind = outside < -along ? outside : -along;
      clear_[k] = aside > behind ? aside : behind;
    }
    std::size_t left = 0;
    for (std::size_t k = 0; k < count; ++k) {
      may_block_[left] = static_cast<std::uint32_t>(k);
      left += ((clear_[k] <= 0.0) & (k != i)) ? 1 : 0;
    }
    for (std::size_t m = 0; m < left; ++m) {
      const std::size_t k = may_block_[m];
      const Around& n = around_[k];
      if (disc_on_line(around_x_[k], around_y_[k], n.radius_m, n.low_m, n.high_m, {}, {tx, ty, around_[i].board_m}))
        return true;
    }
    return false;
  }

  /// Twice as many neighbours as robots that were spread evenly would have: later steps are not to allocate.
  void make_room(const SpaceStores& stores, double farthest_m) noexcept {
    const double area_m2 = (stores.max_x_m - stores.min_x_m) * (stores.max_y_m - stores.min_y_m);
    const double living = static_cast<double>(stores.living.size());
    const double even = living * std::numbers::pi * farthest_m * farthest_m / area_m2;
    const auto room = static_cast<std::size_t>(std::min(living, 2.0 * even + 64.0));
    near_.reserve(room);
    sorted_.reserve(room);
    partial_.reserve(room);
    shadows_.reserve(room);
  }

  /// Puts `near_` in order into `sorted_`: first by rings of equal area, which in a crowd hold equally many, then by
  /// insertion, for which hardly anything is left to do.
  void sort_near(double farthest_m) noexcept {
    constexpr std::size_t kRings = 64;
    if (near_.size() <= kFew) {
      sorted_.clear();
      for (const Neighbour& n : near_) insert_sorted(n);
      return;
    }
    const double rings_per_m2 = kRings / (farthest_m * farthest_m);
    const auto ring_of = [&](const Neighbour& n) {
      return std::min(kRings - 1, static_cast<std::size_t>(n.distance2 * rings_per_m2));
    };
    std::array<std::uint32_t, kRings + 1> start{};
    for (const Neighbour& n : near_) ++start[ring_of(n) + 1];
    for (std::size_t ring = 0; ring < kRings; ++ring) start[ring + 1] += start[ring];
    sorted_.resize(near_.size());
    for (const Neighbour& n : near_) sorted_[start[ring_of(n)]++] = n;
    for (std::size_t i = 1; i < sorted_.size(); ++i) sink(i, sorted_[i]);
  }
  void insert_sorted(const Neighbour& n) noexcept {
    sorted_.push_back(n);
    sink(sorted_.size() - 1, n);
  }
  /// Puts `n` where it belongs among the `at` entries that are in order.
  void sink(std::size_t at, const Neighbour n) noexcept {
    for (; at > 0 && n < sorted_[at - 1]; --at) sorted_[at] = sorted_[at - 1];
    sorted_[at] = n;
  }

  /// Bodies that span all heights of level lines cast a shadow; those that span some are kept to be looked at one by
  /// one.
  void cast_shadow(const SpaceStores& stores, double height_m, const Neighbour& n) noexcept {
    const double low_m = stores.base_m(n.row);
    const double high_m = low_m + group_of(stores, n.row).kind->body.height_m - kOnTop_m;
    if (low_m <= height_m - kLevel_m && high_m >= height_m + kLevel_m)
      shadows_.add(n.wx, n.wy, static_cast<double>(n.radius_m));
    else if (low_m <= height_m + kLevel_m && high_m >= height_m - kLevel_m)
      partial_.push_back(n.row);
  }

  bool blocked_by(const SpaceStores& stores, std::size_t other, const std::array<double, 3>& from,
                  const std::array<double, 3>& to) const noexcept {
    const Bodies& b = stores.bodies;
    const double low_m = stores.base_m(other);
    return disc_blocks(b.x_m[other], b.y_m[other], static_cast<double>(b.radius_m[other]), low_m,
                       low_m + group_of(stores, other).kind->body.height_m - kOnTop_m, from, to);
  }

  bool behind_partial(const SpaceStores& stores, std::size_t row, double height_m,
                      const Sender& sender) const noexcept {
    const Bodies& b = stores.bodies;
    const std::array<double, 3> from{b.x_m[row], b.y_m[row], height_m};
    const std::array<double, 3> to{from[0] + sender.wx, from[1] + sender.wy, height_m + sender.wz};
    return std::any_of(partial_.begin(), partial_.end(),
                       [&](std::uint32_t other) { return blocked_by(stores, other, from, to); });
  }

  /// Follows the line through the index.
  bool behind_any(const SpaceStores& stores, std::size_t row, double height_m, const Sender& sender) const noexcept {
    const Bodies& b = stores.bodies;
    const std::array<double, 3> from{b.x_m[row], b.y_m[row], height_m};
    const std::array<double, 3> to{from[0] + sender.wx, from[1] + sender.wy, height_m + sender.wz};
    return any_body_near_line(stores, widest_m_, from, to, [&](std::uint32_t other) {
      if (other == row || other == sender.row) return false;
      const double low_m = stores.base_m(other);
      return disc_on_line(b.x_m[other], b.y_m[other], static_cast<double>(b.radius_m[other]), low_m,
                          low_m + group_of(stores, other).kind->body.height_m - kOnTop_m, from, to);
    });
  }

  /// Takes the message in, unless an object is in between or it gets lost.
  void receive(const DeviceContext& context, std::size_t row, double height_m, const Sender& sender,
               Port& port) const noexcept {
    const SpaceStores& stores = context.stores;
    const Bodies& b = stores.bodies;
    if (stores.senses_really(row, sender.row, RealSense::Messages)) return;
    const Broadcast& message = medium_.of(sender.row);
    const double x = b.x_m[row];
    const double y = b.y_m[row];
    double wx = sender.wx;
    double wy = sender.wy;
    double wz = sender.wz;
    if (options_.check_occlusions && !in_sight(stores, x, y, height_m, x + wx, y + wy, height_m + sender.wz)) return;
    if (options_.packet_drop_prob > 0.0 && lost(context, b.entity[row], b.entity[sender.row])) return;
    if (options_.noise_std_dev_m > 0.0) {
      const auto bits =
          draw(context.seed, b.entity[row], Stream::RabNoise, context.tick, b.entity[sender.row] & 0xFFFFFFU);
      const auto noise = to_normal(bits[0], bits[1]);
      wx += options_.noise_std_dev_m * noise[0];
      wy += options_.noise_std_dev_m * noise[1];
      if (space_) wz += options_.noise_std_dev_m * to_normal(bits[2], bits[3])[0];
    }
    const double flat2 = wx * wx + wy * wy;
    const auto range = static_cast<float>(std::sqrt(flat2 + wz * wz));
    if (port.count == Port::kCapacity && range >= port.range_m[Port::kCapacity - 1]) {
      ++port.dropped;
      return;
    }
    const double bx = b.cos_h[row] * wx + b.sin_h[row] * wy;
    const double by = b.cos_h[row] * wy - b.sin_h[row] * wx;
    const float elevation = wz == 0.0 ? 0.0F : static_cast<float>(std::atan2(wz, std::sqrt(flat2)));
    const auto bearing = static_cast<float>(std::atan2(by, bx));
    if constexpr (Port::kPayload > hal::kRabPayloadMax) {
      if (message.size > hal::kRabPayloadMax) {
        std::array<std::uint8_t, Port::kPayload> whole{};
        const LongPart& more = medium_.long_of(sender.row);
        std::copy(more.begin(), more.end(), std::copy(message.payload.begin(), message.payload.end(), whole.begin()));
        return port.insert(range, bearing, elevation, whole.data(), message.size);
      }
    }
    const auto size = static_cast<std::uint8_t>(std::min<std::size_t>(message.size, hal::kRabPayloadMax));
    port.insert(range, bearing, elevation, message.payload.data(), size);
  }

  bool lost(const DeviceContext& context, std::uint32_t receiver, std::uint32_t sender) const noexcept {
    const auto bits = draw(context.seed, receiver, Stream::RabLoss, context.tick, sender & 0xFFFFFFU);
    return to_unit(bits[0]) < options_.packet_drop_prob;
  }

  Hearing options_;
  const RangeAndBearingMedium& medium_;
  std::uint8_t channel_;
  const RobotGroup* like_all_ = nullptr;  // a group, where all are of one kind
  bool flat_ = false;                     // all boards are equally high
  bool space_ = false;                    // there are robots that fly
  // While one robot listens: who is near, what lies in their shadow, and who blocks some heights only.
  std::vector<Neighbour> near_, sorted_;
  double widest_m_ = 0.0;  // of all bodies
  std::array<Around, kCrowd> around_{};
  std::array<double, kCrowd> around_x_{}, around_y_{}, around_flat2_{}, around_aside2_{}, clear_{};
  std::array<std::uint32_t, kCrowd> may_block_{};
  struct Heard {
    double range2;
    std::size_t number;  ///< of `around_`
  };
  std::array<Heard, kCrowd> heard_{};
  Shadows shadows_;
  std::vector<std::uint32_t> partial_;
};

// --- sending ---

struct Sending {
  std::string medium = {};
  double failure_prob = 0.0;
  static Sending noisy() { return {.failure_prob = 10 * 1e-3}; }
  void describe_always(hal::ParamVisitor& v) { v.text("medium", medium, "Id of the range-and-bearing medium."); }
  void describe(hal::ParamVisitor& v) {
    v.number("failure_prob", failure_prob, hal::unit::none, {0.0, 1.0},
             "Probability that a broadcast is not sent at all.");
  }
};

template <class OfPort>
class RabActuator final : public Actuator {
 public:
  using Port = OfPort;
  using Part = hal::RangeAndBearingPart;
  using Errors = Sending;
  static constexpr std::string_view kMedium = RangeAndBearingMedium::kKind;
  static void prepare(BlockFactory<Actuator>& factory, const DeviceSetup&, const Errors&) { factory.publishes = true; }

  RabActuator(const DeviceSetup& setup, const Errors& errors, const BlockColumns&)
      : failure_prob_(errors.failure_prob),
        medium_(setup.medium_as<RangeAndBearingMedium>()),
        channel_(setup.channel) {}

  void act(const DeviceContext& context, SpaceStores& stores, const void* ports) noexcept override {
    Broadcast* const broadcasts = medium_.publish(context.block);
    if (broadcasts == nullptr) return;
    const auto* senders = static_cast<const Port*>(ports);
    constexpr std::size_t kMost = std::tuple_size_v<decltype(Port::payload)>;
    const auto most = static_cast<std::uint8_t>(std::min<std::size_t>(context.group.rab_payload, kMost));
    LongPart* const longer = kMost > hal::kRabPayloadMax ? medium_.publish_long(context.block) : nullptr;
    for (std::size_t i = 0; i < context.block.used; ++i) {
      const std::size_t row = context.block.first_row + i;
      Broadcast& out = broadcasts[i];
      const bool able = (stores.bodies.flags[row] & kAlive) != 0 && context.block.halted[i] == 0;
      const bool sends = able && senders[i].sending && !fails(context, stores.bodies.entity[row]);
      out.size = sends ? std::min(senders[i].size, most) : Broadcast::kSilent;
      out.channel = channel_;
      std::copy_n(senders[i].payload.begin(), hal::kRabPayloadMax, out.payload.begin());
      if constexpr (kMost > hal::kRabPayloadMax) {
        if (longer != nullptr)
          std::copy(senders[i].payload.begin() + hal::kRabPayloadMax, senders[i].payload.end(), longer[i].begin());
      }
      out.range_m = static_cast<float>(context.group.rab_range_m);
    }
  }

 private:
  bool fails(const DeviceContext& context, std::uint32_t entity) const noexcept {
    return failure_prob_ > 0.0 &&
           to_unit(draw(context.seed, entity, Stream::SendLoss, context.tick)[0]) < failure_prob_;
  }

  double failure_prob_;
  RangeAndBearingMedium& medium_;
  std::uint8_t channel_;
};

}  // namespace

namespace {

/// `Hears` and `Sends` are the devices of one form of the two ports.
template <class Hears, class Sends>
void add_boards(std::vector<DeviceType>& types) {
  add_levels<Hears>(types, "Messages in range and in sight; noise and loss where asked for.",
                    "Messages in range and in sight.", "Messages in range and in sight, some lost, places uncertain.");
  types.push_back(device_type<Hears, Level::Default>("medium", "ARGoS' name for the default."));
  add_levels<Sends>(types, "Broadcasts to the robots in range in the next tick; failures where asked for.",
                    "Broadcasts to the robots in range in the next tick.",
                    "Broadcasts to the robots in range in the next tick, but for some failures.");
  types.push_back(device_type<Sends, Level::Default>("medium", "The default, as a plug-in of ARGoS names it."));
}

}  // namespace

std::vector<DeviceType> range_and_bearing_types() {
  std::vector<DeviceType> types;
  add_boards<RabSensor<hal::RangeAndBearing>, RabActuator<hal::RangeAndBearingSend>>(types);
  add_boards<RabSensor<hal::RangeAndBearingMany>, RabActuator<hal::RangeAndBearingLongSend>>(types);
  return types;
}

}  // namespace tandem::core
