// Real robots that are driven at one another, over hidden delays: how near they come, and which of it the contract
// allows.
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

#include "validate/laboratory.hpp"
#include "validate/parts.hpp"

namespace tandem::validate {
namespace {

constexpr double kBody_m = 2.0 * 0.085036758;  // two foot-bots that touch, from axis to axis
constexpr double kApart_m = 0.01;              // the default of <safety>
constexpr double kLatency_ms = 50.0;           // the same
constexpr double kPhase_s = 8.0;               // towards one another, or back

/// There for 8 s, back for 8 s, at speeds that change: delays show where they do.
constexpr const char* kMeet = R"(
local n = 0
function step()
  local forward = math.floor(n / 80) % 2 == 0 and 1 or -0.5
  local speed = forward * (math.floor(n / 7) % 2 == 0 and 15 or 10)
  n = n + 1
  robot.wheels.set_velocity(speed, speed)
end
)";

struct Encounters {
  double delay_ms = 0.0;
  std::vector<double> gaps_m;  ///< the smallest of each
};

/// The smallest gap in each phase in which they drive at one another, by their own logs.
Encounters encounters_of(double delay_ms, const TrueTrack& a, const TrueTrack& b, double begin_ns, double end_ns) {
  Encounters all{delay_ms, {}};
  for (double phase = begin_ns; phase + kPhase_s * 1e9 < end_ns; phase += 2.0 * kPhase_s * 1e9) {
    double least = INFINITY;
    for (double t = phase; t < std::min(end_ns, phase + (kPhase_s + 2.0) * 1e9); t += 5e6) {
      const TruePlace pa = place_at(a, t), pb = place_at(b, t);
      least = std::min(least, std::hypot(pa.x_m - pb.x_m, pa.y_m - pb.y_m) - kBody_m);
    }
    if (least < 0.5) all.gaps_m.push_back(least);
  }
  return all;
}

Row row_of(const Encounters& e) {
  const auto contacts = [](double gap) { return gap <= 0.0; };
  const auto touched = std::count_if(e.gaps_m.begin(), e.gaps_m.end(), contacts);
  const bool counted_on = e.delay_ms <= kLatency_ms;
  const auto first = e.gaps_m.begin() + (counted_on ? 0 : 1);
  const auto broken = first > e.gaps_m.end() ? 0 : std::count_if(first, e.gaps_m.end(), contacts);
  std::vector<std::string> gaps;
  for (const double gap : e.gaps_m) gaps.push_back(fmt::format("{:.0f}", 1e3 * gap));
  return {{fmt::format("{:g} ms", e.delay_ms), fmt::format("{}", e.gaps_m.size()), fmt::format("{}", touched),
           fmt::format("{}", fmt::join(gaps, " "))},
          counted_on ? "no contact: the latency covers it"
                     : "no contact once it was measured, from the second encounter on",
          verdict_of(e.gaps_m.size() >= 3 && broken == 0)};
}

Figure figure_of(const std::vector<Encounters>& all) {
  std::string first, later;
  for (const Encounters& e : all)
    for (std::size_t i = 0; i < e.gaps_m.size(); ++i)
      (i == 0 ? first : later) += fmt::format("{} {}\n", e.delay_ms, 1e3 * e.gaps_m[i]);
  return {"barrier", "Smallest gap between two robots that are driven at one another, over the hidden delay.",
          fmt::format("$first << END\n{}END\n$later << END\n{}END\n"
                      "set xlabel 'hidden delay (ms)'\nset ylabel 'smallest gap (mm)'\n"
                      "set arrow 1 from {} , graph 0 to {} , graph 1 nohead dashtype 2\nset label 1 'latency counted "
                      "on' at {} , graph 0.95 offset 0.5,0\n"
                      "plot 0 with lines linewidth 2 linecolor '#D55E00' title 'contact', {} with lines dashtype 3 "
                      "linecolor '#009E73' title 'apart', "
                      "$first using 1:2 with points pointtype 6 linecolor '#000000' title 'first encounter', $later "
                      "using 1:2 with points pointtype 7 "
                      "linecolor '#0072B2' title 'later ones'\n",
                      first, later, kLatency_ms, kLatency_ms, kLatency_ms, 1e3 * kApart_m)};
}

/// Of a run of pairs, each with its hidden delay.
void judge(Part& part, const Laboratory& lab, const MixedRun& run, const std::vector<double>& delays_ms) {
  Table table{"Encounters", "", {"hidden delay", "encounters", "contacts", "smallest gap of each (mm)"}, {}};
  const auto clocks = lab.table("run time clock");
  if (!clocks.ok()) throw std::runtime_error(clocks.error().message);
  const auto& ticks = clocks.value().rows.at("run");
  const std::size_t monotonic = clocks.value().column("monotonic_ns");
  std::vector<Encounters> all;
  for (std::size_t i = 0; i < delays_ms.size(); ++i) {
    const auto a = lab.log_of(run.robots[2 * i].id), b = lab.log_of(run.robots[2 * i + 1].id);
    if (!a.ok() || !b.ok()) throw std::runtime_error("a robot's log tells no places");
    all.push_back(encounters_of(delays_ms[i], a.value(), b.value(), ticks.front()[monotonic], ticks.back()[monotonic]));
    table.rows.push_back(row_of(all.back()));
  }
  part.tables.push_back(std::move(table));
  part.figures.push_back(figure_of(all));
}

}  // namespace

Part barrier_part(Depth depth) {
  Part part{"Barrier: contacts over hidden delay",
            "Pairs of emulated foot-bots are driven at one another at 10 and 15 cm/s; their motors obey later than the "
            "hub is told. Latency (50 ms) and "
            "distance (10 mm) are the defaults of <safety>. Gaps are those of the robots' own logs."};
  if (depth == Depth::Short) {
    part.text += " It takes minutes, so the short form leaves it out.";
    return part;
  }
  const std::vector<double> delays_ms = {0.0, 30.0, 50.0, 110.0, 160.0, 220.0, 300.0};
  MixedRun run{{}, kMeet, "", 100.0};
  for (std::size_t i = 0; i < delays_ms.size(); ++i)
    for (std::size_t side = 0; side < 2; ++side)
      run.robots.push_back({fmt::format("fb{}", 2 * i + side),
                            side == 0 ? -0.8 : 0.8,
                            3.0 * static_cast<double>(i) - 9.0,
                            side == 0 ? 0.0 : 180.0,
                            {"--command_delay", fmt::format("{} s", delays_ms[i] / 1e3)}});
  try {
    in_fair_trials(part, run, [&](Part& judged, const Laboratory& lab) { judge(judged, lab, run, delays_ms); });
  } catch (const std::exception& wrong) {
    part.tables.push_back({"Encounters", "", {"error"}, {{{wrong.what()}, "", Verdict::NotMade}}});
  }
  return part;
}

}  // namespace tandem::validate
