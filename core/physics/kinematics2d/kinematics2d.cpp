#include "core/physics/kinematics2d/kinematics2d.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <tuple>

#include "core/physics/crowd_passes.hpp"
#include "core/physics/walls.hpp"
#include "core/physics/wheels.hpp"
#include "hal/rounded.hpp"
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

/// How many sub-steps keep turns and hops small at this speed of a wheel.
int sub_steps(const hal::RobotKind& kind, double wheel_m_s, double tick_s) noexcept {
  const double turn = 2.0 * wheel_m_s / wheels_of(kind).wheel_base_m * tick_s / kLargestTurn_rad;
  const double hop = hops(wheel_m_s, kind.body.radius_m, tick_s);
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

/// Marks a body and those whose middles are nearer to its own than `distance_m(own radius, other radius)`.
template <class Distance>
void mark_near(const Contacts& contacts, std::size_t entry, Distance&& distance_m,
               std::vector<std::uint8_t>& marks) noexcept {
  const IndexEntry* const entries = contacts.index.entries();
  const IndexEntry& e = entries[entry];
  contacts.index.for_each_near(e.x_m, e.y_m, contacts.reach(e), [&](const IndexEntry& o) {
    const double dx = e.x_m - o.x_m;
    const double dy = e.y_m - o.y_m;
    const double near = distance_m(static_cast<double>(e.radius_m), static_cast<double>(o.radius_m));
    if (dx * dx + dy * dy < near * near)
      std::atomic_ref<std::uint8_t>(marks[static_cast<std::size_t>(&o - entries)]).store(1, std::memory_order_relaxed);
  });
}

/// The way from where a robot was before it rolled: the chord of its arc.
std::array<double, 2> rolled_m(const SpaceStores& stores, std::size_t row, double dt_s) noexcept {
  const Bodies& b = stores.bodies;
  const double way_m = 0.5 * (b.left_m_s[row] + b.right_m_s[row]) * dt_s;
  const double half =
      0.5 * (b.right_m_s[row] - b.left_m_s[row]) / wheels_of(stores.kind_of_row(row)).wheel_base_m * dt_s;
  const double chord_m = half == 0.0 ? way_m : way_m * std::sin(half) / half;
  const double c = std::cos(half);
  const double s = std::sin(half);  // the heading in the middle of the arc lies behind the one at its end
  return {chord_m * (b.cos_h[row] * c + b.sin_h[row] * s), chord_m * (b.sin_h[row] * c - b.cos_h[row] * s)};
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
  part_s_ = context.tick_s;
  const bool all_mine =
      std::none_of(stores.regions.begin(), stores.regions.end(), [](const Region& r) { return r.listed; });
  context.pool.run(stores.blocks.size(), 8, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const RobotBlock& block = stores.blocks[i];
      const hal::RobotKind& kind = *stores.groups[block.group].kind;
      if (kind.flies()) continue;  // never this engine's
      const double wheel_base_m = wheels_of(kind).wheel_base_m;
      const int steps = sub_steps(kind, top_wheel_m_s(stores, block), context.tick_s);
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
                                            hal::rounded(b.left_m_s[row]) + " and " + hal::rounded(b.right_m_s[row]) +
                                            " m/s)"});
  }
}

/// Contacts of one tick. Moves the entries of the index; the stores keep where bodies rolled to until all is done.
class Kinematics2d::Settling {
 public:
  Settling(Kinematics2d& engine, const PhysicsContext& context)
      : engine_(engine),
        context_(context),
        contacts_(context.stores),
        entries_(context.stores.body_index.entries()),
        n_(context.stores.body_index.size()),
        chunks_((n_ + kChunk - 1) / kChunk) {
    if (engine.counts_.size() < chunks_) {
      engine.counts_.resize(chunks_);
      engine.active_ = std::make_unique_for_overwrite<Active[]>(chunks_ * kChunk);
    }
    if (engine.params_.iterations > 0 || engine.dense_.size() >= n_) return;
    for (auto* marks : {&engine.dense_, &engine.dense_next_, &engine.went_back_}) marks->resize(n_);
  }

