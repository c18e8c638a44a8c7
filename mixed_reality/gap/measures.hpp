// How far two runs are from one another: trajectories, distributions of readings, measures of the swarm.
#pragma once
#include <string>
#include <vector>

#include "hal/json/json.hpp"
#include "mixed_reality/gap/recorded_run.hpp"

namespace tandem::mixed_reality {

/// Of one robot that is in both runs.
struct TrajectoryGap {
  std::string id;
  std::size_t ticks = 0;    ///< that both have
  double way_m = 0.0;       ///< that it went in the first run
  double absolute_m = 0.0;  ///< root of the mean square of the distance, when the second is laid over the first as well
                            ///< as turning and moving allow [Sturm et al. 2012, IROS]
  double apart_m = 0.0;     ///< the same as it is
  double heading_rad = 0.0;  ///< root of the mean square of the difference of headings, as they are
  double end_m_per_m = 0.0;  ///< distance at the end, for each metre that it went
  double relative_m = 0.0;   ///< of what it went within a second, seen from where it was: root of the mean square
};

/// Of a number that both runs have many of.
struct DistributionGap {
  std::string name, unit;
  std::size_t count_a = 0, count_b = 0;
  double mean_a = 0.0, mean_b = 0.0;
  double largest = 0.0;  ///< largest distance of the two distributions [Kolmogorov and Smirnov]: 0 alike to 1
  double moved = 0.0;    ///< mean distance by which values differ, smallest with largest [Wasserstein], in `unit`
};

struct Gap {
  std::vector<TrajectoryGap> robots;
  TrajectoryGap typical;  ///< medians
  std::vector<DistributionGap> distributions;
  double occupancy = 0.0;  ///< of places: Jensen-Shannon divergence over a grid of 10 by 10, 0 alike to 1
  std::vector<DistributionGap> measures;  ///< numbers that hooks published at the end: one value each
};

/// The largest distance of two empirical distributions.
double kolmogorov_smirnov(std::vector<double> a, std::vector<double> b);
/// The first Wasserstein distance of two empirical distributions.
double wasserstein(std::vector<double> a, std::vector<double> b);

/// Of the robots `ids`; empty: of all that both have.
Gap gap_between(const RecordedRun& a, const RecordedRun& b, const std::vector<std::string>& ids);

hal::Json to_json(const Gap& gap);

}  // namespace tandem::mixed_reality
