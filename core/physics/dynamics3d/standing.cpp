#include "core/physics/dynamics3d/standing.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::core {
namespace {

constexpr std::size_t kNobody = ~std::size_t{0};
constexpr double kStill = 1e-3;      // of the speed that gravity gives: what is left of it counts as nothing
constexpr double kSoftness = 1e-9;   // of the strongest effect of a push: makes forces unique where many would do
constexpr int kMostSteps = 60;       // of Newton's method; stacks take about ten
constexpr double kShortest = 1e-4;   // of a step, when halved
constexpr double kConverged = 1e-9;  // change of what is sought, to its size

}  // namespace

bool Standing::stands(const std::vector<BodyProxy*>& objects, const std::vector<Support>& supports,
                      double gravity_m_s2) {
  if (objects.size() > kMostObjects) return false;
  bodies_.clear();
  edges_.clear();
  weight_.assign(6 * objects.size(), 0.0);
  for (const BodyProxy* object : objects) {
    Body& body = bodies_.emplace_back();
    dMass mass;
    dBodyGetMass(object->body.get(), &mass);
    dMatrix3 r;
    dRfromQ(r, object->turned_before);
    body.mass_root = std::sqrt(mass.mass);
    body.p_m = object->before_m;
    body.reach_m = std::max({object->prism.round ? object->prism.radius_m : object->prism.half_x_m,
                             object->prism.round ? 0.0 : object->prism.half_y_m, 0.5 * object->height_m});
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) body.spin_root[3 * i + k] = r[4 * k + i] / std::sqrt(mass.I[4 * i + i]);
    }
    weight_[6 * bodies_.size() - 4] = -gravity_m_s2 * body.mass_root;
  }
  const auto first_of = [&](const BodyProxy* proxy) {
    if (proxy == nullptr) return kNobody;
    return 6 * static_cast<std::size_t>(std::find(objects.begin(), objects.end(), proxy) - objects.begin());
  };
  for (const Support& support : supports) add_edges(support, first_of(support.a), first_of(support.b));

  softness_ = 0.0;
  for (const Edge& edge : edges_) {
    double strength = 0.0;
    for (const double value : edge.on_a) strength += value * value;
    softness_ = std::max(softness_, kSoftness * strength);
  }
  if (softness_ <= 0.0) return false;
  x_ = weight_;
  if (!newton_target(true)) return false;
  x_.swap(target_);
  for (int step = 0; step < kMostSteps; ++step) {
    if (!newton_target(false)) return false;
    const double energy = dual_energy(x_);
    double share = 2.0;
    double change = 0.0;
    double size = 0.0;
    do {
      share *= 0.5;
      tried_ = x_;
      for (std::size_t i = 0; i < x_.size(); ++i) tried_[i] += share * (target_[i] - x_[i]);
    } while (share > kShortest && dual_energy(tried_) > energy);
    for (std::size_t i = 0; i < x_.size(); ++i) {
      change = std::max(change, std::fabs(tried_[i] - x_[i]));
      size = std::max(size, std::fabs(tried_[i]));
    }
    x_.swap(tried_);
    if (share <= kShortest || change <= kConverged * size) break;
  }
  return fastest_left() <= kStill * gravity_m_s2;
}

void Standing::add_edges(const Support& support, std::size_t a, std::size_t b) {
  const Vector3& n = support.normal;
  const Vector3 axis = std::fabs(n[2]) > 0.5 ? Vector3{1.0, 0.0, 0.0} : Vector3{0.0, 0.0, 1.0};
  Vector3 first = cross(n, axis);
  const double length = std::sqrt(dot(first, first));
  for (double& x : first) x /= length;
  const Vector3 second = cross(n, first);
  const auto effect = [&](std::size_t body, const Vector3& push, double sign, std::array<double, 6>& on) {
    if (body == kNobody) return;
    const Body& of = bodies_[body / 6];
    const Vector3 arm{support.p_m[0] - of.p_m[0], support.p_m[1] - of.p_m[1], support.p_m[2] - of.p_m[2]};
    const Vector3 torque = cross(arm, push);
    for (std::size_t i = 0; i < 3; ++i) {
      on[i] = sign * push[i] / of.mass_root;
      on[i + 3] = sign * dot({of.spin_root[3 * i], of.spin_root[3 * i + 1], of.spin_root[3 * i + 2]}, torque);
    }
  };
  const auto add = [&](double along_first, double along_second) {
    Vector3 push{};
    for (std::size_t i = 0; i < 3; ++i)
      push[i] = n[i] + support.friction * (along_first * first[i] + along_second * second[i]);
    Edge& edge = edges_.emplace_back();
    edge.a = a;
    edge.b = b;
    effect(a, push, 1.0, edge.on_a);
    effect(b, push, -1.0, edge.on_b);
  };
  if (support.friction <= 0.0) return add(0.0, 0.0);
  for (const double one : {-1.0, 1.0}) {
    for (const double other : {-1.0, 1.0}) add(one, other);
  }
}

