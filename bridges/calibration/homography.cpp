#include "bridges/calibration/homography.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>

namespace tandem::bridges::calibration {
namespace {

/// Moves points to their middle and makes their mean distance from it the square root of 2.
Eigen::Matrix3d normalizer(std::span<const Pair> pairs, hal::Vector2 Pair::*which) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Pair& p : pairs) mean += p.*which / static_cast<double>(pairs.size());
  double distance = 0.0;
  for (const Pair& p : pairs) distance += (p.*which - mean).norm() / static_cast<double>(pairs.size());
  const double scale = distance > 0.0 ? std::sqrt(2.0) / distance : 1.0;
  Eigen::Matrix3d t;
  t << scale, 0.0, -scale * mean.x(), 0.0, scale, -scale * mean.y(), 0.0, 0.0, 1.0;
  return t;
}

}  // namespace

std::optional<hal::Matrix3> homography(std::span<const Pair> pairs) {
  if (pairs.size() < 4) return {};
  const Eigen::Matrix3d from = normalizer(pairs, &Pair::plane), to = normalizer(pairs, &Pair::picture);
  Eigen::Matrix<double, 9, 9> sum = Eigen::Matrix<double, 9, 9>::Zero();
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d p = from * Eigen::Vector3d(pair.plane.x(), pair.plane.y(), 1.0);
    const Eigen::Vector3d q = to * Eigen::Vector3d(pair.picture.x(), pair.picture.y(), 1.0);
    Eigen::Matrix<double, 2, 9> rows = Eigen::Matrix<double, 2, 9>::Zero();
    rows.block<1, 3>(0, 0) = p.transpose();
    rows.block<1, 3>(0, 6) = -q.x() * p.transpose();
    rows.block<1, 3>(1, 3) = p.transpose();
    rows.block<1, 3>(1, 6) = -q.y() * p.transpose();
    sum += rows.transpose() * rows;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(sum);
  const auto& values = solver.eigenvalues();
  if (!(values[1] > 1e-9 * values[8])) return {};  // two solutions: the points lie in a line
  const Eigen::Matrix<double, 9, 1> h = solver.eigenvectors().col(0);
  Eigen::Matrix3d matrix;
  matrix << h[0], h[1], h[2], h[3], h[4], h[5], h[6], h[7], h[8];
  return hal::Matrix3(to.inverse() * matrix * from);
}

camera::Placement placement_of(const hal::Matrix3& h) {
  // h = s (r1 r2 t): R turns the plane's frame into C, t is its origin there.
  Eigen::Matrix3d m = h;
  m /= 0.5 * (m.col(0).norm() + m.col(1).norm());
  if (m(2, 2) < 0.0) m = -m;  // the plane is in front of the camera
  Eigen::Matrix3d r;
  r.col(0) = m.col(0);
  r.col(1) = m.col(1);
  r.col(2) = m.col(0).cross(m.col(1));
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(r, Eigen::ComputeFullU | Eigen::ComputeFullV);
  r = svd.matrixU() * svd.matrixV().transpose();
  if (r.determinant() < 0.0) r = -r;
  camera::Placement place;
  const Eigen::Matrix3d back = r.transpose();
  place.q_WC = hal::Quaternion(hal::Matrix3(back)).normalized();
  place.p_WC = hal::Vector3(-back * m.col(2));
  return place;
}

std::optional<double> focal_of(std::span<const hal::Matrix3> all) {
  // With w = diag(1/f^2, 1/f^2, 1): h1' w h2 = 0 and h1' w h1 = h2' w h2, linear in 1/f^2 [Zhang 2000].
  double products = 0.0, squares = 0.0;
  for (const hal::Matrix3& raw : all) {
    const hal::Matrix3 h = raw / raw.norm();
    const double a[2] = {h(0, 0) * h(0, 1) + h(1, 0) * h(1, 1),
                         h(0, 0) * h(0, 0) + h(1, 0) * h(1, 0) - h(0, 1) * h(0, 1) - h(1, 1) * h(1, 1)};
    const double b[2] = {h(2, 0) * h(2, 1), h(2, 0) * h(2, 0) - h(2, 1) * h(2, 1)};
    for (int i = 0; i < 2; ++i) {
      products -= a[i] * b[i];
      squares += a[i] * a[i];
    }
  }
  const double inverse = squares > 0.0 ? products / squares : 0.0;
  if (!(inverse > 0.0)) return {};
  return 1.0 / std::sqrt(inverse);
}

}  // namespace tandem::bridges::calibration
