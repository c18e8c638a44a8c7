#include "mixed_reality/gap/measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "hal/angle.hpp"
#include "hal/json/json_access.hpp"
#include "hal/median.hpp"

namespace tandem::mixed_reality {
namespace {

constexpr std::size_t kGrid = 10;

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// The ticks that both runs have of a robot, by number.
struct Pairs {
  std::vector<const RobotTick*> a, b;
};

Pairs pairs_of(const RecordedRun& run_a, const RecordedRobot& a, const RecordedRun& run_b, const RecordedRobot& b) {
  Pairs pairs;
  for (std::size_t i = 0; i < a.ticks.size(); ++i) {
    const hal::Tick in_b = run_a.first + static_cast<hal::Tick>(i) - run_b.first;
    if (in_b < 0 || static_cast<std::size_t>(in_b) >= b.ticks.size()) continue;
    const RobotTick& other = b.ticks[static_cast<std::size_t>(in_b)];
    if (!a.ticks[i].posed || !other.posed) continue;
    pairs.a.push_back(&a.ticks[i]);
    pairs.b.push_back(&other);
  }
  return pairs;
}

/// Distance after the best turn and move of b [Arun et al. 1987, IEEE PAMI 9(5)].
double aligned_m(const Pairs& p) {
  const auto n = static_cast<double>(p.a.size());
  double ax = 0, ay = 0, bx = 0, by = 0;
  for (std::size_t i = 0; i < p.a.size(); ++i) {
    ax += p.a[i]->x_m / n;
    ay += p.a[i]->y_m / n;
    bx += p.b[i]->x_m / n;
    by += p.b[i]->y_m / n;
  }
  double dot = 0, cross = 0;
  for (std::size_t i = 0; i < p.a.size(); ++i) {
    const double x = p.a[i]->x_m - ax, y = p.a[i]->y_m - ay, u = p.b[i]->x_m - bx, v = p.b[i]->y_m - by;
    dot += u * x + v * y;
    cross += u * y - v * x;
  }
  const double turn = std::atan2(cross, dot), c = std::cos(turn), s = std::sin(turn);
  double squares = 0;
  for (std::size_t i = 0; i < p.a.size(); ++i) {
    const double u = p.b[i]->x_m - bx, v = p.b[i]->y_m - by;
    const double dx = p.a[i]->x_m - ax - (c * u - s * v), dy = p.a[i]->y_m - ay - (s * u + c * v);
    squares += dx * dx + dy * dy;
  }
  return std::sqrt(squares / n);
}

/// What it went in the ticks from i to j, seen from where it was.
std::array<double, 2> went(const std::vector<const RobotTick*>& t, std::size_t i, std::size_t j) {
  const double dx = t[j]->x_m - t[i]->x_m, dy = t[j]->y_m - t[i]->y_m;
  const double c = std::cos(t[i]->heading_rad), s = std::sin(t[i]->heading_rad);
  return {c * dx + s * dy, c * dy - s * dx};
}

TrajectoryGap trajectory_gap(const std::string& id, const Pairs& p, std::int64_t ticks_per_second) {
  TrajectoryGap gap;
  gap.id = id;
  gap.ticks = p.a.size();
  if (p.a.empty()) return gap;
  const auto n = static_cast<double>(p.a.size());
  double squares = 0, turns = 0;
  for (std::size_t i = 0; i < p.a.size(); ++i) {
    const double d = std::hypot(p.a[i]->x_m - p.b[i]->x_m, p.a[i]->y_m - p.b[i]->y_m);
    const double h = hal::wrapped(p.a[i]->heading_rad - p.b[i]->heading_rad);
    squares += d * d;
    turns += h * h;
    if (i > 0) gap.way_m += std::hypot(p.a[i]->x_m - p.a[i - 1]->x_m, p.a[i]->y_m - p.a[i - 1]->y_m);
  }
  gap.apart_m = std::sqrt(squares / n);
  gap.heading_rad = std::sqrt(turns / n);
  gap.absolute_m = aligned_m(p);
  const double end_m = std::hypot(p.a.back()->x_m - p.b.back()->x_m, p.a.back()->y_m - p.b.back()->y_m);
  gap.end_m_per_m = gap.way_m > 1e-6 ? end_m / gap.way_m : 0.0;
  const auto second = static_cast<std::size_t>(ticks_per_second);
  double relative = 0;
  std::size_t windows = 0;
  for (std::size_t i = 0; i + second < p.a.size(); ++i, ++windows) {
    const auto u = went(p.a, i, i + second), v = went(p.b, i, i + second);
    relative += (u[0] - v[0]) * (u[0] - v[0]) + (u[1] - v[1]) * (u[1] - v[1]);
  }
  if (windows > 0) gap.relative_m = std::sqrt(relative / static_cast<double>(windows));
  return gap;
}

using Chosen = std::vector<const RecordedRobot*>;

/// Numbers of one run that are compared as distributions.
struct Numbers {
  std::vector<double> speed_m_s, turn_rad_s, near_m, dispersion_m, neighbour_m;
};

Numbers numbers_of(const RecordedRun& run, const Chosen& robots, const Chosen& all) {
  Numbers n;
  for (const RecordedRobot* robot : robots) {
    for (std::size_t i = 1; i < robot->ticks.size(); ++i) {
      const RobotTick &now = robot->ticks[i], &before = robot->ticks[i - 1];
      if (!now.posed || !before.posed) continue;
      n.speed_m_s.push_back(std::hypot(now.x_m - before.x_m, now.y_m - before.y_m) / run.tick_s());
      n.turn_rad_s.push_back(hal::wrapped(now.heading_rad - before.heading_rad) / run.tick_s());
    }
    for (const float near_m : robot->near_m) {
      if (!std::isnan(near_m)) n.near_m.push_back(static_cast<double>(near_m));
    }
  }
  for (std::size_t i = 0; i < run.ticks; ++i) {
    std::vector<const RobotTick*> at;
    for (const RecordedRobot* robot : all) {
      if (i < robot->ticks.size() && robot->ticks[i].posed) at.push_back(&robot->ticks[i]);
    }
    if (at.size() < 2) continue;
    double x = 0, y = 0, sum = 0, nearest_sum = 0;
    for (const RobotTick* t : at) {
      x += t->x_m / static_cast<double>(at.size());
      y += t->y_m / static_cast<double>(at.size());
    }
    for (const RobotTick* t : at) {
      sum += std::hypot(t->x_m - x, t->y_m - y);
      double nearest = std::numeric_limits<double>::infinity();
      for (const RobotTick* o : at) {
        if (o != t) nearest = std::min(nearest, std::hypot(t->x_m - o->x_m, t->y_m - o->y_m));
      }
      nearest_sum += nearest;
    }
    n.dispersion_m.push_back(sum / static_cast<double>(at.size()));
    n.neighbour_m.push_back(nearest_sum / static_cast<double>(at.size()));
  }
  return n;
}

DistributionGap distribution(std::string name, std::string unit, const std::vector<double>& a,
                             const std::vector<double>& b) {
  DistributionGap gap{std::move(name), std::move(unit), a.size(), b.size(), mean(a), mean(b), 0.0, 0.0};
  gap.largest = kolmogorov_smirnov(a, b);
  gap.moved = wasserstein(a, b);
  return gap;
}

struct Area {
  double x = -1.0, y = -1.0, size_x = 2.0, size_y = 2.0;
};

Area area_of(const RecordedRun& run) {
  const hal::Json& arena = hal::object_of(run.scene, "arena");
  Area area{hal::number_of(arena, "min_x", -1.0), hal::number_of(arena, "min_y", -1.0), 0.0, 0.0};
  area.size_x = std::max(1e-6, hal::number_of(arena, "max_x", 1.0) - area.x);
  area.size_y = std::max(1e-6, hal::number_of(arena, "max_y", 1.0) - area.y);
  return area;
}

std::vector<double> places(const Chosen& robots, const Area& area) {
  std::vector<double> cells(kGrid * kGrid, 0.0);
  double all = 0.0;
  const auto cell = [](double part) {
    return std::min(kGrid - 1, static_cast<std::size_t>(std::max(0.0, part) * static_cast<double>(kGrid)));
  };
  for (const RecordedRobot* robot : robots) {
    for (const RobotTick& t : robot->ticks) {
      if (!t.posed) continue;
      cells[cell((t.y_m - area.y) / area.size_y) * kGrid + cell((t.x_m - area.x) / area.size_x)] += 1.0;
      all += 1.0;
    }
  }
  for (double& c : cells) c /= std::max(1.0, all);
  return cells;
}

/// In bits: 0 to 1.
double jensen_shannon(const std::vector<double>& p, const std::vector<double>& q) {
  double sum = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double m = 0.5 * (p[i] + q[i]);
    if (p[i] > 0.0) sum += 0.5 * p[i] * std::log2(p[i] / m);
    if (q[i] > 0.0) sum += 0.5 * q[i] * std::log2(q[i] / m);
  }
  return std::clamp(sum, 0.0, 1.0);
}

/// Numbers that hooks published, of both ends.
std::vector<DistributionGap> measures_of(const RecordedRun& a, const RecordedRun& b) {
  std::vector<DistributionGap> all;
  const auto of = [](const RecordedRun& run) {
    return run.end.is_object() ? run.end.value("measures", hal::Json::object()) : hal::Json::object();
  };
  const hal::Json in_a = of(a), in_b = of(b);
  if (!in_a.is_object() || !in_b.is_object()) return all;
  for (const auto& [name, value] : in_a.items()) {
    const auto other = in_b.find(name);
    if (other == in_b.end() || !value.is_number() || !other->is_number()) continue;
    const std::vector<double> x = {value.get<double>()}, y = {other->get<double>()};
    all.push_back(distribution(name, "", x, y));
  }
  return all;
}

}  // namespace

