#include "mixed_reality/tracking/swapped_links.hpp"

#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <set>

namespace tandem::mixed_reality {
namespace {

constexpr hal::TimeNs kMs = hal::kNsPerMs;
constexpr double kBase_m = 0.1;

/// Robots that drive as told, by this test's own reckoning, and whose wheels slip; a camera, 30 pictures a second, that
/// is late and has noise; encoders that are read ten times a second.
class Robots {
 public:
  explicit Robots(std::size_t count, std::uint64_t seed = 1) : chance_(seed), all_(count) {
    for (std::size_t i = 0; i < count; ++i) {
      all_[i].x = 0.5 * static_cast<double>(i);
      all_[i].heading = 2.3 * static_cast<double>(i);
      all_[i].tag = i;
    }
    links_.resize(count);
  }
  /// One tick; link i is told `speeds[i]`. @returns what was found.
  std::vector<SwappedLinks::Found> tick(const std::vector<std::array<double, 2>>& speeds) {
    for (int ms = 0; ms < 100; ++ms) {
      now_ns_ += kMs;
      for (std::size_t i = 0; i < all_.size(); ++i) {
        Body& body = all_[robot_behind(i)];
        const double left = speeds[i][0] * 1e-3, right = speeds[i][1] * 1e-3;
        body.left += left;
        body.right += right;
        if (body.held) continue;
        const double way = 0.5 * (left * body.left_grip + right * body.right_grip);
        body.x += way * std::cos(body.heading);
        body.y += way * std::sin(body.heading);
        body.heading += (right * body.right_grip - left * body.left_grip) / kBase_m;
      }
      if (now_ns_ / kMs % 33 == 0) take_picture();
    }
    const Moment now{now_ns_, now_ns_};
    double farthest = 0.0;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const Body& behind = all_[robot_behind(i)];
      hal::WheelEncoders encoders;
      encoders.left_m = behind.left;
      encoders.right_m = behind.right;
      encoders.taken_ns = now_ns_;
      encoders.validity = hal::Validity::Fresh;
      farthest = std::max(farthest, 0.5 * (std::fabs(speeds[i][0]) + std::fabs(speeds[i][1])));
      auto& waiting = all_[i].pictures;
      std::optional<PoseMeasurement> newest;
      while (!waiting.empty() && waiting.front().taken_ns + late_ns_ <= now_ns_) {
        newest = waiting.front();
        waiting.erase(waiting.begin());
      }
      if (newest) all_[i].seen = newest;
      links_.note(i, encoders, kBase_m, all_[i].seen ? &*all_[i].seen : nullptr, now);
    }
    farthest_m_ += 0.1 * farthest;
    const auto found = links_.judge(now_ns_);
    return {found.begin(), found.end()};
  }
  /// Until something is found, for at most `ticks`.
  std::vector<SwappedLinks::Found> drive(const std::vector<std::array<double, 2>>& speeds, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      if (auto found = tick(speeds); !found.empty()) return found;
    }
    return {};
  }

  struct Body {
    double x = 0.0, y = 0.0, heading = 0.0, left = 0.0, right = 0.0, left_grip = 1.0, right_grip = 1.0;
    bool held = false;
    std::size_t tag;
    std::vector<PoseMeasurement> pictures;  ///< of its tag, still on their way
    std::optional<PoseMeasurement> seen;
  };
  std::size_t robot_behind(std::size_t link) const { return behind_.empty() ? link : behind_[link]; }

  std::mt19937_64 chance_;
  std::vector<Body> all_;
  std::vector<std::size_t> behind_;  ///< robot behind each link; empty: its own
  SwappedLinks links_;
  hal::TimeNs now_ns_ = hal::kNsPerSecond, late_ns_ = 60 * kMs;
  double farthest_m_ = 0.0;  ///< driven by the robot that drives most
  double noise_m_ = 0.002;
  double exchanged_ = 0.0;  ///< share of pictures in which two tags are exchanged
  bool headings_ = true;

 private:
  void take_picture() {
    std::normal_distribution<double> noise(0.0, noise_m_);
    const bool exchange = std::uniform_real_distribution<double>(0.0, 1.0)(chance_) < exchanged_;
    for (std::size_t i = 0; i < all_.size(); ++i) {
      const Body& body = all_[exchange && i < 2 ? 1 - i : i];
      PoseMeasurement seen;
      seen.taken_ns = now_ns_;
      seen.x_m = body.x + noise(chance_);
      seen.y_m = body.y + noise(chance_);
      if (headings_) seen.heading_rad = body.heading + 5.0 * noise(chance_);
      all_[i].pictures.push_back(seen);
    }
  }
};

using Speeds = std::vector<std::array<double, 2>>;

