// What robots of one kind have in common, and how they differ: the fitted part of their kind.
#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "hal/device/fitted.hpp"

namespace tandem::mixed_reality {

/// Mean and spread over the robots, and the robots themselves. The spread is what remains of their variance when that
/// of the estimates is taken away. A value of one robot alone has no spread.
template <class Part, class Model>
Part population(std::vector<hal::FittedRobot<Model>> robots) {
  Part part;
  for (const hal::ModelField<Model>& f : Model::fields()) {
    double sum = 0.0, squares = 0.0, noise = 0.0;
    const auto n = static_cast<double>(robots.size());
    for (const auto& robot : robots) sum += robot.value.of.*f.member;
    const double mean = sum / n;
    for (const auto& robot : robots) {
      const double off = robot.value.of.*f.member - mean;
      squares += off * off;
      noise += robot.error.of.*f.member * robot.error.of.*f.member;
    }
    part.mean.of.*f.member = mean;
    if (robots.size() > 1) part.spread.of.*f.member = std::sqrt(std::max(0.0, squares / (n - 1.0) - noise / n));
  }
  part.robots = std::move(robots);
  return part;
}

}  // namespace tandem::mixed_reality
