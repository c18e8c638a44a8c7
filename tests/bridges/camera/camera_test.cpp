#include "bridges/camera/camera.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

#include "bridges/camera/camera_file.hpp"

namespace tandem::bridges::camera {
namespace {

Camera ceiling() {
  Camera camera;
  camera.lens = {1280, 960, 900.0, 905.0, 632.0, 488.0, {-0.28, 0.09, 0.001, -0.0008, -0.01}};
  // Looks down from 2 m, leaning a little.
  camera.place = {hal::Quaternion(0.02, 0.999, 0.03, 0.01).normalized(), {0.1, -0.2, 2.0}};
  return camera;
}

TEST(Camera, FindsThePointOfTheFloorThatAPixelShows) {
  const Camera camera = ceiling();
  for (double x_m = -1.0; x_m <= 1.0; x_m += 0.25) {
    for (double y_m = -0.8; y_m <= 0.8; y_m += 0.2) {
      const auto pixel = pixel_of(camera, {x_m, y_m, 0.3});
      ASSERT_TRUE(pixel.has_value());
      const auto back = on_plane(camera, *pixel, 0.3);
      ASSERT_TRUE(back.has_value()) << x_m << " " << y_m;
      EXPECT_NEAR(back->x(), x_m, 1e-9);
      EXPECT_NEAR(back->y(), y_m, 1e-9);
    }
  }
  EXPECT_NEAR(*metres_a_pixel(camera, {640.0, 480.0}, 0.0), 2.0 / 900.0, 2e-4);
}

TEST(Camera, ShowsNothingBehindItAboveTheHorizonOrWhereItsLensTurnsBack) {
  Camera camera = ceiling();
  EXPECT_FALSE(pixel_of(camera, {0.0, 0.0, 3.0}).has_value());
  EXPECT_FALSE(on_plane(camera, {640.0, 480.0}, 2.5).has_value());
  camera.lens.distortion = {-0.9, 0.0, 0.0, 0.0, 0.0};
  EXPECT_FALSE(on_plane(camera, {-2000.0, 480.0}, 0.0).has_value());
}

TEST(Camera, IsTheSameFromItsFileAndDamagedFilesAreRefused) {
  const std::string path =
      std::filesystem::path(testing::TempDir()) / ("tandem_camera_" + std::to_string(::getpid()) + ".json");
  const Camera camera = ceiling();
  ASSERT_TRUE(write_camera_file(path, {camera.lens, 0.2, 20, {}, 0.0}).ok());
  const auto nowhere = read_camera(path);
  ASSERT_FALSE(nowhere.ok());
  EXPECT_NE(nowhere.error().message.find("calibrate arena"), std::string::npos);
  ASSERT_TRUE(write_camera_file(path, {camera.lens, 0.2, 20, camera.place, 0.3}).ok());
  auto same = read_camera(path);
  ASSERT_TRUE(same.ok()) << same.error().message;
  EXPECT_EQ(same->lens.distortion, camera.lens.distortion);
  EXPECT_NEAR((same->place.p_WC - camera.place.p_WC).norm(), 0.0, 1e-12);
  EXPECT_NEAR(same->place.q_WC.angularDistance(camera.place.q_WC), 0.0, 1e-7);
  EXPECT_DOUBLE_EQ(same->residual_px, 0.3);
  for (const char* text :
       {"", "{", "[1]", R"({"lens":{"size_px":[1280,960],"focal_px":[0,900]}})",
        R"({"lens":{"size_px":["a",960],"focal_px":[900,900],"centre_px":[1,1],"distortion":[]}})"}) {
    std::ofstream(path) << text;
    EXPECT_FALSE(read_camera_file(path).ok()) << text;
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace tandem::bridges::camera
