// Scenes of the benchmarks: the standard one of Pinciroli et al. (2012), section 4.1, robots that diffuse through 3 x 3
// rooms; and a flock of robots that fly.
#pragma once
#include "bench/bench_case.hpp"

namespace tandem::bench {

/// Equal cases give equal scenarios; seed 1, ticks of 0.1 s.
core::Scenario scene_of(const BenchCase& c);

}  // namespace tandem::bench
