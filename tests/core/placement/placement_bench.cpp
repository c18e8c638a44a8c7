// How long placing takes: `bench_core_placement [robots]`, at the density of 10,000 e-pucks in 1,600 m². Run by hand.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/placement/placement.hpp"

int main(int argc, char** argv) {
  using namespace tandem::core;
  const auto quantity = argc > 1 ? std::atoll(argv[1]) : 100'000LL;
  Scenario scenario;
  const double half_m = 0.5 * std::sqrt(0.16 * static_cast<double>(quantity));
  scenario.arena_size = {2.0 * half_m, 2.0 * half_m, 1.0};
  RobotItem item;
  item.kind = "e-puck";
  item.id = "ep";
  item.distribute = Distribute{};
  item.distribute->quantity = quantity;
  item.distribute->max_trials = 10'000;
  item.distribute->position.method = Distribution::Method::Uniform;
  item.distribute->position.min = {-half_m, -half_m, 0.0};
  item.distribute->position.max = {half_m, half_m, 0.0};
  scenario.robots.push_back(item);
  if (argc > 2) {  // the arena of 40 m whatever the number
    scenario.arena_size = {40.0, 40.0, 1.0};
    scenario.robots[0].distribute->position.min = {-20.0, -20.0, 0.0};
    scenario.robots[0].distribute->position.max = {20.0, 20.0, 0.0};
  }
  Problems problems;
  const auto start = std::chrono::steady_clock::now();
  const Placements placements = place(
      scenario, 1, [](const std::string&) { return 0.035; }, problems);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf("{\"robots\": %zu, \"seconds\": %.3f, \"problems\": %zu}\n", placements.robots.size(), took.count(),
              problems.size());
  return problems.empty() ? 0 : 1;
}
