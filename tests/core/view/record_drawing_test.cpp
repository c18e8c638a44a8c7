#include "core/view/record_drawing.hpp"

#include <cstdio>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>

#include "core/record/record.hpp"
#include "core/view/picture.hpp"
#include "core/view/povray.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/turret.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/eyebot.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::core {
namespace {

const std::string kPath = testing::TempDir() + "record_drawing_test.record";

void set_up(Space& space) {
  SpaceStores& s = space.stores();
  s.min_x_m = -2.0;
  s.max_x_m = 2.0;
  s.min_y_m = -1.0;
  s.max_y_m = 3.0;
  add_robot(space, hal::epuck::kind(), "ep0", 0.5, 0.25, 1.0, {&hal::port_type<hal::RingLeds>()});
  add_robot(space, hal::footbot::kind(), "fb", 1.0, 1.0, 0.0,
            {&hal::port_type<hal::RingLeds>(), &hal::port_type<hal::TurretEncoder>()});
  add_robot(space, hal::eyebot::kind(), "eb", 1.0, -0.5, 2.0);
  const RobotId real = add_robot(space, hal::epuck::kind(), "gina", -1.0, 0.0, -3.0);
  space.set_external(real, true);
  Object crate;
  crate.id = "crate";
  crate.movable = true;
  crate.half_x_m = 0.25;
  crate.half_y_m = 0.125;
  crate.z_high_m = 0.5;
  Object column;
  column.id = "column";
  column.kind = Object::Kind::Cylinder;
  column.radius_m = 0.25;
  column.z_high_m = 0.75;
  s.objects = {crate, column};
  s.lights.push_back({"lamp", 1.0, 1.0, 0.5, 1.0, {255, 0, 0}});
}

void record(const Space& space, Recorder& recorder, hal::Tick tick) {
  const hal::Status written = recorder.tick_done(space, tick);
  ASSERT_TRUE(written.ok()) << written.error().message;
}

std::unique_ptr<Recorder> recorder_of(const Space& space) {
  RecordConfig config;
  config.path = kPath;
  config.entities = {"*"};
  config.ports = {"leds", "turret_encoder"};
  auto recorder = Recorder::open(config, space,
                                 {{"experiment", "test"}, {"seed", 12345678901234567890ULL}, {"ticks_per_second", 10}});
  EXPECT_TRUE(recorder.ok()) << (recorder.ok() ? "" : recorder.error().message);
  return std::move(recorder).value();
}

PictureOptions options_of(std::int64_t ticks_done) {
  PictureOptions options;
  options.experiment = "test";
  options.seed = 12345678901234567890ULL;
  options.time_ns = hal::time_of_tick(ticks_done, 10);
  options.look.ids = true;
  options.ticks_done = ticks_done;
  return options;
}

TEST(RecordDrawings, AreThoseOfTheSpace) {
  Space space;
  set_up(space);
  Trails live(1.0, 10), recorded(1.0, 10);
  std::vector<std::string> svgs, scenes;
  {
    const auto recorder = recorder_of(space);
    for (int tick = 0; tick < 4; ++tick) {
      const double x_m = 0.125 * tick;
      space.set_pose(space.robot(0), {x_m, 0.25, 0.0, 1.0, 0.0});
      space.port<hal::RingLeds>(space.robot(0))->set(static_cast<std::size_t>(tick), hal::kGreen);
      space.port<hal::RingLeds>(space.robot(1))->set(3, hal::kRed);
      space.stores().objects[0].x_m = -x_m;
      record(space, *recorder, tick);
      live.note(tick + 1, space);
      PictureOptions options = options_of(tick + 1);
      options.trails = &live;
      const Drawing d = drawing_of(space, options);
      svgs.push_back(to_svg(d, options.look));
      scenes.push_back(to_povray(d, options.look));
    }
    ASSERT_TRUE(recorder->close(3, {{"ended", "length"}}).ok());
  }
  auto opened = RecordSource::open(kPath);
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  RecordSource& seen = opened.value();
  EXPECT_EQ(seen.ticks_done(), 0) << "a record begins before the first tick";
  EXPECT_EQ(arena_of(seen.space()).max_y_m, 3.0);
  for (std::size_t i = 0; i < svgs.size(); ++i) {
    ASSERT_TRUE(seen.next());
    EXPECT_EQ(seen.ticks_done(), static_cast<std::int64_t>(i) + 1);
    recorded.note(seen.ticks_done(), seen.space());
    const PictureLook look{.ids = true};
    const Drawing d = drawing_of(seen, look, &recorded);
    EXPECT_EQ(to_svg(d, look), svgs[i]);
    EXPECT_EQ(to_povray(d, look), scenes[i]);
  }
  EXPECT_FALSE(seen.next());
  EXPECT_EQ(seen.ticks_done(), 4);
  EXPECT_TRUE(seen.moments().damage().empty());
  std::remove(kPath.c_str());
}

TEST(RecordDrawings, OfDamagedRecordsAreDrawnAsFarAsTheyGo) {
  Space space;
  set_up(space);
  {
    const auto recorder = recorder_of(space);
    for (int tick = 0; tick < 4; ++tick) record(space, *recorder, tick);
    ASSERT_TRUE(recorder->close(3, {{"ended", "length"}}).ok());
  }
  std::ostringstream text;
  text << std::ifstream(kPath, std::ios::binary).rdbuf();
  const std::string whole = text.str();
  std::size_t drawn = 0;
  for (std::size_t at = 0; at < whole.size(); at += 101) {
    std::string damaged = whole;
    if (at % 2 == 0)
      damaged.resize(at);
    else
      damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    std::ofstream(kPath, std::ios::binary) << damaged;
    auto drawings = RecordSource::open(kPath);
    if (!drawings.ok()) continue;
    do {
      drawn += to_svg(drawing_of(drawings.value(), {}, nullptr)).size();
    } while (drawings.value().next());
  }
  EXPECT_GT(drawn, 0U);
  std::remove(kPath.c_str());
}

}  // namespace
}  // namespace tandem::core
