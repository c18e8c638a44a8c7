// The results of a benchmark as they are saved: one flat JSON object a line.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.hpp"

namespace tandem::bench {

/// One run as figures and comparisons need it.
struct ResultLine {
  std::string bench, robot, engine, partition, regions, devices, density, assignment;
  std::int64_t robots = 0;
  std::int64_t threads = 0;
  double virtual_s = 0.0;
  double wall_s = 0.0;
  double cpu_s = 0.0;
  std::string cpu_model;
  std::int64_t cores = 0;
  std::int64_t number = 0;  ///< line in its file, from 1

  double speedup() const { return cpu_s / wall_s; }
};

/// An error says what is wrong with the text: no JSON object, a field that is missing or of another sort, a run
/// that failed, a time of zero.
hal::Result<ResultLine> parse_result_line(std::string_view text);

/// All lines of a file, empty ones left out. An error is "file:line: error: …", or names the file that cannot be read.
hal::Result<std::vector<ResultLine>> read_result_lines(const std::string& path);

/// Runs of different scenes or machines are not to be compared: an error names the line of `path` that differs from
/// the first one, and in what.
hal::Status check_alike(const std::vector<ResultLine>& lines, const std::string& path);

}  // namespace tandem::bench
