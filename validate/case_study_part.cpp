// The case study made again, against the table that studies/README.md publishes; and where slanted treels lead,
// against the paper's model by itself.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "core/sim/world.hpp"
#include "hal/device/wheels.hpp"
#include "hal/program.hpp"
#include "hal/temporary_folder.hpp"
#include "validate/closed_forms.hpp"
#include "validate/goodness.hpp"
#include "validate/parts.hpp"
#include "validate/scene.hpp"
#include "validate/standing.hpp"

namespace tandem::validate {
namespace {

constexpr double kSigma = 0.0134, kBase_m = 0.14;  // of the paper's model; of a foot-bot
constexpr double kWay_m = 4.0, kSpeed_m_s = 0.1;

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

std::vector<std::string> split(const std::string& line, char at) {
  std::vector<std::string> cells;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, at);) cells.push_back(trimmed(cell));
  return cells;
}

/// The published means by limit of the carries ("2 m"): ideal, slanted, as they are printed.
std::vector<std::array<std::string, 3>> published() {
  std::vector<std::array<std::string, 3>> rows;
  std::istringstream in(scene_text("../studies/README.md"));
  for (std::string line; std::getline(in, line);) {
    const auto cells = split(line, '|');
    if (cells.size() < 5 || cells[1].empty() || std::isdigit(static_cast<unsigned char>(cells[1][0])) == 0) continue;
    rows.push_back({cells[1].substr(0, cells[1].find(',')), cells[2].substr(0, cells[2].find(' ')),
                    cells[3].substr(0, cells[3].find(' '))});
  }
  return rows;
}

/// Throughputs at the end, by experiment and limit of the carries. @throws std::runtime_error when the sweep fails
std::map<std::string, std::vector<double>> swept() {
  namespace fs = std::filesystem;
  const hal::TemporaryFolder temporary("tandem_case_study");
  const fs::path& folder = temporary.path();
  for (const char* file : {"studies/task_partitioning.xml", "configs/footbot_task_partitioning_ideal.xml",
                           "configs/footbot_task_partitioning_noise.xml"}) {
    fs::create_directories((folder / file).parent_path());
    std::ofstream(folder / file) << scene_text(std::string("../") + file);
  }
  const auto made = hal::run_program(fs::read_symlink("/proc/self/exe").string(),
                                     {"sweep", (folder / "studies/task_partitioning.xml").string(), "--table",
                                      (folder / "table.sqlite").string(), "--quiet"});
  std::map<std::string, std::vector<double>> values;
  std::ifstream in(folder / "table.csv");
  std::string line;
  std::getline(in, line);
  const auto names = split(line, ',');
  const auto column = [&](const std::string& wanted) {
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), wanted) - names.begin());
  };
  const std::size_t experiment = column("experiment"), carry = column("carry"), throughput = column("throughput");
  while (std::getline(in, line)) {
    const auto cells = split(line, ',');
    if (std::max({experiment, carry, throughput}) < cells.size())
      values[cells[experiment] + " " + cells[carry]].push_back(std::strtod(cells[throughput].c_str(), nullptr));
  }
  if (!made.ok()) throw std::runtime_error(made.error().message);
  if (made.value().code != 0) throw std::runtime_error("tandem sweep: " + made.value().errors);
  return values;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? NAN : sum / static_cast<double>(values.size());
}

Table throughputs() {
  Table table{"Throughput",
              "Objects in the last 15 of 60 minutes, mean of 30 seeds: as studies/README.md prints it, and made again.",
              {"carry", "treels", "published", "made again", "runs"},
              {}};
  const auto values = swept();
  for (const auto& [carry, ideal, slanted] : published()) {
    for (const auto& [treels, printed] : {std::pair{"ideal", ideal}, {"slanted", slanted}}) {
      const auto found = values.find(std::string(treels) + " " + carry);
      const std::string again = found == values.end() ? "–" : fmt::format("{:.1f}", mean(found->second));
      const std::size_t runs = found == values.end() ? 0 : found->second.size();
      table.rows.push_back({{carry, treels, printed, again, fmt::format("{}", runs)},
                            "equal to the last digit",
                            verdict_of(again == printed)});
    }
  }
  return table;
}

struct End {
  double ahead_m = 0.0, left_m = 0.0;  ///< from the start, in the robot's own frame then
};

/// Whether no other robot starts so near that both can meet on their ways.
bool alone(const std::vector<core::Pose>& starts, std::size_t i) {
  return std::none_of(starts.begin(), starts.end(), [&](const core::Pose& other) {
    const double apart_m = std::hypot(other.x_m - starts[i].x_m, other.y_m - starts[i].y_m);
    return &other != &starts[i] && apart_m < 2.0 * kWay_m + 0.5;
  });
}

