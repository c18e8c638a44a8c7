#include "mixed_reality/gap/way_model.hpp"

#include <algorithm>
#include <cmath>

#include "hal/angle.hpp"

namespace tandem::mixed_reality {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSideways = 2.5e-7;  // variance in m^2 after 1 m: 0.5 mm, of what is not perfectly flat
constexpr double kUnseen_rad = 3.0;

/// What remains of a way when the gear has turned through its play.
double through_play(double way_m, double play_m, double& at_m) {
  if (play_m <= 0.0) return way_m;
  const double moved_m = std::clamp(at_m + way_m, 0.0, play_m);
  const double rest_m = way_m - (moved_m - at_m);
  at_m = moved_m;
  return rest_m;
}

struct Pose {
  Vector3d at = Vector3d::Zero();
  Matrix3d p = Matrix3d::Zero();

  void roll(double left_m, double right_m, double base_m, double noise2) {
    const double way = 0.5 * (left_m + right_m);
    const double turn = (right_m - left_m) / base_m;
    const double half = 0.5 * turn;
    const double chord = way * (std::fabs(half) < 1e-6 ? 1.0 - half * half / 6.0 : std::sin(half) / half);
    const double c = std::cos(at.z() + half), s = std::sin(at.z() + half);
    at += Vector3d(chord * c, chord * s, turn);
    // P <- F P F', F = 1 but for (0,2) and (1,2).
    const double fx = -chord * s, fy = chord * c;
    p.row(0) += fx * p.row(2);
    p.row(1) += fy * p.row(2);
    p.col(0) += fx * p.col(2);
    p.col(1) += fy * p.col(2);
    const Vector3d left = by_left(c, s, chord, base_m), right = by_right(c, s, chord, base_m);
    const Vector3d aside(-s, c, 0.0);
    p += noise2 * std::fabs(left_m) * left * left.transpose() +
         noise2 * std::fabs(right_m) * right * right.transpose() +
         (kSideways * std::fabs(way)) * aside * aside.transpose();
  }

  /// The speeds change by so much, at times whose mean has the variance `mean_s2`, and whose difference `apart_s2`.
  void change(double left_m_s, double right_m_s, double base_m, double mean_s2, double apart_s2) {
    const double c = std::cos(at.z()), s = std::sin(at.z());
    const Vector3d left = left_m_s * by_left(c, s, 0.0, base_m), right = right_m_s * by_right(c, s, 0.0, base_m);
    const Vector3d both = left + right, apart = 0.5 * (left - right);
    p += mean_s2 * both * both.transpose() + apart_s2 * apart * apart.transpose();
  }

 private:
  /// What the pose moves by for each metre that a wheel rolls more, of a stretch with this chord.
  static Vector3d by_left(double c, double s, double chord, double base_m) {
    return {0.5 * c + 0.5 * chord * s / base_m, 0.5 * s - 0.5 * chord * c / base_m, -1.0 / base_m};
  }
  static Vector3d by_right(double c, double s, double chord, double base_m) {
    return {0.5 * c - 0.5 * chord * s / base_m, 0.5 * s + 0.5 * chord * c / base_m, 1.0 / base_m};
  }
};

}  // namespace

WayModel::Likelihood::Setup WayModel::setup() {
  Likelihood::Setup s;
  s.first << 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, std::log(0.005), std::log(0.001), std::log(0.0003), std::log(0.003),
      std::log(0.02);
  // Wide: it only holds fast what the data does not tell.
  s.prior << 0.3, 0.3, 0.3, 0.25, 0.5, 1e-3, 3.0, 3.0, 3.0, 3.0, 3.0;
  s.step << 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e-5, 1e-3, 1e-3, 1e-3, 1e-3, 1e-3;
  s.least << 0.1, 0.1, 0.1, -0.3, -4.0, 0.0, -14.0, -14.0, -14.0, -14.0, -14.0;
  s.most << 10.0, 10.0, 10.0, 1.0, 4.0, 0.01, 0.0, -1.0, -1.0, 0.0, 1.0;
  return s;
}

