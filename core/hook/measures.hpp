// Named numbers that hooks publish.
#pragma once
#include <map>
#include <string>
#include <string_view>

namespace tandem::core {

/// Measures of hooks, for the report and for views. In SI, or counts. Goes back with the run to a checkpoint.
class Measures {
 public:
  void set(std::string_view name, double value) { of(name) = value; }
  /// Adds to a number that is 0 at first.
  void add(std::string_view name, double by = 1.0) { of(name) += by; }
  /// 0 for one that was never set.
  double get(std::string_view name) const noexcept {
    const auto found = values_.find(name);
    return found == values_.end() ? 0.0 : found->second;
  }
  const std::map<std::string, double, std::less<>>& all() const noexcept { return values_; }
  void remember(auto& archive) { archive(values_); }

 private:
  double& of(std::string_view name) {
    const auto found = values_.find(name);
    return found == values_.end() ? values_.emplace(std::string(name), 0.0).first->second : found->second;
  }
  std::map<std::string, double, std::less<>> values_;
};

}  // namespace tandem::core
