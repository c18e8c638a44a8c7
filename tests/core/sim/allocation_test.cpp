// Counts allocations of the whole program: after the first steps a world makes none.
#include <atomic>
#include <cstdlib>
#include <gtest/gtest.h>
#include <limits>
#include <new>

#include "hal/device/range_and_bearing.hpp"
#include "tests/core/eyebots.hpp"
#include "tests/core/watchers.hpp"

namespace {
std::atomic<std::uint64_t> allocations{0};
void* counted(std::size_t size, std::size_t align) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  void* p = align > alignof(std::max_align_t) ? std::aligned_alloc(align, (size + align - 1) / align * align)
                                              : std::malloc(size);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}
}  // namespace

// GCC cannot see that both sides are malloc and free.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

void* operator new(std::size_t size) {
  return counted(size, 1);
}
void* operator new(std::size_t size, std::align_val_t align) {
  return counted(size, static_cast<std::size_t>(align));
}
void operator delete(void* p) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
  std::free(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}

namespace tandem::core {
namespace {

TEST(World, AllocatesNothingAfterTheFirstSteps) {
  for (const std::int64_t threads : {1, 3}) {
    Scene scene(8.0, "everything");
    scene.param("left", "0.05").param("right", "0.04").walls().robots(3000, 3.8);
    WorldOptions options;
    options.threads = threads;
    auto world = make(scene, options);
    ASSERT_TRUE(world.world) << world.all_problems();
    world->start();
    for (int i = 0; i < 3; ++i) world->step();
    const std::uint64_t before = allocations.load();
    EXPECT_GT(before, 0U);
    for (int i = 0; i < 50; ++i) world->step();
    EXPECT_EQ(allocations.load() - before, 0U) << threads << " threads";
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  }
}

TEST(World, AllocatesNothingForMisbehaviourThatGoesOn) {
  Scene scene = footbot_scene("dynamics2d", 8.0);
  for (int i = 0; i < 20; ++i) add_footbot(scene, "r" + std::to_string(i), 3.8, -3.8 + 0.36 * i, 0);
  scene.scenario.escape = EscapePolicy::Stop;
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  const auto step = [&] {
    for (int i = 0; i < 20; ++i) {
      const std::string id = "r" + std::to_string(i);
      command<hal::WheelSpeeds>(world, id).set(0.1, 0.1);
      command<hal::TurretDrive>(world, id).turn(std::numeric_limits<double>::quiet_NaN());
    }
    world->step();
  };
  for (int i = 0; i < 30; ++i) step();
  const auto escaped = world->incidents().bodies_escaped, not_finite = world->incidents().commands_not_finite;
  const std::uint64_t before = allocations.load();
  for (int i = 0; i < 50; ++i) step();
  EXPECT_EQ(allocations.load() - before, 0U);
  EXPECT_EQ(world->incidents().bodies_escaped - escaped, 1000U);
  EXPECT_EQ(world->incidents().commands_not_finite - not_finite, 1000U);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST(World, AllocatesNothingForFootbotsThatScanTalkAndGrip) {
  Scene scene = footbot_scene("dynamics2d", 10.0);
  for (int i = 0; i < 200; ++i)
    add_footbot(scene, "fb" + std::to_string(i), 0.3 * (i % 15) - 2.2, 0.3 * (i / 15) - 2.0, 0.4 * i);
  scene.cylinder(3.5, 0, 0.3).walls();
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  for (int i = 0; i < 200; ++i) {
    const std::string id = "fb" + std::to_string(i);
    command<hal::WheelSpeeds>(world, id).set(0.02, 0.03);
    command<hal::TurretDrive>(world, id).turn(0.5);
    command<hal::ScannerDrive>(world, id).turn(3.0);
    command<hal::RangeAndBearingSend>(world, id).sending = true;
    if (i % 2 == 0) command<hal::GripperDrive>(world, id).lock();
  }
  steps(world, 40);  // until whoever can hold something does
  const std::uint64_t before = allocations.load();
  steps(world, 20);
  EXPECT_EQ(allocations.load() - before, 0U);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST(World, AllocatesNothingForFootbotsThatShineAndLook) {
  Scene scene = camera_scene(10.0);
  for (int i = 0; i < 200; ++i)
    add_footbot(scene, "fb" + std::to_string(i), 0.3 * (i % 15) - 2.2, 0.3 * (i / 15) - 2.0, 0.4 * i);
  scene.cylinder(3.5, 0, 0.3).walls();
  add_led(scene, {0.0, 0.0, 0.5}, {255, 0, 0});
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  for (int i = 0; i < 200; ++i) {
    command<hal::WheelSpeeds>(world, "fb" + std::to_string(i)).set(0.02, 0.03);
    shine(world, "fb" + std::to_string(i), hal::kRed);
  }
  steps(world, 3);
  const std::uint64_t before = allocations.load();
  steps(world, 20);
  EXPECT_EQ(allocations.load() - before, 0U);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST(World, AllocatesNothingForRobotsThatFlyInACrowd) {
  Scene scene(8.0, "everything");
  scene.scenario.arena_size[2] = 8.0;
  scene.engine("particle3d").split("2x2");
  scene.param("left", "0.1").param("right", "0.08").walls().robots(600, 3.8);
  scene.pilot("fly", {{"velocity", "0.3,0.2,0.01", 0}, {"turn", "0.4", 0}});
  for (int i = 0; i < 100; ++i)
    scene.flyer("e" + std::to_string(i), -3 + 0.55 * (i % 10), -3 + 0.55 * (i / 10), 0.5 + 0.02 * i);
  auto world = make(scene);
  ASSERT_TRUE(world.world) << world.all_problems();
  world->start();
  for (int i = 0; i < 10; ++i) world->step();  // as regions fill, lists grow by doubling
  const std::uint64_t before = allocations.load();
  for (int i = 0; i < 30; ++i) world->step();
  EXPECT_EQ(allocations.load() - before, 0U);
  EXPECT_EQ(world->state(), RunState::Running) << world->failure();
}

TEST(World, AllocatesNothingForEyeBotsThatUseAllTheirDevices) {
  for (const std::string& way : ways_to_fly()) {
    Scene scene = eyebot_scene(way, 10.0);
    for (int i = 0; i < 60; ++i)
      scene.flyer("e" + std::to_string(i), -3.5 + i % 8, -3.5 + i / 8, i % 2 == 0 ? 0.0 : 1.0 + 0.01 * i);
    scene.box(4.6, 0, 0.2, 4.0);
    add_led(scene, {0.0, 0.0, 0.5}, {255, 0, 0});
    auto world = make(scene);
    ASSERT_TRUE(world.world) << world.all_problems();
    world->start();
    for (int i = 0; i < 60; ++i) {
      const std::string id = "e" + std::to_string(i);
      command<hal::FlightTask>(world, id).order = i % 2 == 0 ? hal::FlightOrder::TakeOff : hal::FlightOrder::Fly;
      command<hal::QuadrotorSpeed>(world, id).set(0.02 * (i % 5 - 2), 0.02 * (i % 3 - 1), 0.0, 0.3);
      command<hal::RangeAndBearingSend>(world, id).sending = true;
      command<hal::ScannerDrive>(world, id).turn(3.0);
      command<hal::PanTiltDrive>(world, id) = {{}, 0.1 * i, 1.4, false};
      shine(world, id, hal::kRed);
      command<hal::UpperRingLeds>(world, id).set_all(hal::kGreen);
    }
    steps(world, 10);
    const std::uint64_t before = allocations.load();
    steps(world, 30);
    EXPECT_EQ(allocations.load() - before, 0U) << way;
    EXPECT_EQ(world->state(), RunState::Running) << world->failure();
  }
}

}  // namespace
}  // namespace tandem::core