void WayModel::run(const Params& v, Likelihood::Innovations& out) const {
  const double base_m = wheel_base_m_ * v[kBase], noise2 = std::exp(2.0 * v[kNoise]);
  const double jitter2 = std::exp(2.0 * v[kJitter]), apart2 = std::exp(2.0 * v[kApart]);
  const double var_m = std::exp(2.0 * v[kPlaceM]), var_rad = std::exp(2.0 * v[kPlaceRad]);
  const std::vector<WheelSeries::Command>& commands = series_.commands;
  out.assign(series_.places.size(), {});
  Pose pose;
  bool known = false, oriented = false;
  double at_s = 0.0, play_left = 0.0, play_right = 0.0;
  std::size_t next = 0;  // the first command that does not hold yet
  const auto obey = [&] {
    const WheelSeries::Command last = next > 0 ? commands[next - 1] : WheelSeries::Command{};
    pose.change(v[kLeft] * (commands[next].left_m_s - last.left_m_s),
                v[kRight] * (commands[next].right_m_s - last.right_m_s), base_m, jitter2, apart2);
    ++next;
  };
  for (std::size_t i = 0; i < series_.places.size(); ++i) {
    const WheelSeries::Place& place = series_.places[i];
    while (i > 0 && at_s < place.at_s) {
      const double until_s =
          next < commands.size() ? std::min(place.at_s, commands[next].at_s + v[kDelay]) : place.at_s;
      if (until_s > at_s && next > 0) {
        const WheelSeries::Command& now = commands[next - 1];
        known = known && now.known;
        const double s = until_s - at_s;
        pose.roll(v[kLeft] * through_play(now.left_m_s * s, v[kPlay], play_left),
                  v[kRight] * through_play(now.right_m_s * s, v[kPlay], play_right), base_m, noise2);
      }
      at_s = std::max(at_s, until_s);
      if (until_s < place.at_s) obey();
    }
    at_s = place.at_s;
    while (next < commands.size() && commands[next].at_s + v[kDelay] <= at_s) obey();
    const bool heading = std::isfinite(place.heading_rad);
    const double seen_rad = heading ? place.heading_rad - v[kMount] : pose.at.z();
    if (!known || elsewhere_[i] != 0) {
      pose.at = Vector3d(place.x_m, place.y_m, seen_rad);
      const double first_var = heading ? var_rad : oriented ? pose.p(2, 2) + 1.0 : kUnseen_rad * kUnseen_rad;
      pose.p = Vector3d(var_m, var_m, first_var).asDiagonal();
      known = oriented = true;
      continue;
    }
    Likelihood::Innovation& in = out[i];
    in.t_s = at_s;
    in.e = Vector3d(place.x_m, place.y_m, seen_rad) - pose.at;
    in.e.z() = heading ? hal::wrapped(in.e.z()) : 0.0;
    in.s = pose.p;
    in.s(0, 0) += var_m;
    in.s(1, 1) += var_m;
    if (heading) {
      in.s(2, 2) += var_rad;
    } else {
      in.s.row(2).setZero();
      in.s.col(2).setZero();
      in.s(2, 2) = 1.0;
    }
    in.there = true;
    Matrix3d ph = pose.p;
    if (!heading) ph.col(2).setZero();
    const Matrix3d gain = ph * in.s.inverse();
    pose.at += gain * in.e;
    pose.at.z() = hal::wrapped(pose.at.z());
    pose.p -= gain * ph.transpose();
    pose.p = 0.5 * (pose.p + pose.p.transpose().eval());
  }
}

bool WayModel::leave_out(const Likelihood::Innovations& innovations) {
  bool any = false;
  for (std::size_t i = 0; i < innovations.size(); ++i) {
    if (!innovations[i].there || Likelihood::chi_square(innovations[i]) <= kElsewhere) continue;
    elsewhere_[i] = 1;
    any = true;
  }
  return any;
}

std::size_t WayModel::left_out() const noexcept {
  return static_cast<std::size_t>(std::count(elsewhere_.begin(), elsewhere_.end(), 1));
}

}  // namespace tandem::mixed_reality
