// Noise against the distributions that the manual names: samples are what was read less what the geometry says.
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

#include "core/sim/world.hpp"
#include "hal/device/flight.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/wheels.hpp"
#include "validate/goodness.hpp"
#include "validate/parts.hpp"
#include "validate/sensor_tables.hpp"
#include "validate/standing.hpp"

namespace tandem::validate {
namespace {

constexpr double kLeastP = 0.001;

Row row_of(const std::string& what, const std::string& distribution, const std::string& test, const Goodness& g) {
  return {{what, distribution, test, fmt::format("{}", g.n), fmt::format("{:.4g}", g.statistic),
           fmt::format("{:.3f}", g.p)},
          fmt::format("p at least {:g}", kLeastP),
          verdict_of(g.n >= 20 && g.p >= kLeastP)};
}

Row ks_row(const std::string& what, const std::string& distribution, std::vector<double> sample,
           const std::function<double(double)>& cumulative) {
  return row_of(what, distribution, "Kolmogorov-Smirnov", kolmogorov_smirnov(std::move(sample), cumulative));
}

/// Whether neighbours in a sample know of one another: the correlation of each with the next, by its normal limit.
Row neighbours_row(const std::string& what, const std::vector<double>& sample) {
  double mean = 0.0, square = 0.0, product = 0.0;
  const auto n = static_cast<double>(sample.size());
  for (const double x : sample) mean += x / n;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    square += (sample[i] - mean) * (sample[i] - mean);
    if (i > 0) product += (sample[i] - mean) * (sample[i - 1] - mean);
  }
  const double r = product / square;
  return row_of(what, "no correlation", "normal limit",
                {sample.size(), r, std::erfc(std::abs(r) * std::sqrt(n) / std::sqrt(2.0))});
}

void add_proximity(Table& table, int ticks) {
  const auto opened = open_experiment("noisy.xml", 1);
  core::World& world = opened->world();
  core::Space& space = world.space();
  std::vector<double> errors;
  for (int tick = 0; tick < ticks; ++tick) {
    world.step();
    const Solids solids = solids_of(space);
    for (std::size_t i = 0; i < space.robot_count(); ++i) {
      const core::RobotId robot = space.robot(i);
      const auto* const part = space.kind(robot).part<hal::ProximityPart>();
      const core::Pose pose = space.pose(robot);
      for (std::size_t k = 0; k < part->mounts.size(); ++k) {
        const hal::Mount& m = part->mounts[k];
        const double far = cast(solids, pose.x_m + pose.cos_h * m.x_m - pose.sin_h * m.y_m,
                                pose.y_m + pose.sin_h * m.x_m + pose.cos_h * m.y_m, pose.z_m + m.z_m,
                                pose.heading_rad() + m.bearing_rad, part->range_m, i + 1);
        const double close = 1.0 - far / part->range_m;
        if (close < 0.03 || close > 0.97) continue;  // there the noise is cut off
        const double read = 1.0 - static_cast<double>(space.port<hal::Proximity>(robot)->distance_m[k]) / part->range_m;
        errors.push_back(read - close);
      }
    }
  }
  table.rows.push_back(ks_row("proximity, closeness", "uniform, ±0.02", errors,
                              [](double x) { return uniform_cumulative(x, -0.02, 0.02); }));
  table.rows.push_back(neighbours_row("proximity, one sensor and the next", errors));
}

void add_messages(Table& table, int ticks) {
  const auto opened = open_experiment("noisy.xml", 2);
  core::World& world = opened->world();
  core::Space& space = world.space();
  const std::size_t robots = space.robot_count();
  std::vector<double> errors;
  std::uint64_t sent = 0, lost = 0;
  for (int tick = 0; tick < ticks + 3; ++tick) {
    for (std::size_t i = 0; i < robots; ++i)
      space.port<hal::RangeAndBearingSend>(space.robot(i))->say(static_cast<std::uint8_t>(i));
    world.step();
    if (tick < 3) continue;  // then all have been sent
    for (std::size_t i = 0; i < robots; ++i) {
      const auto& read = *space.port<hal::RangeAndBearing>(space.robot(i));
      const core::Pose at = space.pose(space.robot(i));
      sent += robots - 1;
      lost += robots - 1 - read.count;
      for (std::size_t k = 0; k < read.count; ++k) {
        const core::Pose other = space.pose(space.robot(read.message(k)[0]));
        const double direction = static_cast<double>(read.bearing_rad[k]) + at.heading_rad();
        errors.push_back(at.x_m + static_cast<double>(read.range_m[k]) * std::cos(direction) - other.x_m);
        errors.push_back(at.y_m + static_cast<double>(read.range_m[k]) * std::sin(direction) - other.y_m);
      }
    }
  }
  table.rows.push_back(ks_row("range and bearing, apparent place", "normal, 10 mm", errors,
                              [](double x) { return normal_cumulative(x, 0.01); }));
  table.rows.push_back(row_of("range and bearing, lost messages", "one in 100", "binomial",
                              {sent, static_cast<double>(lost), binomial_p(lost, sent, 0.01)}));
}

void add_floor(Table& table, int ticks) {
  std::vector<double> errors;
  for (const Shade& s : shades("noisy", 3, ticks))
    if (!s.edge) errors.push_back(s.read - s.is);
  table.rows.push_back(
      ks_row("ground sensors", "uniform, ±0.02", errors, [](double x) { return uniform_cumulative(x, -0.02, 0.02); }));
  table.rows.push_back(neighbours_row("ground sensors, one and the next", errors));
}

void add_scanner(Table& table, int ticks) {
  std::vector<double> errors;
  for (const Echo& echo : echoes("noisy", 4, ticks))
    if (!echo.edge && echo.inside) errors.push_back(echo.read_m - echo.is_m);
  table.rows.push_back(ks_row("distance scanner", "uniform, ±10 mm", errors,
                              [](double x) { return uniform_cumulative(x, -0.01, 0.01); }));
  table.rows.push_back(neighbours_row("distance scanner, one measurement and the next", errors));
}

void add_cameras(Table& table, int ticks) {
  std::size_t strangers = 0;
  std::vector<double> mirror, lens;
  std::uint64_t in_sight = 0, missed = 0;
  for (const Sighting& s : sightings("noisy", 5, ticks, strangers)) {
    if (s.should.value_or(false)) ++in_sight, missed += s.found ? 0 : 1;
    if (!s.found || !s.inside) continue;
    auto& errors = s.camera == Sighting::Camera::AllAround ? mirror : lens;
    errors.insert(errors.end(), s.error.begin(), s.error.end());
  }
  table.rows.push_back(ks_row("camera all around, apparent place", "normal, 10 mm", mirror,
                              [](double x) { return normal_cumulative(x, 0.01); }));
  table.rows.push_back(ks_row("cameras with a lens, apparent place", "normal, 1 pixel", lens,
                              [](double x) { return normal_cumulative(x, 1.0); }));
  table.rows.push_back(row_of("cameras, missed lights", "one in 100", "binomial",
                              {in_sight, static_cast<double>(missed), binomial_p(missed, in_sight, 0.01)}));
}

void add_positioning(Table& table, int ticks) {
  const auto opened = open_experiment("positioned.xml", 1);
  core::World& world = opened->world();
  core::Space& space = world.space();
  std::vector<double> places, angles;
  for (int tick = 0; tick < ticks; ++tick) {
    world.step();
    for (std::size_t i = 0; i < space.robot_count(); ++i) {
      const auto& read = *space.port<hal::Positioning>(space.robot(i));
      const core::Pose is = space.pose(space.robot(i));
      places.insert(places.end(), {read.p_WB[0] - is.x_m, read.p_WB[1] - is.y_m, read.p_WB[2] - is.z_m});
      const double heading_rad = 2.0 * std::atan2(read.q_WB[3], read.q_WB[0]);
      angles.push_back(std::remainder(heading_rad - is.heading_rad(), 2.0 * M_PI));
    }
  }
  const auto uniform = [](double x) { return uniform_cumulative(x, -0.01, 0.01); };
  table.rows.push_back(ks_row("positioning, places", "uniform, ±10 mm", places, uniform));
  table.rows.push_back(neighbours_row("positioning, one coordinate and the next", places));
  table.rows.push_back(ks_row("positioning, angles", "uniform, ±10 mrad", angles, uniform));
}

void add_encoders(Table& table, int ticks) {
  constexpr double kSpeed_m_s = 0.1, kTick_s = 0.1;
  const auto opened = open_experiment("rolling.xml", 6, {{"{wheels}", "ideal"}});
  core::World& world = opened->world();
  core::Space& space = world.space();
  std::vector<double> speeds, ways;
  std::vector<hal::WheelEncoders> was(space.robot_count());
  for (int tick = -2; tick < ticks; ++tick) {
    for (std::size_t i = 0; i < was.size(); ++i) {
      was[i] = *space.port<hal::WheelEncoders>(space.robot(i));
      space.port<hal::WheelSpeeds>(space.robot(i))->set(kSpeed_m_s, kSpeed_m_s);
    }
    world.step();
    for (std::size_t i = 0; tick >= 0 && i < was.size(); ++i) {
      const auto& is = *space.port<hal::WheelEncoders>(space.robot(i));
      for (const float speed : {is.left_m_s, is.right_m_s}) speeds.push_back(static_cast<double>(speed) - kSpeed_m_s);
      for (const double way : {is.left_m - was[i].left_m, is.right_m - was[i].right_m})
        ways.push_back(way - kSpeed_m_s * kTick_s);
    }
  }
  table.rows.push_back(ks_row("wheel encoders, speeds", "uniform, ±1 mm/s", speeds,
                              [](double x) { return uniform_cumulative(x, -1e-3, 1e-3); }));
  table.rows.push_back(ks_row("wheel encoders, way of a tick", "uniform, ±0.1 mm", ways,
                              [](double x) { return uniform_cumulative(x, -1e-4, 1e-4); }));
  table.rows.push_back(neighbours_row("wheel encoders, left and right", ways));
}

/// What the wheels rolled in a step, by where the robot was and is.
std::pair<double, double> rolled(const core::Pose& was, const core::Pose& is, double base_m) {
  const double turn = std::remainder(is.heading_rad() - was.heading_rad(), 2.0 * M_PI);
  const double chord = std::hypot(is.x_m - was.x_m, is.y_m - was.y_m);
  const double way = std::abs(turn) < 1e-9 ? chord : chord * (0.5 * turn) / std::sin(0.5 * turn);
  return {way - 0.5 * turn * base_m, way + 0.5 * turn * base_m};
}

void add_wheels(Table& table, int ticks) {
  constexpr double kSpeed_m_s = 0.1, kTick_s = 0.1, kBase_m = 0.14;
  const auto opened = open_experiment("rolling.xml", 1, {{"{wheels}", "noisy"}});
  core::World& world = opened->world();
  core::Space& space = world.space();
  std::vector<double> errors;
  const auto step = [&] {
    for (std::size_t i = 0; i < space.robot_count(); ++i)
      space.port<hal::WheelSpeeds>(space.robot(i))->set(kSpeed_m_s, kSpeed_m_s);
    world.step();
  };
  step();
  step();
  std::vector<core::Pose> was(space.robot_count());
  for (int tick = 0; tick < ticks; ++tick) {
    for (std::size_t i = 0; i < was.size(); ++i) was[i] = space.pose(space.robot(i));
    step();
    for (std::size_t i = 0; i < was.size(); ++i) {
      const auto [left, right] = rolled(was[i], space.pose(space.robot(i)), kBase_m);
      errors.push_back(left / (kSpeed_m_s * kTick_s) - 1.0);
      errors.push_back(right / (kSpeed_m_s * kTick_s) - 1.0);
    }
  }
  table.rows.push_back(ks_row("wheels, relative speed error", "normal, 0.05", errors,
                              [](double x) { return normal_cumulative(x, 0.05); }));
  table.rows.push_back(neighbours_row("wheels, left and right", errors));
}

void add_slanted(Table& table) {
  constexpr double kSpeed_m_s = 0.1, kBase_m = 0.14;
  const auto opened = open_experiment("rolling.xml", 1, {{"{wheels}", "slanted"}});
  core::World& world = opened->world();
  core::Space& space = world.space();
  std::vector<core::Pose> was(space.robot_count());
  for (int tick = 0; tick < 12; ++tick) {
    if (tick == 2)
      for (std::size_t i = 0; i < was.size(); ++i) was[i] = space.pose(space.robot(i));
    for (std::size_t i = 0; i < was.size(); ++i)
      space.port<hal::WheelSpeeds>(space.robot(i))->set(kSpeed_m_s, kSpeed_m_s);
    world.step();
  }
  std::vector<double> slants;
  for (std::size_t i = 0; i < was.size(); ++i) {  // over 1 s
    const auto [left, right] = rolled(was[i], space.pose(space.robot(i)), kBase_m);
    slants.push_back(right / kSpeed_m_s - 1.0);
  }
  table.rows.push_back(ks_row("treels that draw to one side", "Rayleigh, 0.0134", slants,
                              [](double x) { return rayleigh_cumulative(x, 0.0134); }));
}

void add_places(Table& table, int worlds) {
  constexpr std::size_t kCells = 8;
  std::vector<double> headings, across;
  std::vector<std::uint64_t> cells(kCells * kCells);
  for (int seed = 1; seed <= worlds; ++seed) {
    const auto opened = open_experiment("rolling.xml", static_cast<std::uint64_t>(seed), {{"{wheels}", "ideal"}});
    const core::Space& space = opened->world().space();
    for (std::size_t i = 0; i < space.robot_count(); ++i) {
      const core::Pose pose = space.pose(space.robot(i));
      headings.push_back(pose.heading_rad());
      across.push_back(pose.x_m);
      const auto cell = [](double at) {
        return std::min(kCells - 1, static_cast<std::size_t>((at + 400.0) / 800.0 * kCells));
      };
      ++cells[cell(pose.y_m) * kCells + cell(pose.x_m)];
    }
  }
  table.rows.push_back(ks_row("places of robots, x", "uniform, ±400 m", across,
                              [](double x) { return uniform_cumulative(x, -400.0, 400.0); }));
  table.rows.push_back(ks_row("headings of robots", "uniform, ±180°", headings,
                              [](double x) { return uniform_cumulative(x, -M_PI, M_PI); }));
  table.rows.push_back(row_of("places of robots, 8 × 8 cells", "uniform", "chi-square", chi_square(cells)));
}

}  // namespace

Part noise_part(Depth depth) {
  const bool brief = depth == Depth::Short;
  Part part{
      "Noise against its distributions",
      "Seeds are fixed, so p is the same in every run of a release. Of thirty tests of right distributions one has a p "
      "below 0.001 in one report of thirty-three."};
  Table table{"Tests", "", {"noise", "should be", "test", "n", "statistic", "p"}, {}};
  try {
    add_proximity(table, brief ? 20 : 400);
    add_messages(table, brief ? 10 : 200);
    add_floor(table, brief ? 1 : 20);
    add_scanner(table, brief ? 2 : 20);
    add_cameras(table, brief ? 2 : 20);
    add_positioning(table, brief ? 20 : 400);
    add_encoders(table, brief ? 3 : 50);
    add_wheels(table, brief ? 5 : 100);
    add_slanted(table);
    add_places(table, brief ? 2 : 20);
  } catch (const std::runtime_error& wrong) {
    table.rows.push_back({{wrong.what(), "", "", "", "", ""}, "", Verdict::NotMade});
  }
  part.tables.push_back(std::move(table));
  return part;
}

}  // namespace tandem::validate
