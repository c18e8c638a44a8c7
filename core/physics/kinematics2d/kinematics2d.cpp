#include "core/physics/kinematics2d/kinematics2d.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>

#include "core/physics/crowd_passes.hpp"
#include "core/physics/walls.hpp"
#include "core/physics/wheels.hpp"
#include "hal/unit.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kChunk = 512;  // entries whose active ones form one list
constexpr std::size_t kChunksWorthThreads = 2;
constexpr double kLargestTurn_rad = 0.5;  // of one sub-step: where the series below are exact to 1e-13
constexpr double kLargestHop = 0.5;       // before contacts are resolved, in body radii: nothing is jumped over
constexpr double kFastest_m_s = 100.0;    // what is faster is an error of somebody's
constexpr std::int64_t kFirstPasses = 4;
constexpr double kNear_m = 0.005;  // bodies so near to one of a dense place belong to it
constexpr double kSlack_m = 0.02;  // bodies nearer than this may come to touch within the passes of one tick

/// Rolls rows [begin, end) of one block along their arcs.
void roll(Bodies& b, std::size_t begin, std::size_t end, double wheel_base_m, double dt_s) noexcept {
  double* __restrict x = b.x_m.data();
  double* __restrict y = b.y_m.data();
  double* __restrict c = b.cos_h.data();
  double* __restrict s = b.sin_h.data();
  double* __restrict rolled_left = b.left_m.data();
  double* __restrict rolled_right = b.right_m.data();
  const double* __restrict left = b.left_m_s.data();
  const double* __restrict right = b.right_m_s.data();
  const double per_base = 1.0 / wheel_base_m;
  for (std::size_t i = begin; i < end; ++i) {
    const double l = left[i] * dt_s;
    const double r = right[i] * dt_s;
    rolled_left[i] += l;
    rolled_right[i] += r;
    const double way = 0.5 * (l + r);
    const double d = (r - l) * per_base;  // turned in this step
    const double d2 = d * d;
    // sin(d) / d and (1 - cos(d)) / d
    const double sinc =
        1.0 - d2 * (1.0 / 6 - d2 * (1.0 / 120 - d2 * (1.0 / 5040 - d2 * (1.0 / 362880 - d2 / 39916800.0))));
    const double cosc = d * (0.5 - d2 * (1.0 / 24 - d2 * (1.0 / 720 - d2 * (1.0 / 40320 - d2 / 3628800.0))));
    const double forward = way * sinc;  // chord of the arc, in the frame of the heading before
    const double aside = way * cosc;
    const double c0 = c[i];
    const double s0 = s[i];
    x[i] += c0 * forward - s0 * aside;
    y[i] += s0 * forward + c0 * aside;
    const double sin_d = d * sinc;
    const double cos_d = 1.0 - d * cosc;
    const double c1 = c0 * cos_d - s0 * sin_d;
    const double s1 = s0 * cos_d + c0 * sin_d;
    const double k = 1.5 - 0.5 * (c1 * c1 + s1 * s1);  // one Newton step keeps the heading a unit vector
    c[i] = c1 * k;
    s[i] = s1 * k;
  }
}

/// In how many hops a robot rolls at a speed.
double hops(double speed_m_s, double radius_m, double tick_s) noexcept {
  return speed_m_s * tick_s / (kLargestHop * radius_m);
}

/// How many sub-steps keep turns and hops small at the robot's highest speed.
int sub_steps(const hal::RobotKind& kind, double tick_s) noexcept {
  const hal::DifferentialDrive& wheels = wheels_of(kind);
  const double turn = 2.0 * wheels.max_speed_m_s / wheels.wheel_base_m * tick_s / kLargestTurn_rad;
  const double hop = hops(wheels.max_speed_m_s, kind.body.radius_m, tick_s);
  return std::max(1, static_cast<int>(std::ceil(std::max(turn, hop))));
}

bool too_fast(double left_m_s, double right_m_s) noexcept {
  return !(std::fabs(left_m_s) <= kFastest_m_s && std::fabs(right_m_s) <= kFastest_m_s);  // also when no number
}

/// Commands are within the kind's limits, but hooks write what they like, and a file may multiply it.
bool any_too_fast(const Bodies& b, const RobotBlock& block) noexcept {
  bool any = false;
  for (std::size_t row = block.first_row; row < block.first_row + block.used; ++row)
    any |= too_fast(b.left_m_s[row], b.right_m_s[row]);
  return any;
}

/// Whether this engine moves the bodies of a region.
bool mine(const SpaceStores& stores, std::uint16_t region) noexcept {
  return region != kNoRegion && !stores.regions[region].listed;
}