double Standing::along(const Edge& edge, const std::vector<double>& x) const noexcept {
  double sum = 0.0;
  for (std::size_t i = 0; i < 6; ++i) sum += edge.on_a[i] * x[edge.a + i];
  if (edge.b == kNobody) return sum;
  for (std::size_t i = 0; i < 6; ++i) sum += edge.on_b[i] * x[edge.b + i];
  return sum;
}

/// Convex; least where softness * x = weight + the sum of all edges, each as often as x goes against it.
double Standing::dual_energy(const std::vector<double>& x) const noexcept {
  double energy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) energy += x[i] * (0.5 * softness_ * x[i] - weight_[i]);
  for (const Edge& edge : edges_) {
    const double against = std::max(0.0, -along(edge, x));
    energy += 0.5 * against * against;
  }
  return energy;
}

/// Where the energy would be least if the edges that are pushed now, or `all`, were those that ever are, and were
/// pulled, too. False: no number.
bool Standing::newton_target(bool all) noexcept {
  const std::size_t n = x_.size();
  matrix_.assign(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) matrix_[i * n + i] = softness_;
  const auto add = [&](std::size_t row, const std::array<double, 6>& of_row, std::size_t column,
                       const std::array<double, 6>& of_column) {
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t k = 0; k < 6; ++k) matrix_[(row + i) * n + column + k] += of_row[i] * of_column[k];
    }
  };
  for (const Edge& edge : edges_) {
    if (!all && along(edge, x_) >= 0.0) continue;
    add(edge.a, edge.on_a, edge.a, edge.on_a);
    if (edge.b == kNobody) continue;
    add(edge.b, edge.on_b, edge.b, edge.on_b);
    add(edge.a, edge.on_a, edge.b, edge.on_b);
    add(edge.b, edge.on_b, edge.a, edge.on_a);
  }
  // Cholesky's decomposition, in place, and both substitutions.
  for (std::size_t k = 0; k < n; ++k) {
    double* const row = &matrix_[k * n];
    for (std::size_t j = 0; j < k; ++j) {
      const double* const other = &matrix_[j * n];
      double sum = row[j];
      for (std::size_t i = 0; i < j; ++i) sum -= row[i] * other[i];
      row[j] = sum / other[j];
    }
    double sum = row[k];
    for (std::size_t i = 0; i < k; ++i) sum -= row[i] * row[i];
    if (!(sum > 0.0)) return false;
    row[k] = std::sqrt(sum);
  }
  target_ = weight_;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < k; ++i) target_[k] -= matrix_[k * n + i] * target_[i];
    target_[k] /= matrix_[k * n + k];
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t i = k + 1; i < n; ++i) target_[k] -= matrix_[i * n + k] * target_[i];
    target_[k] /= matrix_[k * n + k];
  }
  return true;
}

/// Of the speeds that the forces found leave, the greatest: however far the search came, these are forces that may be.
double Standing::fastest_left() noexcept {
  tried_ = weight_;
  for (const Edge& edge : edges_) {
    const double force = std::max(0.0, -along(edge, x_));
    for (std::size_t i = 0; i < 6; ++i) tried_[edge.a + i] += force * edge.on_a[i];
    for (std::size_t i = 0; i < 6 && edge.b != kNobody; ++i) tried_[edge.b + i] += force * edge.on_b[i];
  }
  double fastest = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    const double* const left = &tried_[6 * i];
    Vector3 w{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < 3; ++j) w[k] += body.spin_root[3 * j + k] * left[3 + j];
    }
    const double v = std::sqrt(left[0] * left[0] + left[1] * left[1] + left[2] * left[2]) / body.mass_root;
    fastest = std::max(fastest, v + std::sqrt(dot(w, w)) * body.reach_m);
  }
  return fastest;
}

}  // namespace tandem::core
