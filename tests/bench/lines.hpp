// Result lines with chosen figures.
#pragma once
#include <fmt/format.h>
#include <string>

#include "bench/partition.hpp"
#include "bench/result_line.hpp"

namespace tandem::bench {

/// One run of `robots` robots on A1 that took `wall_s` of wall time and twice as much processor time.
inline ResultLine line_of(std::int64_t robots, std::int64_t threads, double wall_s) {
  ResultLine line;
  line.bench = "diffusion";
  line.robot = "e-puck";
  line.engine = "kinematics2d";
  line.partition = "A1";
  line.regions = "1x1";
  line.density = "40 m";
  line.assignment = "static";
  line.robots = robots;
  line.threads = threads;
  line.virtual_s = 60.0;
  line.wall_s = wall_s;
  line.cpu_s = 2.0 * wall_s;
  line.cpu_model = "Test Processor 1";
  line.cores = 4;
  line.number = 1;
  return line;
}

inline ResultLine on(const char* engine, const char* partition, ResultLine line) {
  line.engine = engine;
  line.partition = partition;
  line.regions = partition_named(partition).value().regions;
  return line;
}

/// As it is saved.
inline std::string text_of(const ResultLine& l) {
  return fmt::format(
      R"({{"bench": "{}", "robot": "{}", "engine": "{}", "partition": "{}", "regions": "{}", "density": "{}", )"
      R"("assignment": "{}", "robots": {}, "threads": {}, "virtual_s": {}, "wall_s": {}, "cpu_s": {}, )"
      R"("cpu_model": "{}", "cores": {}}})",
      l.bench, l.robot, l.engine, l.partition, l.regions, l.density, l.assignment, l.robots, l.threads, l.virtual_s,
      l.wall_s, l.cpu_s, l.cpu_model, l.cores);
}

}  // namespace tandem::bench
