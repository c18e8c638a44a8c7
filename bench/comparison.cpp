#include "bench/comparison.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

#include "bench/spread.hpp"

namespace tandem::bench {

std::vector<std::pair<std::string, std::string>> compare_threads(const std::vector<ResultLine>& lines) {
  std::vector<std::int64_t> threads;                                          // as they came
  std::vector<std::string> groups;                                            // as they came
  std::map<std::string, std::map<std::int64_t, std::vector<double>>> wall_s;  // by group and threads
  for (const ResultLine& line : lines) {
    const std::string group = fmt::format("{}, {}, N = {}", line.engine, line.partition, line.robots);
    if (std::find(threads.begin(), threads.end(), line.threads) == threads.end()) threads.push_back(line.threads);
    if (!wall_s.contains(group)) groups.push_back(group);
    wall_s[group][line.threads].push_back(line.wall_s);
  }
  std::vector<std::pair<std::string, std::string>> rows;
  for (const std::string& group : groups) {
    const auto& times = wall_s[group];
    const auto first = times.find(threads.front());
    std::string row;
    for (const std::int64_t p : threads) {
      const auto other = times.find(p);
      if (p == threads.front() || other == times.end() || first == times.end()) continue;
      std::vector<double> ratios;
      for (std::size_t i = 0; i < std::min(first->second.size(), other->second.size()); ++i)
        ratios.push_back(first->second[i] / other->second[i]);
      const Spread s = spread_of(ratios);
      row += fmt::format("{}P = {}: {:.2f} times as fast as P = {} ({:.2f} to {:.2f}, {} pairs)",
                         row.empty() ? "" : "; ", p, s.median, threads.front(), s.smallest, s.largest, ratios.size());
    }
    if (!row.empty()) rows.emplace_back(group, row);
  }
  return rows;
}

}  // namespace tandem::bench
