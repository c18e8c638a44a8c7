// The way to a calibrated camera, by the commands that a user types, with frames that the emulated camera draws.
#include <gmock/gmock.h>

#include "bridges/apriltag/family.hpp"
#include "bridges/calibration/board.hpp"
#include "bridges/tracker_emulator/frame_sender.hpp"
#include "bridges/tracker_emulator/picture.hpp"
#include "hal/json/json.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using bridges::tracker_emulator::Artist;
using bridges::tracker_emulator::Lens;
using bridges::tracker_emulator::PlacedTag;
using testing::HasSubstr;

Lens lens_that_hangs(const hal::Quaternion& q, const hal::Vector3& p) {
  return {640, 480, {520.0, 522.0}, {327.0, 233.0}, {-0.2, 0.05, 0.0006, -0.0004, 0.0}, p, q.toRotationMatrix()};
}

void write_frame(const std::string& folder, const Lens& lens, const std::vector<PlacedTag>& tags, std::uint64_t seed,
                 bridges::tracker_emulator::Sender& sender) {
  Artist artist(lens, {}, seed);
  sender.send(bridges::tracker_emulator::frame_message(lens.width, lens.height, 0, artist.draw(tags)));
  ASSERT_TRUE(std::filesystem::exists(folder));
}

PlacedTag tag_at(std::size_t id, double x_m, double y_m, double size_m) {
  return {bridges::apriltag::pattern("tag36h11", id).value(), size_m, {x_m, y_m, 0.0}, hal::Matrix3::Identity()};
}

TEST(ACamera, IsCalibratedByABoardAndHungByTagsOnTheFloor) {
  Folder folder;
  Tandem board({"calibrate", "board", "-o", "board.svg"}, folder.path());
  ASSERT_EQ(board.wait(60), 0) << board.errors();
  EXPECT_THAT(text_of(folder.path() / "board.svg"), HasSubstr("This line must be 100 mm long"));
  const auto b = bridges::calibration::read_board(folder.path() / "board.json");
  ASSERT_TRUE(b.ok()) << b.error().message;

  const std::string views = folder.path() / "views", floor = folder.path() / "floor";
  auto sender = bridges::tracker_emulator::open_frame_sender("folder:" + views);
  ASSERT_TRUE(sender.ok());
  std::vector<PlacedTag> tags;
  for (std::size_t id = 0; id < b.value().columns * b.value().rows; ++id) {
    const auto corners = *b.value().corners_m(id);
    tags.push_back(tag_at(id, 0.5 * (corners[0].x() + corners[2].x()), 0.5 * (corners[0].y() + corners[2].y()), 0.03));
  }
  for (int i = 0; i < 11; ++i) {
    const hal::Quaternion tilt(
        Eigen::AngleAxisd(0.15 + 0.05 * i, Eigen::Vector3d(std::cos(2.4 * i), std::sin(2.4 * i), 0.0)));
    const hal::Quaternion q = tilt * hal::Quaternion(0.0, 1.0, 0.0, 0.0);
    const double distance_m = 0.36 + 0.015 * (i % 5);
    const hal::Vector3 p =
        -(q * hal::Vector3{0.4 * std::cos(1.9 * i) * distance_m, 0.28 * std::sin(1.9 * i) * distance_m, distance_m});
    write_frame(views, lens_that_hangs(q, p), tags, static_cast<std::uint64_t>(i) + 1, *sender.value());
  }
  Tandem camera({"calibrate", "camera", "--board", "board.json", "--frames", "folder:views", "-o", "camera.json"},
                folder.path());
  ASSERT_EQ(camera.wait(120), 0) << camera.errors();
  EXPECT_THAT(camera.output(), HasSubstr("pixels RMS"));

  const Lens hung = lens_that_hangs(hal::Quaternion(0.02, 0.999, -0.03, 0.01).normalized(), {0.1, 0.05, 1.5});
  auto floor_sender = bridges::tracker_emulator::open_frame_sender("folder:" + floor);
  ASSERT_TRUE(floor_sender.ok());
  write_frame(floor, hung,
              {tag_at(100, -0.6, -0.4, 0.1), tag_at(101, 0.7, -0.4, 0.1), tag_at(102, 0.7, 0.45, 0.1),
               tag_at(103, -0.6, 0.45, 0.1)},
              77, *floor_sender.value());
  const std::vector<std::string> arena = {
      "calibrate",     "arena", "--camera",     "camera.json", "--frames",     "folder:floor", "--tag",
      "100=-0.6,-0.4", "--tag", "101=0.7,-0.4", "--tag",       "102=0.7,0.45", "--tag",        "103=-0.6,0.45"};
  Tandem place(arena, folder.path());
  ASSERT_EQ(place.wait(60), 0) << place.errors();
  const auto json = hal::parse_json_object(text_of(folder.path() / "camera.json"));
  ASSERT_TRUE(json.ok());
  EXPECT_NEAR(json.value()["lens"]["focal_px"][0].get<double>(), 520.0, 2.5);
  EXPECT_NEAR(json.value()["lens"]["centre_px"][1].get<double>(), 233.0, 2.5);
  const auto p = json.value()["arena"]["position_m"].get<std::vector<double>>();
  EXPECT_NEAR(p[0], 0.1, 0.01);
  EXPECT_NEAR(p[1], 0.05, 0.01);
  EXPECT_NEAR(p[2], 1.5, 0.01);

  // The board itself, lying somewhere.
  std::vector<PlacedTag> lying;
  for (const PlacedTag& tag : tags) {
    lying.push_back(tag);
    lying.back().p_W += hal::Vector3{0.2, 0.1, 0.0};
  }
  auto near_sender = bridges::tracker_emulator::open_frame_sender("folder:" + (folder.path() / "near").string());
  ASSERT_TRUE(near_sender.ok());
  write_frame(folder.path() / "near",
              lens_that_hangs(hal::Quaternion(0.05, 0.998, -0.03, 0.01).normalized(), {0.22, 0.13, 0.45}), lying, 78,
              *near_sender.value());
  Tandem over({"calibrate", "arena", "--camera", "camera.json", "--frames", "folder:near", "--board", "board.json",
               "--at", "0.2,0.1,90", "-o", "near.json"},
              folder.path());
  ASSERT_EQ(over.wait(60), 0) << over.errors();
  const auto close = hal::parse_json_object(text_of(folder.path() / "near.json"));
  ASSERT_TRUE(close.ok());
  const auto q = close.value()["arena"]["position_m"].get<std::vector<double>>();
  EXPECT_NEAR(q[0], 0.22, 0.005);
  EXPECT_NEAR(q[1], 0.13, 0.005);
  EXPECT_NEAR(q[2], 0.45, 0.005);

  auto wrong = arena;
  wrong.back() = "103=-0.6,0.6";
  Tandem refused(wrong, folder.path());
  EXPECT_EQ(refused.wait(60), 1);
  EXPECT_THAT(refused.errors(), HasSubstr("from where it should be"));
}

}  // namespace
}  // namespace tandem::scenarios