void raise_to(std::atomic<double>& largest, double value) noexcept {
  double seen = largest.load(std::memory_order_relaxed);
  while (value > seen && !largest.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {
  }
}

/// What contacts are resolved in: everybody's places before the pass.
struct Contacts {
  const SpaceStores& stores;
  const BodyIndex& index;
  double largest_radius_m = 0.0;
  bool walls = false;    // of regions
  bool heights = false;  // some fly

  explicit Contacts(const SpaceStores& s) : stores(s), index(s.body_index), heights(!s.bodies.motion.empty()) {
    for (const RobotGroup& group : s.groups) largest_radius_m = std::max(largest_radius_m, group.kind->body.radius_m);
    for (const Region& region : s.regions) {
      for (const RegionSide& side : region.sides) walls = walls || (side.wall && !region.listed);
    }
  }

  double reach(const IndexEntry& e) const noexcept {
    return static_cast<double>(e.radius_m) + largest_radius_m + kSlack_m;
  }
  bool in_walls(const IndexEntry& e) const noexcept { return walls && stores.bodies.region[e.row()] != kNoRegion; }
};

/// Whether anything is so near to a body that they may touch within the tick.
bool anything_near(const Contacts& contacts, const IndexEntry& e) noexcept {
  // Bodies are counted without a branch, itself included: most have nobody, and some have, at random.
  const IndexEntry* entries = contacts.index.entries();
  unsigned near = 0;
  const double own = static_cast<double>(e.radius_m);
  const auto look_at = [&](const IndexEntry& o, bool is_one) {
    const double dx = e.x_m - o.x_m;
    const double dy = e.y_m - o.y_m;
    const double reach = own + static_cast<double>(o.radius_m) + kSlack_m;
    is_one &= dx * dx + dy * dy < reach * reach;
    near += is_one ? 1U : 0U;
  };
  contacts.index.for_each_run_near(e.x_m, e.y_m, contacts.reach(e), [&](std::uint32_t first, std::uint32_t past) {
    static_assert(BodyIndex::kReadAhead == 2);
    look_at(entries[first], first < past);
    look_at(entries[first + 1], first + 1 < past);
    for (first += 2; first < past; ++first) look_at(entries[first], true);
  });
  bool object_near = false;
  contacts.stores.for_each_object_near(e.x_m, e.y_m, [&](const Object& object) {
    double nx = 0.0;
    double ny = 0.0;
    object_near = object_near || signed_distance(object, e.x_m, e.y_m, nx, ny) - own < kSlack_m;
  });
  return near > 1 || object_near || contacts.in_walls(e);
}

struct Push {
  double x_m = 0.0, y_m = 0.0;
  double overlap = 0.0;  ///< the deepest with another robot, in parts of the narrower one's diameter
};

/// Where a body is pushed to by what it overlaps.
Push push_of(const Contacts& contacts, const IndexEntry& e) noexcept {
  double px = 0.0;
  double py = 0.0;
  double overlap = 0.0;
  const double own = static_cast<double>(e.radius_m);
  contacts.index.for_each_near(e.x_m, e.y_m, contacts.reach(e), [&](const IndexEntry& o) {
    const double dx = e.x_m - o.x_m;
    const double dy = e.y_m - o.y_m;
    const double other = static_cast<double>(o.radius_m);
    const double touch = own + other;
    const double d2 = dx * dx + dy * dy;
    if (d2 >= touch * touch || &o == &e) return;
    if (contacts.heights && o.fixed() && !contacts.stores.side_by_side(e.row(), o.row())) return;  // flies above
    const double d = std::sqrt(d2);
    overlap = std::max(overlap, CrowdPasses::overlap(touch - d, own, other));
    const double share = (touch - d) * (o.fixed() ? 1.0 : 0.5);
    if (d > 0.0) {
      px += dx / d * share;
      py += dy / d * share;
    } else {
      px += e.row() < o.row() ? -share : share;  // two on one spot part along x
    }
  });
  // Out of walls last: they do not give way.
  contacts.stores.for_each_object_near(e.x_m, e.y_m, [&](const Object& object) {
    double nx = 0.0;
    double ny = 0.0;
    const double gap = signed_distance(object, e.x_m + px, e.y_m + py, nx, ny) - own;
    if (gap >= 0.0) return;
    px -= nx * gap;
    py -= ny * gap;
  });
  if (contacts.in_walls(e)) {
    const Region& region = contacts.stores.regions[contacts.stores.bodies.region[e.row()]];
    const auto [wx, wy] = out_of_walls(region, e.x_m + px, e.y_m + py, own);
    px += wx;
    py += wy;
  }
  return {px, py, overlap};
}

/// Marks a body and those that it touches.
void mark_dense(const Contacts& contacts, std::uint32_t entry, std::vector<std::uint8_t>& marks) noexcept {
  const IndexEntry* const entries = contacts.index.entries();
  const IndexEntry& e = entries[entry];
  contacts.index.for_each_near(e.x_m, e.y_m, contacts.reach(e), [&](const IndexEntry& o) {
    const double dx = e.x_m - o.x_m;
    const double dy = e.y_m - o.y_m;
    const double near = static_cast<double>(e.radius_m) + static_cast<double>(o.radius_m) + kNear_m;
    if (dx * dx + dy * dy < near * near)
      std::atomic_ref<std::uint8_t>(marks[static_cast<std::size_t>(&o - entries)]).store(1, std::memory_order_relaxed);
  });
}

}  // namespace