  /// @returns the deepest overlap of two robots: of those that it goes on for, what is left.
  double run() {
    const bool adapts = engine_.params_.iterations == 0;
    const std::int64_t passes = adapts ? kFirstPasses : engine_.params_.iterations;
    double overlap = 0.0;  // when the last pass began
    bool pushed = true;
    for (std::int64_t pass = 0; pass < passes && pushed; ++pass) {
      overlap = find_pushes(false, adapts && pass + 1 == passes);
      pushed = push_apart();
    }
    // The last pass pushed them, perhaps into others.
    if (adapts && overlap > CrowdPasses::kShallow) overlap = part_dense();
    write_back();
    return overlap;
  }

 private:
  void list_near(std::size_t chunk, Active* active);
  double find_pushes(bool dense_alone, bool marks);
  bool push_apart();
  double part_dense();
  double send_back();
  double look();
  bool go_back();
  void write_back();
  void next_marks();

  template <class Work>
  void each_chunk(Work&& work) {
    context_.pool.run(chunks_, kChunksWorthThreads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t chunk = begin; chunk < end; ++chunk) work(chunk, engine_.active_.get() + chunk * kChunk);
    });
  }
  /// The largest of what `work(entry)` returns for those that are marked and give way.
  template <class Work>
  double largest_of_dense(Work&& work) {
    std::atomic<double> largest{0.0};
    each_chunk([&](std::size_t chunk, const Active*) {
      double largest_here = 0.0;
      for (std::size_t i = chunk * kChunk; i < std::min(n_, (chunk + 1) * kChunk); ++i) {
        if (engine_.dense_[i] != 0 && !entries_[i].fixed()) largest_here = std::max(largest_here, work(i));
      }
      raise_to(largest, largest_here);  // a maximum: the same in any order
    });
    return largest.load();
  }
  /// How far an entry is from where it rolled to.
  double moved_m(const IndexEntry& e) const noexcept {
    const Bodies& b = context_.stores.bodies;
    return std::fabs(e.x_m - b.x_m[e.row()]) + std::fabs(e.y_m - b.y_m[e.row()]);
  }
  void widen_to(double way_m) noexcept {
    displacement_m_ = std::max(displacement_m_, way_m);
    context_.stores.body_index.set_displacement(displacement_m_);
  }

  Kinematics2d& engine_;
  const PhysicsContext& context_;
  const Contacts contacts_;
  IndexEntry* entries_;
  std::size_t n_, chunks_;
  double displacement_m_ = 0.0;
  bool known_ = false;     // who is near anything
  bool relisted_ = false;  // some that were pushed may not be listed any more
};

/// Lists those of a chunk that may come to touch something.
void Kinematics2d::Settling::list_near(std::size_t chunk, Active* active) {
  const IndexEntry* const entries = entries_;
  const auto last = static_cast<std::uint32_t>(std::min(n_, (chunk + 1) * kChunk));
  std::uint32_t count = 0;
  for (auto i = static_cast<std::uint32_t>(chunk * kChunk); i < last; ++i) {
    active[count].entry = i;
    if (!entries[i].fixed() && anything_near(contacts_, entries[i])) ++count;
  }
  engine_.counts_[chunk] = count;
}

double Kinematics2d::Settling::find_pushes(bool dense_alone, bool marks) {
  std::atomic<double> deepest{0.0};
  each_chunk([&](std::size_t chunk, Active* active) {
    if (!known_) list_near(chunk, active);
    double deepest_here = 0.0;
    for (Active* a = active; a != active + engine_.counts_[chunk]; ++a) {
      a->push_x_m = a->push_y_m = 0.0;
      if (dense_alone && engine_.dense_[a->entry] == 0) continue;
      const Push push = push_of(contacts_, entries_[a->entry]);
      a->push_x_m = push.x_m;
      a->push_y_m = push.y_m;
      deepest_here = std::max(deepest_here, push.overlap);
      if (marks && push.overlap > CrowdPasses::kShallow)
        mark_near(
            contacts_, a->entry, [](double own, double other) { return own + other + kNear_m; }, engine_.dense_next_);
    }
    raise_to(deepest, deepest_here);
  });
  known_ = true;
  return deepest.load();
}

