// Closed forms of mechanics that simulated motion is compared with. They know nothing of any engine.
#pragma once
#include <map>
#include <string>

#include "hal/result.hpp"

namespace tandem::validate {

/// The figures of a scene by name, SI units and radians: "v", "mu", "g", …; "t" is how long it
/// is watched.
class Given {
 public:
  void set(const std::string& name, double value) { values_[name] = value; }
  bool has(const std::string& name) const { return values_.count(name) != 0; }
  /// @throws std::out_of_range when the scene does not give it
  double operator()(const std::string& name) const { return values_.at(name); }

 private:
  std::map<std::string, double> values_;
};

/// What should be measured in a scene. Error: there is no closed form of that name, or it lacks a figure.
hal::Result<double> closed_form(const std::string& name, const Given& given);

/// Where a robot that drives with steady wheel speeds is after t: it began at the origin and faced x.
struct PlanarPlace {
  double x_m = 0.0, y_m = 0.0, heading_rad = 0.0;
};
PlanarPlace arc(double left_m_s, double right_m_s, double base_m, double t_s);

}  // namespace tandem::validate
