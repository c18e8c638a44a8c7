#include "bridges/calibration/lens_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bridges/calibration/homography.hpp"
#include "bridges/calibration/solver.hpp"
#include "hal/unit.hpp"

namespace tandem::bridges::calibration {
namespace {

constexpr double kLeastTilt_rad = 15.0 * std::numbers::pi / 180.0;
constexpr double kLeastCovered = 0.4;
constexpr double kMostRms_px = 1.5;
constexpr double kMostFocalError = 0.01;
constexpr double kAlike = 0.02;  // of the picture's width

std::vector<Pair> pairs_of(const View& view, const Board& board) {
  std::vector<Pair> pairs;
  for (const apriltag::Detection& tag : view.tags) {
    const auto corners = board.corners_m(tag.id);
    for (std::size_t i = 0; corners && i < 4; ++i) pairs.push_back({(*corners)[i], tag.corners[i]});
  }
  return pairs;
}

/// With these views; their places as the board's homographies say, through a lens of that focal length.
Problem problem_of(const std::vector<std::vector<Pair>>& views, const camera::Lens& lens, bool wide) {
  Problem problem;
  problem.lens = lens;
  problem.k3_too = wide;
  for (std::size_t v = 0; v < views.size(); ++v) {
    std::vector<Pair> directions = views[v];
    for (Pair& pair : directions)
      pair.picture = {(pair.picture.x() - lens.cx) / lens.fx, (pair.picture.y() - lens.cy) / lens.fy};
    problem.views.push_back(placement_of(homography(directions).value_or(hal::Matrix3::Identity())));
    for (const Pair& pair : views[v])
      problem.observations.push_back({v, {pair.plane.x(), pair.plane.y(), 0.0}, pair.picture});
  }
  return problem;
}

double covered_part(const std::vector<std::vector<Pair>>& views, const camera::Lens& lens) {
  constexpr std::size_t kColumns = 8, kRows = 6;
  std::array<bool, kColumns * kRows> seen{};
  for (const auto& view : views) {
    for (const Pair& pair : view) {
      const double x = pair.picture.x() / static_cast<double>(lens.width) * kColumns;
      const double y = pair.picture.y() / static_cast<double>(lens.height) * kRows;
      if (x >= 0.0 && y >= 0.0 && x < kColumns && y < kRows)
        seen[static_cast<std::size_t>(y) * kColumns + static_cast<std::size_t>(x)] = true;
    }
  }
  return static_cast<double>(std::count(seen.begin(), seen.end(), true)) / static_cast<double>(seen.size());
}

/// Between the ways in which the board was turned to the camera.
double most_tilt(const std::vector<camera::Placement>& views) {
  double most_rad = 0.0;
  for (const auto& a : views) {
    const hal::Vector3 from = a.q_WC.conjugate() * hal::Vector3::UnitZ();
    for (const auto& b : views) {
      const hal::Vector3 to = b.q_WC.conjugate() * hal::Vector3::UnitZ();
      most_rad = std::max(most_rad, std::acos(std::clamp(from.dot(to), -1.0, 1.0)));
    }
  }
  return most_rad;
}

std::string rounded(double value) {
  return hal::format_number(std::round(value * 100.0) / 100.0);
}

/// What is wrong with a solution that was found.
hal::Status judge(const LensFit& fit) {
  if (fit.most_tilt_rad < kLeastTilt_rad)
    return hal::Error{
        "all views show the board tilted in the same way, and then nobody can tell the focal length from "
        "the distance: tilt it by 20 to 45 degrees, to the left, to the right, forwards and backwards"};
  if (fit.covered < kLeastCovered)
    return hal::Error{"the board was seen in " + std::to_string(std::lround(100.0 * fit.covered)) +
                      " % of the picture only; show it in all four corners, too"};
  if (fit.rms_px > kMostRms_px)
    return hal::Error{"views and board differ by " + rounded(fit.rms_px) +
                      " pixels: is the board flat, is it the one of the file, are frames sharp? Lenses of more than "
                      "120 degrees are not of this kind"};
  if (fit.sd_focal_px > kMostFocalError * fit.lens.fx)
    return hal::Error{"the views tell too little: the focal length may be wrong by " + rounded(fit.sd_focal_px) +
                      " of " + rounded(fit.lens.fx) + " pixels; take more of them, nearer and more tilted"};
  return {};
}

}  // namespace

bool is_of_use(const View& view, const Board& board) noexcept {
  const auto of_board = std::count_if(view.tags.begin(), view.tags.end(), [&](const apriltag::Detection& tag) {
    return board.corners_m(tag.id).has_value();
  });
  return of_board >= static_cast<std::ptrdiff_t>(kFewestTags);
}

bool are_alike(const View& a, const View& b, const Board& board) noexcept {
  double most_px = 0.0, size_px = 0.0;
  std::size_t both = 0;
  for (const apriltag::Detection& tag : a.tags) {
    const auto same = std::find_if(b.tags.begin(), b.tags.end(), [&](const auto& other) { return other.id == tag.id; });
    if (same == b.tags.end() || !board.corners_m(tag.id)) continue;
    ++both;
    size_px = std::max(size_px, tag.centre().norm());
    for (std::size_t i = 0; i < 4; ++i) most_px = std::max(most_px, (tag.corners[i] - same->corners[i]).norm());
  }
  return both >= kFewestTags && most_px < kAlike * size_px;
}

hal::Result<LensFit> fit_lens(const std::vector<View>& views, const Board& board, std::size_t width, std::size_t height,
                              bool wide) {
  std::vector<std::vector<Pair>> used;
  std::vector<std::string> names;
  for (const View& view : views) {
    if (!is_of_use(view, board)) continue;
    used.push_back(pairs_of(view, board));
    names.push_back(view.name);
  }
  if (used.size() < kFewestViews)
    return hal::Error{"only " + std::to_string(used.size()) + " of " + std::to_string(views.size()) +
                      " frames show enough of the board (" + std::to_string(kFewestTags) + " tags); at least " +
                      std::to_string(kFewestViews) + " are needed, 15 to 30 are good"};
  camera::Lens lens;
  lens.width = width;
  lens.height = height;
  lens.cx = 0.5 * static_cast<double>(width);
  lens.cy = 0.5 * static_cast<double>(height);
  std::vector<hal::Matrix3> planes;
  for (const auto& view : used) {
    std::vector<Pair> centred = view;
    for (Pair& pair : centred) pair.picture -= hal::Vector2{lens.cx, lens.cy};
    if (const auto h = homography(centred)) planes.push_back(*h);
  }
  lens.fx = lens.fy = std::clamp(focal_of(planes).value_or(static_cast<double>(width)), 0.3 * lens.cx, 20.0 * lens.cx);

  LensFit fit;
  Problem problem = problem_of(used, lens, wide);
  Solution solution = solve(problem);
  // Views that fit the others badly are left out, and it is solved again.
  std::vector<double> sorted = solution.view_rms_px;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
  const double most_px = std::max(0.5, 3.0 * sorted[sorted.size() / 2]);
  std::vector<std::vector<Pair>> kept;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (solution.view_rms_px[v] <= most_px)
      kept.push_back(used[v]);
    else
      fit.left_out.push_back(names[v]);
  }
  if (!fit.left_out.empty() && kept.size() >= kFewestViews) {
    problem = problem_of(kept, problem.lens, wide);
    solution = solve(problem);
  } else {
    fit.left_out.clear();
  }
  fit.lens = problem.lens;
  fit.views = problem.views.size();
  fit.rms_px = solution.rms_px;
  fit.sd_focal_px = std::max(solution.sd[0], solution.sd[1]);
  fit.sd_centre_px = std::max(solution.sd[2], solution.sd[3]);
  fit.covered = covered_part(used, lens);
  fit.most_tilt_rad = most_tilt(problem.views);
  if (const hal::Status good = judge(fit); !good.ok()) return good.error();
  if (!solution.converged) return hal::Error{"no lens fits the views; take others, of a flat board, in focus"};
  return fit;
}

}  // namespace tandem::bridges::calibration
