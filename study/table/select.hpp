// Selections from a table to be drawn: one value of every run, or samples over its time.
#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hal/result.hpp"

namespace tandem::study {

/// What a table offers to be drawn.
struct TableContents {
  std::vector<std::string> columns;  ///< to group and to choose by: experiment, seed, parameters
  std::vector<std::string> varied;   ///< those of them, but the seed, with several values
  std::vector<std::string> measures;
  bool samples = false;  ///< over time
  std::int64_t done = 0, failed = 0;
};
hal::Result<TableContents> contents_of(const std::string& table);

inline constexpr const char* kOverTime = "time";

struct Selection {
  std::string measure;
  std::string over;                                        ///< a column, `kOverTime`, or a measure for select_ways
  std::string by;                                          ///< a column whose values are groups; empty: one group
  std::string panel;                                       ///< a column whose values are panels; empty: one
  std::vector<std::pair<std::string, std::string>> where;  ///< column and the value that it must have
  bool pairs = false;                                      ///< observations say what makes them pairs
};

/// One value, of a run that is done.
struct Observation {
  std::string panel, group, x;
  double value = 0.0;
  std::int64_t run = 0;
  std::string pair = {};  ///< the same in runs that differ in nothing but their group: in seed and all settings
};

/// In the order of panels, groups and x, numbers by their size. Errors: a column or measure that is not there, with
/// what there is.
hal::Result<std::vector<Observation>> select(const std::string& table, const Selection& selection);

/// The way of a run that is done through two measures, (`over`, `measure`): its samples, or its end alone where there
/// are none.
struct Way {
  std::string panel, group;
  std::int64_t run = 0;
  std::vector<std::pair<double, double>> places;  ///< the last one is the end
};
/// In the order of panels, groups and runs. Errors as of `select`.
hal::Result<std::vector<Way>> select_ways(const std::string& table, const Selection& selection);

}  // namespace tandem::study
