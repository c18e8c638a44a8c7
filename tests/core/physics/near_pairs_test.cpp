#include "core/physics/near_pairs.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace tandem::core {
namespace {

struct Bodies {
  std::vector<double> x, y, z, radius, height, hop;
  std::size_t size() const { return x.size(); }
  Cylinders cylinders() const { return {x, y, z, radius, height, hop}; }
  void add(double x_m, double y_m, double z_m, double r, double h, double hop_m) {
    x.push_back(x_m);
    y.push_back(y_m);
    z.push_back(z_m);
    radius.push_back(r);
    height.push_back(h);
    hop.push_back(hop_m);
  }
};

std::vector<std::uint32_t> by_brute_force(const Bodies& b, std::size_t i) {
  std::vector<std::uint32_t> near;
  for (std::size_t k = 0; k < b.size(); ++k) {
    const double hops = b.hop[i] + b.hop[k];
    const double gap = std::hypot(b.x[i] - b.x[k], b.y[i] - b.y[k]) - b.radius[i] - b.radius[k];
    const double above = std::max(b.z[k] - b.z[i] - b.height[i], b.z[i] - b.z[k] - b.height[k]);
    if (k != i && gap < hops - 1e-9 && above < hops - 1e-9) near.push_back(static_cast<std::uint32_t>(k));
  }
  return near;
}

RC_GTEST_PROP(NearPairs, AreThoseThatBruteForceFinds, ()) {
  Bodies bodies;
  const int n = *rc::gen::inRange(0, 80);
  const double size_m = *rc::gen::element(0.5, 3.0, 500.0);
  const auto share = [] { return *rc::gen::inRange(-100000, 100000) * 1e-5; };
  for (int i = 0; i < n; ++i) {
    const bool small = *rc::gen::arbitrary<bool>();
    bodies.add(size_m * share(), size_m * share(), 2.0 * share(), small ? 0.035 : 0.25, small ? 0.086 : 0.566,
               0.3 * std::fabs(share()));
  }
  NearPairs pairs;
  for (int twice = 0; twice < 2; ++twice) {
    pairs.find(bodies.cylinders());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const auto found = pairs.of(i);
      RC_ASSERT(std::is_sorted(found.begin(), found.end()));
      for (const std::uint32_t k : by_brute_force(bodies, i))
        RC_ASSERT(std::binary_search(found.begin(), found.end(), k));
      for (const std::uint32_t k : found) {  // whoever i has, has i
        const auto back = pairs.of(k);
        RC_ASSERT(std::binary_search(back.begin(), back.end(), static_cast<std::uint32_t>(i)));
      }
    }
  }
}

TEST(NearPairs, AreFewWhereBodiesAreFarApart) {
  Bodies bodies;
  for (int i = 0; i < 1000; ++i) bodies.add(i % 32, i / 32, 0, 0.035, 0.086, 0.03);
  NearPairs pairs;
  pairs.find(bodies.cylinders());
  for (std::size_t i = 0; i < bodies.size(); ++i) EXPECT_TRUE(pairs.of(i).empty());
}

}  // namespace
}  // namespace tandem::core
