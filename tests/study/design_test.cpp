// Properties of grids, ranges and Latin hypercubes, whatever their sizes.
#include "study/design.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <set>

#include "study/values.hpp"

namespace tandem::study {
namespace {

Parameter parameter(const std::string& name, std::size_t values) {
  Parameter p{name, "a." + name, {}, 1};
  for (std::size_t i = 0; i < values; ++i) p.values.push_back(std::to_string(i));
  return p;
}

Study any_study() {
  Study study;
  const int experiments = *rc::gen::inRange(1, 4), axes = *rc::gen::inRange(0, 4), seeds = *rc::gen::inRange(1, 5);
  for (int i = 0; i < experiments; ++i) study.experiments.push_back({"e" + std::to_string(i), "e.xml", 1});
  for (int i = 0; i < axes; ++i) {
    const auto size = *rc::gen::inRange<std::size_t>(1, 6);
    Axis axis;
    const int together = *rc::gen::inRange(1, 3);
    for (int k = 0; k < together; ++k)
      axis.parameters.push_back(parameter("p" + std::to_string(i) + "_" + std::to_string(k), size));
    study.axes.push_back(axis);
  }
  for (int i = 0; i < seeds; ++i) study.seeds.push_back(static_cast<std::uint64_t>(i + 1));
  return study;
}

TEST(Design, HasEveryCombinationOnce) {
  EXPECT_TRUE(rc::check([] {
    const Study study = any_study();
    auto design = Design::of(study);
    RC_ASSERT(design.ok());
    std::size_t expected = study.experiments.size() * study.seeds.size();
    for (const Axis& axis : study.axes) expected *= axis.size();
    RC_ASSERT(design->runs() == static_cast<std::int64_t>(expected));
    std::set<std::vector<std::string>> seen;
    for (std::int64_t n = 0; n < design->runs(); ++n) {
      const RunPlan plan = design->run(n);
      RC_ASSERT(plan.number == n);
      RC_ASSERT(plan.configuration == n % design->configurations());
      std::vector<std::string> all = design->values(plan.point);
      std::size_t at = 0;
      for (const Axis& axis : study.axes) {  // those of one axis go together
        for (std::size_t k = 1; k < axis.parameters.size(); ++k) RC_ASSERT(all[at + k] == all[at]);
        at += axis.parameters.size();
      }
      RC_ASSERT(at == all.size());
      all.push_back(study.experiments[plan.experiment].name);
      all.push_back(std::to_string(plan.seed));
      RC_ASSERT(seen.insert(all).second);
    }
  }));
}

TEST(Design, KeepsItsRunsWhenSeedsAreAdded) {
  EXPECT_TRUE(rc::check([] {
    const Study before = any_study();
    Study after = before;
    after.seeds.push_back(1000);
    auto a = Design::of(before);
    auto b = Design::of(after);
    for (std::int64_t n = 0; n < a->runs(); ++n) {
      RC_ASSERT(a->run(n).seed == b->run(n).seed);
      RC_ASSERT(a->overrides(a->run(n)) == b->overrides(b->run(n)));
    }
  }));
}

TEST(Design, RefusesMoreRunsThanAnybodyCanWaitFor) {
  Study study;
  study.experiments = {{"e", "e.xml", 1}};
  study.seeds = {1};
  for (int i = 0; i < 4; ++i) study.axes.push_back({{parameter("p" + std::to_string(i), 1000)}});
  EXPECT_FALSE(Design::of(study).ok());
  study.axes.pop_back();
  EXPECT_TRUE(Design::of(study).ok());
}

TEST(Design, PutsRunAndSeedIntoConstants) {
  Study study;
  study.experiments = {{"e", "e.xml", 1}};
  study.seeds = {41, 42};
  auto design = Design::of(study);
  EXPECT_FALSE(design->names_runs());
  study.constants = {{"loop_functions.output", "log_{run}_{seed}.csv", 1}};
  EXPECT_TRUE(design->names_runs());
  EXPECT_EQ(design->overrides(design->run(1)).at(0), "loop_functions.output=log_1_42.csv");
}

TEST(Values, OfARangeAreEvenAndHaveItsEnds) {
  EXPECT_TRUE(rc::check([] {
    const auto count = *rc::gen::inRange<std::int64_t>(2, 50);
    const double from = *rc::gen::inRange(-1000, 1000), width = *rc::gen::inRange(1, 1000);
    auto span = span_of(std::to_string(from), std::to_string(from + width), false, false);
    const auto values = spread(*span, count);
    RC_ASSERT(values.size() == static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i) {
      const double expected = from + width * static_cast<double>(i) / static_cast<double>(count - 1);
      RC_ASSERT(std::fabs(std::stod(values[static_cast<std::size_t>(i)]) - expected) < 1e-8);
    }
    RC_ASSERT(std::stod(values.back()) == from + width);
  }));
}

TEST(Values, OfALatinHypercubeFillEachPartOfEachRangeOnce) {
  EXPECT_TRUE(rc::check([] {
    const auto points = *rc::gen::inRange<std::int64_t>(1, 200);
    const auto seed = *rc::gen::inRange<std::uint64_t>(0, 1'000'000);
    const std::vector<Span> spans = {
        {0.0, 1.0, "", false, false}, {-5.0, 5.0, " m", false, false}, {1.0, 1e6, "", true, false}};
    const auto values = latin_hypercube(spans, points, seed);
    RC_ASSERT(values == latin_hypercube(spans, points, seed));
    for (std::size_t s = 0; s < spans.size(); ++s) {
      std::set<int> parts;
      for (const std::string& text : values[s]) {
        const double v = std::stod(text);
        const double way =
            spans[s].log ? std::log(v) / std::log(1e6) : (v - spans[s].from) / (spans[s].to - spans[s].from);
        RC_ASSERT(way >= 0.0 && way <= 1.0);
        parts.insert(
            static_cast<int>(std::min(way * static_cast<double>(points) + 1e-6, static_cast<double>(points) - 0.5)));
      }
      RC_ASSERT(parts.size() >= static_cast<std::size_t>(points) - 1);  // 12 digits may round over a border
    }
  }));
}

TEST(Values, OfTwoSpansOfAHypercubeAreCombinedAtRandom) {
  const std::vector<Span> spans(2, Span{0.0, 1.0, "", false, false});
  const auto values = latin_hypercube(spans, 1000, 1);
  double sum = 0.0;
  for (std::size_t i = 0; i < 1000; ++i) sum += (std::stod(values[0][i]) - 0.5) * (std::stod(values[1][i]) - 0.5);
  EXPECT_LT(std::fabs(sum / 1000.0 * 12.0), 0.1);  // correlation
}

}  // namespace
}  // namespace tandem::study
