// How often the 95 % bounds of `tandem fit` hold the hidden truth of robots that are written from the documents alone,
// and how wide they are. A dozen robots; TANDEM_HIDDEN_ROBOTS=400 makes it a measurement.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>
#include <thread>
#include <vector>

#include "hal/input_file.hpp"
#include "hal/json/json.hpp"
#include "hal/program.hpp"
#include "tests/checkout.hpp"
#include "tests/hidden_robots/hidden_robot.hpp"
#include "validate/goodness.hpp"
#include "validate/parallel.hpp"

namespace tandem::hidden {
namespace {

constexpr double kSeconds = 300.0;

/// A value that `fit` tells, what it should be, and how wide its bound may be in the median.
struct Wanted {
  const char* name;
  double (*truth)(const Truth&);
  double half_width;
};
const Wanted kWanted[] = {
    {"left", [](const Truth& t) { return t.left; }, 0.003},
    {"right", [](const Truth& t) { return t.right; }, 0.003},
    {"base", [](const Truth& t) { return t.base; }, 0.005},
    {"noise_sqrt_m", [](const Truth& t) { return t.noise_m; }, 1.0},
    {"delay_s", [](const Truth& t) { return t.to_robot_s + t.command_delay_s + t.body_delay_s; }, 0.003},
    {"counter_delay_s", [](const Truth& t) { return t.to_robot_s + t.command_delay_s + t.counter_delay_s; }, 0.003},
    {"lag_s", [](const Truth& t) { return t.body_delay_s - t.counter_delay_s; }, 0.003},
    {"round_trip_s", [](const Truth& t) { return t.to_robot_s + t.to_host_s; }, 0.003},
    {"link_in_s", [](const Truth& t) { return t.to_robot_s; }, 0.003},
    {"command_s", [](const Truth& t) { return t.command_delay_s; }, 0.003},
    {"body_s", [](const Truth& t) { return t.body_delay_s; }, 0.003},
    {"counters_s", [](const Truth& t) { return t.counter_delay_s; }, 0.003},
};

/// What was told of one robot; an empty object: nothing.
hal::Json fitted(std::uint64_t number, const std::filesystem::path& folder) {
  const std::filesystem::path record = folder / (std::to_string(number) + ".record");
  const std::filesystem::path report = folder / (std::to_string(number) + ".json");
  std::ofstream(record, std::ios::binary) << record_of(draw(number), number, kSeconds);
  const auto ended = hal::run_program(std::string(test::kBuildDir) + "/bin/tandem",
                                      {"fit", record.string(), "--report", report.string()});
  EXPECT_TRUE(ended.ok() && ended.value().code == 0) << (ended.ok() ? ended.value().errors : ended.error().message);
  const auto text = hal::read_whole_file(report.string(), "the report");
  const auto told = hal::parse_json_object(text.ok() ? text.value() : "");
  std::filesystem::remove(record);
  return told.ok() ? told.value()["robots"][0]["wheels"] : hal::Json::object();
}

std::uint64_t robots() {
  const char* const asked = std::getenv("TANDEM_HIDDEN_ROBOTS");
  return asked != nullptr ? std::stoull(asked) : 12;
}

TEST(HiddenRobots, AreFoundWithinTheBoundsThatFitTells) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "hidden_robots";
  std::filesystem::create_directories(folder);
  std::vector<hal::Json> told(robots());
  validate::in_parallel(told.size(), [&](std::size_t i) { told[i] = fitted(i, folder); });
  for (const Wanted& wanted : kWanted) {
    std::uint64_t held = 0, n = 0;
    std::vector<double> half_widths;
    for (std::size_t i = 0; i < told.size(); ++i) {
      if (!told[i].contains(wanted.name) || !told[i][wanted.name].value("observable", false)) continue;
      const double low = told[i][wanted.name]["low_95"].get<double>(),
                   high = told[i][wanted.name]["high_95"].get<double>();
      const double truth = wanted.truth(draw(i));
      ++n;
      held += low <= truth && truth <= high ? 1 : 0;
      half_widths.push_back(0.5 * (high - low));
    }
    if (n == 0) continue;  // cannot be told is an answer
    std::sort(half_widths.begin(), half_widths.end());
    const double median = half_widths[half_widths.size() / 2];
    const auto [low, high] = validate::binomial_interval(held, n, 0.99);
    std::printf("%-16s %llu of %llu bounds hold (share within %.3f to %.3f), median half-width %.3g\n", wanted.name,
                static_cast<unsigned long long>(held), static_cast<unsigned long long>(n), low, high, median);
    EXPECT_GE(high, 0.95) << wanted.name << " is told with bounds that are too narrow";
    EXPECT_LE(median, wanted.half_width) << wanted.name;
  }
  const std::vector<std::string> always = {"left", "right", "base", "delay_s"};
  for (const hal::Json& one : told)
    for (const std::string& name : always)
      EXPECT_TRUE(one.contains(name) && one[name].value("observable", false)) << name;
}

}  // namespace
}  // namespace tandem::hidden