TEST(SwappedLinks, ThePairIsFoundBeforeTheFirstHasDrivenThirtyCentimetres) {
  for (const bool headings : {true, false}) {
    for (const double speed : {0.03, 0.1, 0.3}) {
      Robots robots(3);
      robots.headings_ = headings;
      robots.behind_ = {1, 0, 2};
      (void)robots.drive({{0, 0}, {0, 0}, {0, 0}}, 10);
      const auto found = robots.drive({{speed, speed}, {0.0, 0.0}, {0.0, 0.0}}, 200);
      ASSERT_EQ(found.size(), 1U) << speed << " m/s";
      EXPECT_EQ(found[0].robot, 0U);
      EXPECT_EQ(found[0].moves_as, 1U);
      EXPECT_LE(robots.farthest_m_, 0.3 + 1e-9) << speed << " m/s";
    }
  }
}

TEST(SwappedLinks, FoundWhenAllDriveAndDoNotDriveAlike) {
  Robots robots(4);
  robots.behind_ = {1, 2, 0, 3};
  const Speeds speeds = {{0.10, 0.10}, {0.04, 0.12}, {0.12, 0.02}, {0.08, 0.09}};
  (void)robots.drive({{0, 0}, {0, 0}, {0, 0}, {0, 0}}, 10);
  std::set<std::size_t> named;
  for (int i = 0; i < 60 && named.size() < 3; ++i) {
    for (const auto& one : robots.tick(speeds)) {
      EXPECT_EQ(one.moves_as, robots.behind_[one.robot]);
      EXPECT_TRUE(!named.empty() || robots.farthest_m_ <= 0.3) << "the first";
      named.insert(one.robot);
    }
  }
  EXPECT_EQ(named.size(), 3U);
}

TEST(SwappedLinks, RobotsThatTurnOnTheSpotAreFoundByTheirHeadings) {
  Robots robots(2);
  robots.behind_ = {1, 0};
  const auto found = robots.drive({{-0.03, 0.03}, {0.0, 0.0}}, 200);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LE(robots.farthest_m_, 0.3);
}

TEST(SwappedLinks, ThePairIsFoundAlthoughOneOfItIsHeld) {
  Robots robots(3);
  robots.behind_ = {1, 0, 2};
  robots.all_[0].held = true;
  (void)robots.drive({{0, 0}, {0, 0}, {0, 0}}, 10);
  const auto found = robots.drive({{0.10, 0.12}, {0.08, 0.05}, {0.0, 0.0}}, 200);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].robot, 0U);
  EXPECT_EQ(found[0].moves_as, 1U);
  EXPECT_LE(robots.farthest_m_, 0.3 + 1e-9);
}

/// TANDEM_SWAP_WORLDS=400 for the long run. In 116 and 274 a held robot's few centimetres look like another one's.
std::vector<std::uint64_t> worlds() {
  const char* const wanted = std::getenv("TANDEM_SWAP_WORLDS");
  std::vector<std::uint64_t> seeds(wanted != nullptr ? std::strtoull(wanted, nullptr, 10) : 40);
  std::iota(seeds.begin(), seeds.end(), 1);
  if (wanted == nullptr) seeds.insert(seeds.end(), {116, 274});
  return seeds;
}

TEST(SwappedLinks, NobodyIsAccusedWhateverSlipsIsHeldOrIsSeenBadly) {
  for (const std::uint64_t seed : worlds()) {
    Robots robots(5, seed);
    std::uniform_real_distribution<double> speed(-0.2, 0.3), share(0.0, 1.0);
    robots.late_ns_ = static_cast<hal::TimeNs>(share(robots.chance_) * 200.0) * kMs;
    robots.noise_m_ = 0.001 + 0.004 * share(robots.chance_);
    robots.exchanged_ = seed % 2 == 0 ? 0.02 : 0.0;
    robots.headings_ = seed % 3 != 0;
    for (auto& body : robots.all_) {
      body.left_grip = 0.97 + 0.06 * share(robots.chance_);
      body.right_grip = 0.97 + 0.06 * share(robots.chance_);
    }
    Speeds speeds(5, {0.0, 0.0});
    for (int i = 0; i < 1200; ++i) {
      if (i % 17 == 0) {
        for (auto& one : speeds) one = {speed(robots.chance_), speed(robots.chance_)};
        for (auto& body : robots.all_) body.held = share(robots.chance_) < 0.1;
        Robots::Body& carried = robots.all_[static_cast<std::size_t>(i) % 5];
        if (share(robots.chance_) < 0.2) carried.x += 0.3 * speed(robots.chance_);
      }
      const auto found = robots.tick(speeds);
      ASSERT_TRUE(found.empty()) << "seed " << seed << ", tick " << i << ": " << found[0].robot << " as "
                                 << found[0].moves_as;
    }
  }
}

}  // namespace
}  // namespace tandem::mixed_reality