double kolmogorov_smirnov(std::vector<double> a, std::vector<double> b) {
  if (a.empty() || b.empty()) return a.empty() && b.empty() ? 0.0 : 1.0;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  double most = 0.0;
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const double at = std::min(a[i], b[j]);
    while (i < a.size() && a[i] <= at) ++i;
    while (j < b.size() && b[j] <= at) ++j;
    most = std::max(most, std::fabs(static_cast<double>(i) / static_cast<double>(a.size()) -
                                    static_cast<double>(j) / static_cast<double>(b.size())));
  }
  return most;
}

double wasserstein(std::vector<double> a, std::vector<double> b) {
  if (a.empty() || b.empty()) return 0.0;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  // The integral of the distance of the two inverse distributions.
  const auto na = static_cast<double>(a.size()), nb = static_cast<double>(b.size());
  double sum = 0.0, at = 0.0;
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const double next = std::min(static_cast<double>(i + 1) / na, static_cast<double>(j + 1) / nb);
    sum += (next - at) * std::fabs(a[i] - b[j]);
    if (static_cast<double>(i + 1) / na <= next) ++i;
    if (static_cast<double>(j + 1) / nb <= next) ++j;
    at = next;
  }
  return sum;
}

Gap gap_between(const RecordedRun& a, const RecordedRun& b, const std::vector<std::string>& ids) {
  Gap gap;
  Chosen chosen_a, chosen_b, all_a, all_b;
  for (const RecordedRobot& robot : a.robots) {
    const RecordedRobot* const other = b.find(robot.id);
    if (other == nullptr) continue;
    all_a.push_back(&robot);
    all_b.push_back(other);
    if (!ids.empty() && std::find(ids.begin(), ids.end(), robot.id) == ids.end()) continue;
    chosen_a.push_back(&robot);
    chosen_b.push_back(other);
    gap.robots.push_back(trajectory_gap(robot.id, pairs_of(a, robot, b, *other), a.ticks_per_second));
  }
  const auto typical = [&](double TrajectoryGap::*member) {
    std::vector<double> values;
    for (const TrajectoryGap& robot : gap.robots) values.push_back(robot.*member);
    gap.typical.*member = hal::upper_median(std::move(values));
  };
  gap.typical.id = "median";
  for (double TrajectoryGap::*member :
       {&TrajectoryGap::way_m, &TrajectoryGap::absolute_m, &TrajectoryGap::apart_m, &TrajectoryGap::heading_rad,
        &TrajectoryGap::end_m_per_m, &TrajectoryGap::relative_m})
    typical(member);
  const Numbers in_a = numbers_of(a, chosen_a, all_a), in_b = numbers_of(b, chosen_b, all_b);
  gap.distributions.push_back(distribution("speed", "m/s", in_a.speed_m_s, in_b.speed_m_s));
  gap.distributions.push_back(distribution("turn rate", "rad/s", in_a.turn_rad_s, in_b.turn_rad_s));
  if (!in_a.near_m.empty() && !in_b.near_m.empty())
    gap.distributions.push_back(distribution("proximity", "m", in_a.near_m, in_b.near_m));
  gap.distributions.push_back(distribution("dispersion", "m", in_a.dispersion_m, in_b.dispersion_m));
  gap.distributions.push_back(distribution("nearest neighbour", "m", in_a.neighbour_m, in_b.neighbour_m));
  const Area area = area_of(a);
  gap.occupancy = jensen_shannon(places(all_a, area), places(all_b, area));
  gap.measures = measures_of(a, b);
  return gap;
}

