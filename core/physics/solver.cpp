#include "core/physics/solver.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "hal/unit.hpp"

namespace tandem::core {
namespace {

constexpr std::size_t kFewBodies = 100;  // whose solving takes less than waking threads is worth

constexpr double kCrowded =
    1.5 * CrowdPasses::kDeep;  // deeper than solvers leave two robots in one another that press head-on

}  // namespace

std::string beyond_limits(std::string_view engine, const Object& object, std::initializer_list<double> sizes_m,
                          double thinnest_m) {
  constexpr double kLightest_kg = 1e-9;
  constexpr double kHeaviest_kg = 1e9;
  constexpr double kLargest_m = 1e6;
  const std::string name = "the engine " + std::string(engine) + " moves objects of ";
  for (const double size_m : sizes_m) {
    if (size_m >= thinnest_m && size_m <= kLargest_m) continue;
    return "measures " + hal::format_number(size_m) + " m; " + name + hal::format_number(thinnest_m) + " m to " +
           hal::format_number(kLargest_m) + " m";
  }
  if (object.mass_kg >= kLightest_kg && object.mass_kg <= kHeaviest_kg) return "";
  return "weighs " + hal::format_number(object.mass_kg) + " kg; " + name + hal::format_number(kLightest_kg) +
         " kg to " + hal::format_number(kHeaviest_kg) + " kg";
}

std::unique_ptr<Engine> make_solvers(const EngineType& type, const EngineOrder& order) {
  auto engine = std::make_unique<SolverEngine>(type.kind, type.traits.plane);
  for (const EngineOrder::Part& part : order.parts) {
    const Region& region = order.stores.regions[part.region];
    engine->add(part.region, type.make_solver(part.params, order.stores, region, order.tick_s));
  }
  return engine;
}

template <class Work>
void SolverEngine::each_busy_part(ThreadPool& pool, Work&& work) {
  const std::size_t grain = bodies_ < kFewBodies ? std::max<std::size_t>(1, busy_.size()) : 1;
  pool.run(busy_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work(parts_[busy_[i]]);
  });
}

void SolverEngine::add(std::size_t region, std::unique_ptr<Solver> solver) {
  crowds_.moves(region);
  parts_.push_back({region, std::move(solver)});
}

void SolverEngine::load(const PhysicsContext& context) {
  crowds_.start(context.stores);
  busy_.clear();
  bodies_ = 0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Region& region = context.stores.regions[parts_[i].region];
    const std::size_t bodies = region.owned.size() + region.mirrored.size();
    if (bodies == 0) continue;
    busy_.push_back(i);
    bodies_ += bodies;
  }
  each_busy_part(context.pool, [&](Part& part) {
    part.solver->load({context.stores, context.stores.regions[part.region], context.tick_s, context.tick});
  });
}

void SolverEngine::advance(const PhysicsContext& context) {
  each_busy_part(context.pool, [&](Part& part) {
    part.solver->advance({context.stores, context.stores.regions[part.region], context.tick_s, context.tick});
  });
  part_crowds(context.stores);
}

void SolverEngine::part_crowds(SpaceStores& stores) {
  double overlap = crowds_.overlap_at_borders(stores);
  for (const std::size_t i : busy_) overlap = std::max(overlap, parts_[i].solver->overlap);
  if (overlap > kCrowded) {
    overlap = crowds_.settle(stores);
    for (Part& part : parts_) part.solver->crowds_moved = true;
  }
  accuracy_.overlap = std::max(accuracy_.overlap, overlap);
}

void SolverEngine::collect(std::vector<Trouble>& all) {
  for (Part& part : parts_) {
    std::move(part.solver->trouble.begin(), part.solver->trouble.end(), std::back_inserter(all));
    part.solver->trouble.clear();
  }
}

PhysicsAccuracy SolverEngine::accuracy() const {
  PhysicsAccuracy all = accuracy_;
  for (const Part& part : parts_) all.add(part.solver->accuracy);
  return all;
}

bool SolverEngine::remember(hal::Archive& archive) {
  return std::ranges::all_of(parts_, [&](Part& part) { return part.solver->remember(archive); });
}

}  // namespace tandem::core
