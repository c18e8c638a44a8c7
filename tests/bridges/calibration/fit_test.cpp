// Lenses and places, found again from what a camera of known lens sees.
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "bridges/calibration/lens_fit.hpp"
#include "bridges/calibration/place_fit.hpp"
#include "bridges/tracker_emulator/picture.hpp"

namespace tandem::bridges::calibration {
namespace {

using testing::HasSubstr;

camera::Lens true_lens() {
  return {1280, 960, 900.0, 904.0, 652.0, 471.0, {-0.24, 0.08, 0.0008, -0.0005, 0.0}};
}

/// Looks at the board from a distance, tilted, turned and moved in the picture.
camera::Placement from(double distance_m, double tilt_rad, double about_rad, double x, double y) {
  const hal::Quaternion down(0.0, 1.0, 0.0, 0.0);
  const hal::Quaternion tilt(
      Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d(std::cos(about_rad), std::sin(about_rad), 0.0)));
  camera::Placement place;
  place.q_WC = tilt * down;
  place.p_WC = -(place.q_WC * hal::Vector3{x * distance_m, y * distance_m, distance_m});
  return place;
}

/// 20 ways to hold it.
std::vector<camera::Placement> twenty() {
  std::vector<camera::Placement> all;
  for (int i = 0; i < 20; ++i) {
    all.push_back(
        from(0.35 + 0.02 * (i % 7), (0.1 + 0.03 * i), 2.4 * i, 0.45 * std::cos(1.9 * i), 0.3 * std::sin(1.9 * i)));
  }
  return all;
}

/// With noise on every corner; what lies outside of the picture is not seen.
View view_of(const camera::Lens& lens, const Board& board, const camera::Placement& place, double noise_px,
             std::mt19937& chance) {
  std::normal_distribution<double> noise(0.0, noise_px);
  View view;
  for (std::size_t id = 0; id < board.columns * board.rows; ++id) {
    apriltag::Detection tag{id, {}};
    bool inside = true;
    const auto corners = board.corners_m(id);
    for (std::size_t i = 0; i < 4; ++i) {
      const auto pixel =
          camera::pixel_of(camera::Camera{lens, place, 0.0}, {(*corners)[i].x(), (*corners)[i].y(), 0.0});
      if (!pixel) return view;
      tag.corners[i] = *pixel + hal::Vector2{noise(chance), noise(chance)};
      inside = inside && pixel->x() > 0.0 && pixel->y() > 0.0 && pixel->x() < 1280.0 && pixel->y() < 960.0;
    }
    if (inside) view.tags.push_back(tag);
  }
  return view;
}

std::vector<View> views_of(const std::vector<camera::Placement>& places, double noise_px) {
  std::mt19937 chance(3);
  std::vector<View> views;
  for (const auto& place : places) {
    views.push_back(view_of(true_lens(), {}, place, noise_px, chance));
    views.back().name = "frame " + std::to_string(views.size());
  }
  return views;
}

TEST(LensFit, FindsTheLensAndHowWellItKnowsIt) {
  const auto fit = fit_lens(views_of(twenty(), 0.1), {}, 1280, 960, false);
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  const auto& f = fit.value();
  const camera::Lens lens = true_lens();
  EXPECT_NEAR(f.lens.fx, lens.fx, 4.0 * f.sd_focal_px);
  EXPECT_NEAR(f.lens.fy, lens.fy, 4.0 * f.sd_focal_px);
  EXPECT_NEAR(f.lens.cx, lens.cx, 4.0 * f.sd_centre_px);
  EXPECT_NEAR(f.lens.cy, lens.cy, 4.0 * f.sd_centre_px);
  EXPECT_LT(f.sd_focal_px, 1.0);
  EXPECT_NEAR(f.rms_px, 0.14, 0.02);
  EXPECT_NEAR(f.lens.distortion[0], lens.distortion[0], 0.01);
  EXPECT_EQ(f.views, 20U);
}

TEST(LensFit, LeavesOutAViewOfABoardThatWasBent) {
  auto views = views_of(twenty(), 0.1);
  for (auto& tag : views[4].tags) {
    for (auto& corner : tag.corners) corner.x() += 12.0 * std::sin(0.01 * corner.y());
  }
  const auto fit = fit_lens(views, {}, 1280, 960, false);
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  EXPECT_EQ(fit.value().left_out, std::vector<std::string>{"frame 5"});
  EXPECT_NEAR(fit.value().lens.fx, 900.0, 2.0);
}

TEST(LensFit, RefusesSetsThatCannotTell) {
  const auto why = [](const std::vector<View>& views) {
    const auto fit = fit_lens(views, {}, 1280, 960, false);
    return fit.ok() ? "good" : fit.error().message;
  };
  auto few = twenty();
  few.resize(5);
  EXPECT_THAT(why(views_of(few, 0.1)), HasSubstr("only 5 of 5 frames"));
  std::vector<camera::Placement> parallel, middle;
  for (int i = 0; i < 12; ++i) {
    parallel.push_back(from(0.35 + 0.02 * i, 0.0, 0.0, 0.4 * std::cos(1.9 * i), 0.3 * std::sin(1.9 * i)));
    middle.push_back(from(1.2, 0.4, 0.5 * i, 0.02 * i, 0.0));
  }
  EXPECT_THAT(why(views_of(parallel, 0.1)), HasSubstr("tilt it by 20 to 45 degrees"));
  EXPECT_THAT(why(views_of(middle, 0.1)), HasSubstr("four corners"));
  EXPECT_THAT(why(views_of(twenty(), 4.0)), HasSubstr("pixels"));
}

TEST(PlaceFit, FindsWhereTheCameraHangsAndNamesATagThatLiesElsewhere) {
  const camera::Lens lens = true_lens();
  const camera::Camera hung{lens, {hal::Quaternion(0.03, 0.998, 0.04, -0.02).normalized(), {0.2, -0.1, 2.1}}, 0.0};
  std::mt19937 chance(4);
  std::normal_distribution<double> noise(0.0, 0.1);
  std::vector<KnownPoint> points;
  for (const auto& [x_m, y_m] : {std::pair{-0.8, -0.6}, {0.9, -0.6}, {0.9, 0.6}, {-0.8, 0.6}, {0.1, 0.0}}) {
    const hal::Vector2 pixel = *camera::pixel_of(hung, {x_m, y_m, 0.0});
    points.push_back(
        {"tag " + std::to_string(points.size()), {x_m, y_m, 0.0}, pixel + hal::Vector2{noise(chance), noise(chance)}});
  }
  const auto fit = fit_place(lens, points);
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  EXPECT_NEAR((fit.value().place.p_WC - hung.place.p_WC).norm(), 0.0, 4.0 * std::sqrt(3.0) * fit.value().sd_m);
  EXPECT_LT(fit.value().sd_m, 0.003);
  EXPECT_LT(fit.value().worst_m, 0.001);
  points[4].p_W.x() += 0.1;
  const auto wrong = fit_place(lens, points);
  ASSERT_FALSE(wrong.ok());
  EXPECT_THAT(wrong.error().message, HasSubstr("mm from where it should be"));
  points.resize(3);
  EXPECT_THAT(fit_place(lens, points).error().message, HasSubstr("3 were seen"));
}

/// The whole way, from pictures on.
TEST(LensFit, FindsTheLensFromPictures) {
  const Board board;
  auto detector = apriltag::Detector::make({"tag36h11", 1.0, 1});
  ASSERT_TRUE(detector.ok());
  camera::Lens lens = true_lens();
  lens.width = 640;
  lens.height = 480;
  lens.fx = lens.fy = 520.0;
  lens.cx = 326.0;
  lens.cy = 236.0;
  std::vector<View> views;
  const auto places = twenty();
  for (std::size_t v = 0; v < 10; ++v) {
    const auto& place = places[2 * v];
    tracker_emulator::Artist artist({lens.width,
                                     lens.height,
                                     {lens.fx, lens.fy},
                                     {lens.cx, lens.cy},
                                     lens.distortion,
                                     place.p_WC,
                                     place.q_WC.toRotationMatrix()},
                                    {.blur_px = 0.6, .noise = 3.0}, v + 1);
    std::vector<tracker_emulator::PlacedTag> tags;
    for (std::size_t id = 0; id < board.columns * board.rows; ++id) {
      const auto corners = board.corners_m(id);
      const hal::Vector2 centre = 0.5 * ((*corners)[0] + (*corners)[2]);
      tags.push_back({apriltag::pattern(board.family, id).value(),
                      board.size_m,
                      {centre.x(), centre.y(), 0.0},
                      hal::Matrix3::Identity()});
    }
    views.push_back({"frame", (*detector)->detect(artist.draw(tags), lens.width, lens.height)});
  }
  const auto fit = fit_lens(views, board, lens.width, lens.height, false);
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  std::printf("focal length %.2f of 520, centre %.2f %.2f of 326 236, %.3f pixels RMS, %zu views\n",
              fit.value().lens.fx, fit.value().lens.cx, fit.value().lens.cy, fit.value().rms_px, fit.value().views);
  EXPECT_NEAR(fit.value().lens.fx, 520.0, 1.5);
  EXPECT_NEAR(fit.value().lens.cx, 326.0, 1.5);
  EXPECT_NEAR(fit.value().lens.cy, 236.0, 1.5);
  EXPECT_LT(fit.value().rms_px, 0.2);
}

}  // namespace
}  // namespace tandem::bridges::calibration