/// Where those of 400 foot-bots that meet nobody end, when they drive so far straight on, by their odometry.
std::vector<End> ends() {
  const auto opened = open_experiment("rolling.xml", 12, {{"{wheels}", "slanted"}});
  core::World& world = opened->world();
  core::Space& space = world.space();
  std::vector<core::Pose> was(space.robot_count());
  for (std::size_t i = 0; i < was.size(); ++i) was[i] = space.pose(space.robot(i));
  const auto ticks = static_cast<int>(std::lround(kWay_m / kSpeed_m_s)) * static_cast<int>(world.ticks_per_second());
  for (int tick = 0; tick < ticks; ++tick) {
    for (std::size_t i = 0; i < was.size(); ++i)
      space.port<hal::WheelSpeeds>(space.robot(i))->set(kSpeed_m_s, kSpeed_m_s);
    world.step();
  }
  std::vector<End> all;
  for (std::size_t i = 0; i < was.size(); ++i) {
    if (!alone(was, i)) continue;
    const core::Pose is = space.pose(space.robot(i));
    const double dx = is.x_m - was[i].x_m, dy = is.y_m - was[i].y_m;
    all.push_back({was[i].cos_h * dx + was[i].sin_h * dy, -was[i].sin_h * dx + was[i].cos_h * dy});
  }
  return all;
}

/// Where the model leads with a right treel that is faster by the part `slant`.
PlanarPlace modelled(double slant) {
  return arc(kSpeed_m_s, kSpeed_m_s * (1.0 + slant), kBase_m, kWay_m / kSpeed_m_s);
}

/// The slant that leads so far to the left, which rises with it as far as a quarter turn and beyond.
double slant_of(double left_m) {
  double low = 0.0, high = 0.08;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (modelled(middle).y_m < left_m ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void add_positions(Part& part) {
  const std::vector<End> all = ends();
  std::vector<double> slants, errors;
  double off_m = 0.0;
  std::string points, curve;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double slant = slant_of(all[i].left_m);
    slants.push_back(slant);
    const PlanarPlace model = modelled(slant);
    off_m = std::max(off_m, std::hypot(model.x_m - all[i].ahead_m, model.y_m - all[i].left_m));
    errors.push_back(std::hypot(all[i].ahead_m - kWay_m, all[i].left_m));
    if (i < 61) points += fmt::format("{} {}\n", all[i].ahead_m, all[i].left_m);
  }
  for (double slant = 0.0; slant <= 0.06; slant += 0.0005)
    curve += fmt::format("{} {}\n", modelled(slant).x_m, modelled(slant).y_m);
  std::sort(errors.begin(), errors.end());
  const Goodness g = kolmogorov_smirnov(slants, [](double x) { return rayleigh_cumulative(x, kSigma); });
  const double most = kSigma * std::sqrt(2.0 * std::log(2.0));  // the median of the distribution
  const double median = std::hypot(modelled(most).x_m - kWay_m, modelled(most).y_m);
  part.tables.push_back(
      {"Positioning error after 4 m",
       "Those of 400 foot-bots with slanted treels that meet nobody drive 4 m straight on; the counterpart of the "
       "paper's figure 12. The "
       "measured points of that figure "
       "are printed in no table, so they are not shown: what is compared is the model that its authors derived from "
       "them.",
       {"what", "model", "simulated"},
       {{{"places lie on the model's curve: farthest off", "0", fmt::format("{:.2g} mm", 1e3 * off_m)},
         "at most 5 mm",
         verdict_of(off_m <= 5e-3)},
        {{"slants, Kolmogorov-Smirnov", "Rayleigh, 0.0134",
          fmt::format("n = {}, D = {:.3f}, p = {:.3f}", g.n, g.statistic, g.p)},
         "p at least 0.001",
         verdict_of(g.p >= 0.001)},
        {{"median error", fmt::format("{:.2f} m", median), fmt::format("{:.2f} m", errors[errors.size() / 2])},
         "",
         Verdict::Told}}});
  part.figures.push_back(
      {"positions",
       "Where 61 foot-bots end that should end at the cross, 4 m from their start, and where the paper's model leads.",
       fmt::format("$points << END\n{}END\n$curve << END\n{}END\nset size ratio -1\nset xlabel 'ahead (m)'\nset ylabel "
                   "'to the left (m)'\n"
                   "set xrange [0:4.3]\nplot $curve with lines linewidth 2 linecolor '#0072B2' "
                   "title 'model, slants of 0 to 6 %', "
                   "$points with points pointtype 6 linecolor '#D55E00' title 'simulated', '+' using (4):(0):(0) every "
                   "::0::0 with points pointtype 2 "
                   "pointsize 2 linecolor '#000000' title 'target'\n",
                   points, curve)});
}

}  // namespace

Part case_study_part(Depth depth) {
  Part part{"Case study: task partitioning", "Pinciroli et al. (2012), section 4.2.2."};
  try {
    add_positions(part);
    if (depth == Depth::Full)
      part.tables.push_back(throughputs());
    else
      part.text += " The short form leaves out the 420 runs of the throughput.";
  } catch (const std::exception& wrong) {
    part.tables.push_back({"Throughput", "", {"error"}, {{{wrong.what()}, "", Verdict::NotMade}}});
  }
  return part;
}

}  // namespace tandem::validate
