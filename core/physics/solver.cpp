#include "core/physics/solver.hpp"

#include <iterator>

namespace tandem::core {

void SolverEngine::load(const PhysicsContext& context) {
  context.pool.run(parts_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Part& part = parts_[i];
      part.solver->load({context.stores, context.stores.regions[part.region], context.tick_s, context.tick});
    }
  });
}

void SolverEngine::advance(const PhysicsContext& context) {
  context.pool.run(parts_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Part& part = parts_[i];
      part.solver->advance({context.stores, context.stores.regions[part.region], context.tick_s, context.tick});
    }
  });
}

void SolverEngine::collect(std::vector<Trouble>& all) {
  for (Part& part : parts_) {
    std::move(part.solver->trouble.begin(), part.solver->trouble.end(), std::back_inserter(all));
    part.solver->trouble.clear();
  }
}

void SolverEngine::forget() {
  for (Part& part : parts_) part.solver->forget();
}

}  // namespace tandem::core
