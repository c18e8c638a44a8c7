#include "bridges/calibration/solver.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace tandem::bridges::calibration {
namespace {

constexpr int kMostSteps = 200;
constexpr double kHuber_px = 1.0;
constexpr double kFar_px = 1e6;  // of what is seen behind the camera
constexpr std::size_t kOfView = 6;

using Vector = Eigen::VectorXd;

std::size_t lens_count(const Problem& problem) noexcept {
  return problem.lens_known ? 0 : problem.k3_too ? 9 : 8;
}

double& lens_value(camera::Lens& lens, std::size_t i) noexcept {
  switch (i) {
    case 0:
      return lens.fx;
    case 1:
      return lens.fy;
    case 2:
      return lens.cx;
    case 3:
      return lens.cy;
    default:
      return lens.distortion[i - 4];
  }
}

/// One that makes about as much of a difference in the picture as the others.
double lens_step(std::size_t i) noexcept {
  return i < 4 ? 1e-3 : 1e-6;
}

/// Turned by a small vector, in the world, and moved.
camera::Placement moved(const camera::Placement& place, const double* by) {
  const hal::Vector3 turn{by[0], by[1], by[2]};
  const double angle = turn.norm();
  camera::Placement out = place;
  if (angle > 0.0)
    out.q_WC = (hal::Quaternion(Eigen::AngleAxisd(angle, Eigen::Vector3d(turn / angle))) * place.q_WC).normalized();
  out.p_WC += hal::Vector3{by[3], by[4], by[5]};
  return out;
}

hal::Vector2 error_of(const camera::Lens& lens, const camera::Placement& place, const Observation& o) {
  const auto pixel = camera::pixel_of(camera::Camera{lens, place, 0.0}, o.p);
  return pixel ? hal::Vector2(*pixel - o.pixel) : hal::Vector2{kFar_px, kFar_px};
}

double weight_of(const hal::Vector2& error) {
  const double distance = error.norm();
  return distance <= kHuber_px ? 1.0 : kHuber_px / distance;
}

/// Huber's sum.
double cost_of(const Problem& problem) {
  double sum = 0.0;
  for (const Observation& o : problem.observations) {
    const double d = error_of(problem.lens, problem.views[o.view], o).norm();
    sum += d <= kHuber_px ? d * d : 2.0 * kHuber_px * d - kHuber_px * kHuber_px;
  }
  return sum;
}

struct Normal {
  Eigen::MatrixXd matrix;
  Vector gradient;
};

Normal normal_equations(const Problem& problem) {
  const std::size_t lens = lens_count(problem);
  const auto size = static_cast<Eigen::Index>(lens + kOfView * problem.views.size());
  Normal normal{Eigen::MatrixXd::Zero(size, size), Vector::Zero(size)};
  std::array<Eigen::Index, 9 + kOfView> place{};
  std::array<hal::Vector2, 9 + kOfView> slope;
  for (const Observation& o : problem.observations) {
    const camera::Placement& view = problem.views[o.view];
    const hal::Vector2 error = error_of(problem.lens, view, o);
    for (std::size_t i = 0; i < lens; ++i) {
      camera::Lens more = problem.lens, less = problem.lens;
      lens_value(more, i) += lens_step(i);
      lens_value(less, i) -= lens_step(i);
      slope[i] = (error_of(more, view, o) - error_of(less, view, o)) / (2.0 * lens_step(i));
      place[i] = static_cast<Eigen::Index>(i);
    }
    for (std::size_t i = 0; i < kOfView; ++i) {
      constexpr double kStep = 1e-6;
      std::array<double, kOfView> by{};
      by[i] = kStep;
      const hal::Vector2 more = error_of(problem.lens, moved(view, by.data()), o);
      by[i] = -kStep;
      slope[lens + i] = (more - error_of(problem.lens, moved(view, by.data()), o)) / (2.0 * kStep);
      place[lens + i] = static_cast<Eigen::Index>(lens + kOfView * o.view + i);
    }
    const double weight = weight_of(error);
    for (std::size_t a = 0; a < lens + kOfView; ++a) {
      normal.gradient[place[a]] += weight * slope[a].dot(error);
      for (std::size_t b = 0; b < lens + kOfView; ++b)
        normal.matrix(place[a], place[b]) += weight * slope[a].dot(slope[b]);
    }
  }
  return normal;
}

Problem stepped(const Problem& problem, const Vector& step) {
  Problem next = problem;
  const std::size_t lens = lens_count(problem);
  for (std::size_t i = 0; i < lens; ++i) lens_value(next.lens, i) += step[static_cast<Eigen::Index>(i)];
  for (std::size_t v = 0; v < next.views.size(); ++v)
    next.views[v] = moved(problem.views[v], step.data() + lens + kOfView * v);
  return next;
}

}  // namespace

Solution solve(Problem& problem) {
  Solution solution;
  double cost = cost_of(problem), damping = 1e-3;
  Normal normal = normal_equations(problem);
  for (int i = 0; i < kMostSteps && !solution.converged; ++i) {
    Eigen::MatrixXd damped = normal.matrix;
    damped.diagonal() *= 1.0 + damping;
    damped.diagonal().array() += 1e-12;
    const Vector step = -damped.ldlt().solve(normal.gradient);
    if (!step.allFinite()) break;
    Problem next = stepped(problem, step);
    const double next_cost = cost_of(next);
    if (next_cost <= cost) {
      solution.converged = cost - next_cost <= 1e-9 * cost + 1e-15;
      problem = std::move(next);
      cost = next_cost;
      damping = std::max(1e-12, damping * 0.2);
      if (!solution.converged) normal = normal_equations(problem);
    } else {
      damping *= 8.0;
      solution.converged = damping > 1e12;
    }
  }
  solution.view_rms_px.assign(problem.views.size(), 0.0);
  std::vector<double> counts(problem.views.size(), 0.0);
  double squares = 0.0;
  for (const Observation& o : problem.observations) {
    const double square = error_of(problem.lens, problem.views[o.view], o).squaredNorm();
    squares += square;
    solution.view_rms_px[o.view] += square;
    counts[o.view] += 1.0;
  }
  for (std::size_t v = 0; v < counts.size(); ++v)
    solution.view_rms_px[v] = std::sqrt(solution.view_rms_px[v] / std::max(1.0, counts[v]));
  const auto count = static_cast<double>(problem.observations.size());
  solution.rms_px = std::sqrt(squares / std::max(1.0, count));
  const Eigen::Index size = normal.gradient.size();
  const double spare = std::max(1.0, 2.0 * count - static_cast<double>(size));
  normal = normal_equations(problem);
  const Eigen::MatrixXd inverse = normal.matrix.ldlt().solve(Eigen::MatrixXd::Identity(size, size));
  solution.sd = (inverse.diagonal().array().abs() * squares / spare).sqrt();
  return solution;
}

}  // namespace tandem::bridges::calibration