int Kinematics2d::parts(const PhysicsContext& context) const {
  const SpaceStores& stores = context.stores;
  double most = 0.0;
  for (const RobotBlock& block : stores.blocks) {
    const hal::RobotKind& kind = *stores.groups[block.group].kind;
    // With most ticks no robot is fast enough at all.
    const double most_m_s = wheels_of(kind).max_speed_m_s;
    if (kind.flies() || hops(most_m_s, kind.body.radius_m, context.tick_s) <= 1.0) continue;
    const Bodies& b = stores.bodies;
    double fastest_m_s = 0.0;
    for (std::size_t row = block.first_row; row < block.first_row + block.used; ++row)
      fastest_m_s = std::max(fastest_m_s, std::fabs(b.left_m_s[row] + b.right_m_s[row]) * 0.5);
    fastest_m_s = std::min(fastest_m_s, most_m_s);  // hooks may write anything
    most = std::max(most, hops(fastest_m_s, kind.body.radius_m, context.tick_s));
  }
  return std::max(1, static_cast<int>(std::ceil(most)));
}

void Kinematics2d::advance(const PhysicsContext& context) {
  SpaceStores& stores = context.stores;
  const bool all_mine =
      std::none_of(stores.regions.begin(), stores.regions.end(), [](const Region& r) { return r.listed; });
  context.pool.run(stores.blocks.size(), 8, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const RobotBlock& block = stores.blocks[i];
      const hal::RobotKind& kind = *stores.groups[block.group].kind;
      if (kind.flies()) continue;  // never this engine's
      const double wheel_base_m = wheels_of(kind).wheel_base_m;
      const int steps = sub_steps(kind, context.tick_s);
      if (any_too_fast(stores.bodies, block)) too_fast_in_.store(&stores, std::memory_order_relaxed);
      const std::size_t end = block.first_row + block.used;
      std::size_t row = block.first_row;
      while (row < end) {  // runs of rows that are this engine's: with one engine, all of them
        std::size_t next = all_mine ? end : row;
        while (!all_mine && next < end && mine(stores, stores.bodies.region[next])) ++next;
        for (int step = 0; step < steps && next > row; ++step)
          roll(stores.bodies, row, next, wheel_base_m, context.tick_s / steps);
        row = next;
        while (row < end && !mine(stores, stores.bodies.region[row])) ++row;
      }
    }
  });
}

void Kinematics2d::collect(std::vector<Trouble>& all) {
  const SpaceStores* stores = too_fast_in_.exchange(nullptr);
  if (stores == nullptr) return;
  const Bodies& b = stores->bodies;
  for (std::size_t row = 0; row < b.size(); ++row) {
    if ((b.flags[row] & kAlive) == 0 || !mine(*stores, b.region[row]) || !too_fast(b.left_m_s[row], b.right_m_s[row]))
      continue;
    all.push_back({BodyKey::robot(row), "has wheels that are faster than its engine can follow (" +
                                            hal::format_number(b.left_m_s[row]) + " and " +
                                            hal::format_number(b.right_m_s[row]) + " m/s)"});
  }
}

