// Wall times of several numbers of threads, compared run by run.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "bench/result_line.hpp"

namespace tandem::bench {

/// How many times faster each number of threads is than the first one in `lines`: for every engine, partition and
/// number of robots a row of a table. The n-th run with one number of threads is divided by the n-th with another, as
/// they were measured within the same minute; shown is the median of these ratios, and the smallest and largest.
std::vector<std::pair<std::string, std::string>> compare_threads(const std::vector<ResultLine>& lines);

}  // namespace tandem::bench
