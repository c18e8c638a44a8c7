#include "bridges/calibration/place_fit.hpp"

#include <cmath>
#include <limits>

#include "bridges/calibration/homography.hpp"
#include "bridges/calibration/solver.hpp"
#include "hal/unit.hpp"

namespace tandem::bridges::calibration {
namespace {

constexpr double kMostError_m = 0.02;

std::string in_mm(double m) {
  return hal::format_number(std::round(m * 1e4) / 10.0) + " mm";
}

}  // namespace

hal::Result<PlaceFit> fit_place(const camera::Lens& lens, const std::vector<KnownPoint>& points) {
  double height_m = 0.0;
  std::vector<Pair> pairs;
  for (const KnownPoint& point : points) {
    const auto direction = camera::direction_of(lens, point.pixel);
    if (!direction) continue;
    pairs.push_back({{point.p_W.x(), point.p_W.y()}, *direction});
    height_m += point.p_W.z() / static_cast<double>(points.size());
  }
  const auto h = homography(pairs);
  if (!h)
    return hal::Error{"the camera's place is found from four points at least that do not lie in a line, and " +
                      std::to_string(pairs.size()) + " were seen"};
  Problem problem;
  problem.lens = lens;
  problem.lens_known = true;
  problem.views = {placement_of(*h)};
  problem.views[0].p_WC.z() += height_m;
  for (const KnownPoint& point : points) problem.observations.push_back({0, point.p_W, point.pixel});
  const Solution solution = solve(problem);
  PlaceFit fit;
  fit.place = problem.views[0];
  fit.rms_px = solution.rms_px;
  fit.sd_m = solution.sd.tail(3).maxCoeff();
  const camera::Camera camera{lens, fit.place, 0.0};
  for (const KnownPoint& point : points) {
    const auto seen = camera::on_plane(camera, point.pixel, point.p_W.z());
    const double error_m =
        seen ? (*seen - hal::Vector2{point.p_W.x(), point.p_W.y()}).norm() : std::numeric_limits<double>::infinity();
    if (error_m < fit.worst_m) continue;
    fit.worst_m = error_m;
    fit.worst = point.name;
  }
  if (!(fit.place.p_WC.z() > height_m))
    return hal::Error{"the camera would hang beneath the points: are their places mirrored (x and y exchanged)?"};
  if (!(fit.worst_m <= kMostError_m))
    return hal::Error{fit.worst + " is seen " + in_mm(fit.worst_m) +
                      " from where it should be: is its place right, and is the lens's file of this camera?"};
  return fit;
}

}  // namespace tandem::bridges::calibration
