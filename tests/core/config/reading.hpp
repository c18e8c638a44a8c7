// Shared by the tests of the reader: texts in, scenario and problems out.
#pragma once
#include <gtest/gtest.h>
#include <optional>
#include <string>
#include <vector>

#include "core/config/reader.hpp"
#include "tests/core/config/names.hpp"

namespace tandem::core {

struct Outcome {
  std::optional<Scenario> scenario;
  Problems problems;

  std::string text() const {
    std::string all;
    for (const Problem& p : problems) all += to_text(p) + "\n";
    return all;
  }
  const Scenario& good() const {
    EXPECT_TRUE(scenario.has_value()) << text();
    static const Scenario none;
    return scenario ? *scenario : none;
  }
};

inline Outcome read(const std::string& text, const std::vector<std::string>& overrides = {},
                    const hal::Catalog& known = known_names()) {
  Outcome out;
  out.scenario = read_experiment_text(text, "file.xml", overrides, known, out.problems);
  return out;
}

/// A correct experiment in which parts can be replaced. Every part stands on the line of its name.
struct Parts {
  std::string framework =
      R"(<framework><experiment length="10" ticks_per_second="10" random_seed="1"/></framework>)";  // line 2
  std::string controllers =
      R"(<controllers><wander id="w" library="wander"><sensors><proximity/></sensors></wander></controllers>)";  // 3
  std::string engines = R"(<physics_engines><kinematics2d id="k"/></physics_engines>)";                          // 4
  std::string arena = R"(<arena size="4,4,1">)";                                                                 // 5
  std::string things = R"(<e-puck id="ep"><body position="0,0,0"/><controller config="w"/></e-puck>)";           // 6
  std::string rest;                                                                                              // 8

  std::string text() const {
    return "<tandem>\n" + framework + "\n" + controllers + "\n" + engines + "\n" + arena + "\n" + things +
           "\n</arena>\n" + rest + "\n</tandem>\n";
  }
};

}  // namespace tandem::core