/// @returns whether anybody was pushed.
bool Kinematics2d::Settling::push_apart() {
  std::atomic<double> farthest{0.0};
  std::atomic<bool> pushed{false};
  each_chunk([&](std::size_t chunk, Active* active) {
    double farthest_here = 0.0;
    bool pushed_here = false;
    for (Active* a = active; a != active + engine_.counts_[chunk]; ++a) {
      if (a->push_x_m == 0.0 && a->push_y_m == 0.0) continue;
      IndexEntry& e = entries_[a->entry];
      e.x_m += a->push_x_m;
      e.y_m += a->push_y_m;
      pushed_here = true;
      farthest_here = std::max(farthest_here, moved_m(e));
    }
    raise_to(farthest, farthest_here);
    if (pushed_here) pushed.store(true, std::memory_order_relaxed);
  });
  if (pushed.load()) widen_to(farthest.load());
  return pushed.load();
}

void Kinematics2d::Settling::next_marks() {
  engine_.dense_.swap(engine_.dense_next_);
  std::fill(engine_.dense_next_.begin(), engine_.dense_next_.end(), std::uint8_t{0});
}

/// Passes where it is dense, until nobody is deep in another.
double Kinematics2d::Settling::part_dense() {
  for (std::int64_t pass = kFirstPasses; pass < CrowdPasses::kMostPasses; ++pass) {
    next_marks();
    double overlap = find_pushes(true, true);
    if (overlap <= CrowdPasses::kDeep) {  // what was pushed out of there may be in others, which were not near then
      known_ = false;
      relisted_ = true;
      overlap = find_pushes(false, true);
    }
    if (overlap <= CrowdPasses::kDeep) {
      next_marks();
      return overlap;
    }
    push_apart();
  }
  return send_back();
}

/// Whoever is deep in another even now goes back to where it was before the tick, half its way each time and at last
/// all of it, then those that it meets there, and so on. Nobody was deep before the tick.
double Kinematics2d::Settling::send_back() {
  relisted_ = true;
  const auto mark_all = [this] { std::fill(engine_.dense_.begin(), engine_.dense_.end(), std::uint8_t{1}); };
  std::fill(engine_.went_back_.begin(), engine_.went_back_.end(), std::uint8_t{0});
  std::fill(engine_.dense_next_.begin(), engine_.dense_next_.end(), std::uint8_t{0});
  mark_all();
  do {
    look();
    next_marks();
  } while (go_back());
  mark_all();
  const double overlap = look();
  next_marks();
  return overlap;
}

/// Marks for the next round those that are deep in marked ones, and these.
double Kinematics2d::Settling::look() {
  return largest_of_dense([&](std::size_t i) {
    const double overlap = push_of(contacts_, entries_[i]).overlap;
    if (overlap > CrowdPasses::kDeep)
      mark_near(
          contacts_, i,
          [](double own, double other) { return own + other - 2.0 * CrowdPasses::kDeep * std::min(own, other); },
          engine_.dense_next_);
    return overlap;
  });
}

/// @returns whether any of the marked ones could.
bool Kinematics2d::Settling::go_back() {
  const SpaceStores& stores = context_.stores;
  std::atomic<bool> any{false};
  widen_to(largest_of_dense([&](std::size_t i) {
    std::uint8_t& times = engine_.went_back_[i];
    if (times == CrowdPasses::kHalvings) return 0.0;
    const double share = ++times == CrowdPasses::kHalvings ? 0.0 : 0.5;
    IndexEntry& e = entries_[i];
    const auto [way_x_m, way_y_m] = rolled_m(stores, e.row(), engine_.part_s_);
    const double x_m = stores.bodies.x_m[e.row()] - way_x_m;
    const double y_m = stores.bodies.y_m[e.row()] - way_y_m;
    e.x_m = x_m + share * (e.x_m - x_m);
    e.y_m = y_m + share * (e.y_m - y_m);
    any.store(true, std::memory_order_relaxed);
    return moved_m(e);
  }));
  return any.load();
}

void Kinematics2d::Settling::write_back() {
  Bodies& b = context_.stores.bodies;
  const auto write = [&](const IndexEntry& e) {
    b.x_m[e.row()] = e.x_m;
    b.y_m[e.row()] = e.y_m;
  };
  each_chunk([&](std::size_t chunk, const Active* active) {
    if (relisted_) {
      for (std::size_t i = chunk * kChunk; i < std::min(n_, (chunk + 1) * kChunk); ++i) write(entries_[i]);
      return;
    }
    for (const Active* a = active; a != active + engine_.counts_[chunk]; ++a) write(entries_[a->entry]);
  });
}

void Kinematics2d::settle(const PhysicsContext& context) {
  accuracy_.overlap = std::max(accuracy_.overlap, Settling(*this, context).run());
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