hal::Json to_json(const Gap& gap) {
  const auto trajectory = [](const TrajectoryGap& g) {
    return hal::Json{{"robot", g.id},
                     {"ticks", g.ticks},
                     {"way_m", g.way_m},
                     {"absolute_m", g.absolute_m},
                     {"apart_m", g.apart_m},
                     {"heading_rad", g.heading_rad},
                     {"end_m_per_m", g.end_m_per_m},
                     {"relative_m", g.relative_m}};
  };
  const auto number = [](const DistributionGap& g) {
    return hal::Json{{"name", g.name},
                     {"unit", g.unit},
                     {"a", {{"count", g.count_a}, {"mean", g.mean_a}}},
                     {"b", {{"count", g.count_b}, {"mean", g.mean_b}}},
                     {"kolmogorov_smirnov", g.largest},
                     {"wasserstein", g.moved}};
  };
  hal::Json json = {{"median", trajectory(gap.typical)},
                    {"occupancy_jensen_shannon", gap.occupancy},
                    {"robots", hal::Json::array()},
                    {"distributions", hal::Json::array()},
                    {"measures", hal::Json::array()}};
  for (const TrajectoryGap& g : gap.robots) json["robots"].push_back(trajectory(g));
  for (const DistributionGap& g : gap.distributions) json["distributions"].push_back(number(g));
  for (const DistributionGap& g : gap.measures) json["measures"].push_back(number(g));
  return json;
}

}  // namespace tandem::mixed_reality
