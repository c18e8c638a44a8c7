#include "validate/closed_forms.hpp"

#include <cmath>
#include <stdexcept>

namespace tandem::validate {
namespace {

/// Height of a body that was thrown upwards, without air.
double fall(const Given& f) {
  return f("z") + f("v") * f("t") - 0.5 * f("g") * f("t") * f("t");
}

/// Way of a body that slides until friction has stopped it.
double slide(const Given& f) {
  return f("v") * f("v") / (2.0 * f("mu") * f("g"));
}

/// Way down a slope after t, from rest; 0 where friction holds it.
double slope(const Given& f) {
  const double a = f("g") * (std::sin(f("angle")) - f("mu") * std::cos(f("angle")));
  return a > 0.0 ? 0.5 * a * f("t") * f("t") : 0.0;
}

/// A body slides over `gap` into another one at rest; they keep no energy of the shock beyond what momentum asks for,
/// and slide on together. How far the second one goes.
double collision(const Given& f) {
  const double deceleration = f("mu") * f("g");
  const double before = std::sqrt(f("v") * f("v") - 2.0 * deceleration * f("gap"));
  const double after = before * f("m1") / (f("m1") + f("m2"));
  return after * after / (2.0 * deceleration);
}

/// Heaviest box that a force can push over a floor with friction.
double push(const Given& f) {
  return f("force") / (f("mu") * f("g"));
}

/// Way in t of a mass that a constant force brings to a speed, or stops: with force 0 it has that speed at once.
double start(const Given& f) {
  const double lost = f("force") > 0.0 ? f("v") * f("v") * f("m") / (2.0 * f("force")) : 0.0;
  return f("v") * f("t") - lost;
}
double brake(const Given& f) {
  return f("force") > 0.0 ? f("v") * f("v") * f("m") / (2.0 * f("force")) : 0.0;
}

/// Angle by which two wheels turn a robot.
double turn(const Given& f) {
  return (f("right") - f("left")) / f("base") * f("t");
}

/// Way in t from rest at a steady acceleration, against a drag that takes k of the speed a second.
double accelerated(double a, double k, double t) {
  return k > 0.0 ? a / k * (t + std::expm1(-k * t) / k) : 0.5 * a * t * t;
}

/// Way in t of what accelerates with all it has against the drag until it has its speed, and then keeps that.
double flight(const Given& f) {
  const double k = f("drag"), a = f("a");
  const double until = k > 0.0 ? -std::log1p(-k * f("v") / a) / k : f("v") / a;
  return accelerated(a, k, until) + f("v") * (f("t") - until);
}

/// Way in t of what hovered, from when its thrust is to be other than its weight, and comes to that with a lag.
double thrust(const Given& f) {
  const double a = (f("thrust") - 1.0) * f("g"), lag = f("lag");
  if (lag <= 0.0) return accelerated(a, f("drag"), f("t"));
  return a * (0.5 * f("t") * f("t") - lag * f("t") - lag * lag * std::expm1(-f("t") / lag));
}

/// Way in t of what leans from rest with as much thrust as keeps its height.
double lean(const Given& f) {
  return accelerated(f("g") * std::tan(f("pitch")), f("drag"), f("t"));
}

double spin(const Given& f) {
  return f("rate") * f("t");
}

double distance(const Given& f) {
  return f("distance");
}

double zero(const Given&) {
  return 0.0;
}

}  // namespace

hal::Result<double> closed_form(const std::string& name, const Given& given) {
  static const std::map<std::string, double (*)(const Given&)> all = {
      {"fall", fall},         {"slide", slide},   {"slope", slope}, {"collision", collision},
      {"push", push},         {"start", start},   {"brake", brake}, {"turn", turn},
      {"flight", flight},     {"thrust", thrust}, {"lean", lean},   {"spin", spin},
      {"distance", distance}, {"zero", zero}};
  const auto form = all.find(name);
  if (form == all.end()) return hal::Error{"there is no closed form '" + name + "'"};
  try {
    return form->second(given);
  } catch (const std::out_of_range&) {
    return hal::Error{"the closed form '" + name + "' lacks a figure of its scene"};
  }
}

PlanarPlace arc(double left_m_s, double right_m_s, double base_m, double t_s) {
  const double speed_m_s = 0.5 * (left_m_s + right_m_s);
  const double turn_rad_s = (right_m_s - left_m_s) / base_m;
  const double angle_rad = turn_rad_s * t_s;
  if (turn_rad_s == 0.0) return {speed_m_s * t_s, 0.0, 0.0};
  const double radius_m = speed_m_s / turn_rad_s;
  return {radius_m * std::sin(angle_rad), radius_m * (1.0 - std::cos(angle_rad)), angle_rad};
}

}  // namespace tandem::validate
