#include "study/design.hpp"

#include <algorithm>

namespace tandem::study {
namespace {

constexpr double kMostRuns = 1e9;

void replace_all(std::string& text, std::string_view what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
}

}  // namespace

hal::Result<Design> Design::of(const Study& study) {
  double runs = static_cast<double>(study.experiments.size()) * static_cast<double>(study.seeds.size());
  for (const Axis& axis : study.axes) runs *= static_cast<double>(axis.size());
  if (runs > kMostRuns) {
    return hal::Error{study.file + ": " + std::to_string(static_cast<long double>(runs)) +
                      " runs; a thousand million is the most. A Latin hypercube needs fewer than a grid"};
  }
  Design design(study);
  for (const Axis& axis : study.axes) design.points_ *= static_cast<std::int64_t>(axis.size());
  design.configurations_ = design.points_ * static_cast<std::int64_t>(study.experiments.size());
  return design;
}

RunPlan Design::run(std::int64_t number) const {
  RunPlan plan;
  plan.number = number;
  plan.configuration = number % configurations_;
  plan.experiment = static_cast<std::size_t>(plan.configuration / points_);
  plan.point = plan.configuration % points_;
  plan.seed = study_->seeds[static_cast<std::size_t>(number / configurations_)];
  return plan;
}

std::vector<std::string> Design::values(std::int64_t point) const {
  std::vector<std::size_t> index(study_->axes.size());
  for (std::size_t a = study_->axes.size(); a-- > 0;) {
    const auto size = static_cast<std::int64_t>(study_->axes[a].size());
    index[a] = static_cast<std::size_t>(point % size);
    point /= size;
  }
  std::vector<std::string> values;
  for (std::size_t a = 0; a < study_->axes.size(); ++a) {
    for (const Parameter& p : study_->axes[a].parameters) values.push_back(p.values[index[a]]);
  }
  return values;
}

std::vector<std::string> Design::overrides(const RunPlan& plan) const {
  std::vector<std::string> overrides;
  for (const Constant& constant : study_->constants) {
    std::string value = constant.value;
    replace_all(value, "{run}", std::to_string(plan.number));
    replace_all(value, "{seed}", std::to_string(plan.seed));
    overrides.push_back(constant.path + "=" + value);
  }
  const std::vector<std::string> chosen = values(plan.point);
  std::size_t next = 0;
  for (const Parameter* p : study_->parameters()) overrides.push_back(p->path + "=" + chosen[next++]);
  return overrides;
}

bool Design::names_runs() const noexcept {
  return std::any_of(study_->constants.begin(), study_->constants.end(), [](const Constant& constant) {
    return constant.value.find("{run}") != std::string::npos || constant.value.find("{seed}") != std::string::npos;
  });
}

}  // namespace tandem::study