void Kinematics2d::settle(const PhysicsContext& context) {
  SpaceStores& stores = context.stores;
  BodyIndex& index = stores.body_index;
  const std::size_t n = index.size();
  const std::size_t chunks = (n + kChunk - 1) / kChunk;
  if (counts_.size() < chunks) {
    counts_.resize(chunks);
    active_ = std::make_unique_for_overwrite<Active[]>(chunks * kChunk);
  }
  IndexEntry* entries = index.entries();
  const Contacts contacts(stores);
  const auto each_chunk = [&](auto&& work) {
    context.pool.run(chunks, kChunksWorthThreads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t chunk = begin; chunk < end; ++chunk) work(chunk, active_.get() + chunk * kChunk);
    });
  };

  double displacement = 0.0;
  double overlap = 0.0;  // when the last pass began
  const bool adapts = params_.iterations == 0;
  if (adapts && dense_.size() < n) {
    dense_.resize(n);
    dense_next_.resize(n);
  }
  const std::int64_t passes = adapts ? kFirstPasses : params_.iterations;
  bool known = false;  // who is near anything
  const auto find_pushes = [&](bool dense_alone, bool marks) {
    std::atomic<double> deepest{0.0};
    each_chunk([&](std::size_t chunk, Active* active) {
      if (!known) {
        std::uint32_t count = 0;
        for (std::size_t i = chunk * kChunk; i < std::min(n, (chunk + 1) * kChunk); ++i) {
          active[count].entry = static_cast<std::uint32_t>(i);
          if (!entries[i].fixed() && anything_near(contacts, entries[i])) ++count;
        }
        counts_[chunk] = count;
      }
      double deepest_here = 0.0;
      for (Active* a = active; a != active + counts_[chunk]; ++a) {
        a->push_x_m = a->push_y_m = 0.0;
        if (dense_alone && dense_[a->entry] == 0) continue;
        const Push push = push_of(contacts, entries[a->entry]);
        a->push_x_m = push.x_m;
        a->push_y_m = push.y_m;
        deepest_here = std::max(deepest_here, push.overlap);
        if (marks && push.overlap > CrowdPasses::kShallow) mark_dense(contacts, a->entry, dense_next_);
      }
      raise_to(deepest, deepest_here);
    });
    known = true;
    return deepest.load();
  };
  const auto push_apart = [&] {
    std::atomic<double> longest{0.0};
    each_chunk([&](std::size_t chunk, Active* active) {
      double longest_here = 0.0;
      for (Active* a = active; a != active + counts_[chunk]; ++a) {
        const double length = std::fabs(a->push_x_m) + std::fabs(a->push_y_m);
        if (length == 0.0) continue;
        IndexEntry& e = entries[a->entry];
        e.x_m += a->push_x_m;
        e.y_m += a->push_y_m;
        stores.bodies.x_m[e.row()] = e.x_m;
        stores.bodies.y_m[e.row()] = e.y_m;
        longest_here = std::max(longest_here, length);
      }
      raise_to(longest, longest_here);  // a maximum: the same in any order
    });
    displacement += longest.load();
    if (longest.load() > 0.0) index.set_displacement(displacement);
    return longest.load() > 0.0;
  };
  std::int64_t pass = 0;
  bool pushed = true;
  for (; pass < passes && pushed; ++pass) {
    overlap = find_pushes(false, adapts && pass + 1 == passes);
    pushed = push_apart();
  }
  if (adapts && overlap > CrowdPasses::kShallow) {  // the last pass pushed them, perhaps into others
    for (; pass < CrowdPasses::kMostPasses; ++pass) {
      dense_.swap(dense_next_);
      std::fill(dense_next_.begin(), dense_next_.end(), std::uint8_t{0});
      overlap = find_pushes(true, true);
      if (overlap <= CrowdPasses::kDeep) {  // what was pushed out of there may be in others, which were not near then
        known = false;
        overlap = find_pushes(false, true);
      }
      if (overlap <= CrowdPasses::kDeep) break;
      push_apart();
    }
    std::fill(dense_next_.begin(), dense_next_.end(), std::uint8_t{0});
  }
  accuracy_.overlap = std::max(accuracy_.overlap, overlap);
}

namespace {

std::shared_ptr<const void> read(const Element& options, Problems& problems) {
  using Params = Kinematics2d::Params;
  return std::make_shared<Params>(read_settings<Params>(options, problems, {"id", "regions"}, {"boundaries"}));
}

std::unique_ptr<Engine> make(const EngineType& type, const EngineOrder& order) {
  const auto params_of = [](const EngineOrder::Part& part) -> const Kinematics2d::Params& {
    return *static_cast<const Kinematics2d::Params*>(part.params.get());
  };
  const Kinematics2d::Params& first = params_of(order.parts.front());
  for (const EngineOrder::Part& part : order.parts) {
    if (params_of(part).iterations == first.iterations) continue;
    order.problems.push_back({order.file, part.line,
                              "all <" + std::string(type.kind) +
                                  "> work as one and need the same iterations: " + std::to_string(first.iterations) +
                                  " before, " + std::to_string(params_of(part).iterations) + " here",
                              false});
  }
  return std::make_unique<Kinematics2d>(first);
}

}  // namespace

const EngineType& kinematics2d_type() {
  static const EngineType type = [] {
    EngineType t;
    t.kind = "kinematics2d";
    t.summary = "Wheels roll without slip, discs that overlap are pushed apart.";
    t.whole = true;
    t.read = &read;
    t.describe = [](hal::ParamVisitor& visitor) { Kinematics2d::Params{}.describe(visitor); };
    t.make = &make;
    return t;
  }();
  return type;
}

}  // namespace tandem::core
