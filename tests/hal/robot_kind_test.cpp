#include "hal/robot_kind.hpp"

#include <gmock/gmock.h>

#include "hal/device/body_sensors.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/element.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/robots.hpp"

namespace tandem::hal {
namespace {

using testing::HasSubstr;

/// A part of a library's own.
struct WinchPart {
  static constexpr std::string_view kName = "winch";
  static constexpr std::string_view kDoc = "Pulls a rope.";
  double force_N = 0.0;
  std::string source = {};
  void describe(ParamVisitor& v) { v.number("force", force_N, unit::none, kNotNegative, "In N."); }
};
/// The same as another library was compiled with.
struct OtherWinchPart {
  static constexpr std::string_view kName = "winch";
  static constexpr std::string_view kDoc = "Pulls a rope.";
  double force_N = 0.0, rope_m = 0.0;
  std::string source = {};
  void describe(ParamVisitor&) {}
};

RobotKind crab() {
  RobotKind kind;
  kind.name = "crab";
  kind.body = {.radius_m = 0.1, .height_m = 0.05, .mass_kg = 2.0};
  kind.add(WinchPart{.force_N = 3.0, .source = "chosen"});
  kind.add(ProximityPart{.range_m = 0.2, .mounts = {{.bearing_rad = 1.0}}});
  return kind;
}

std::string error_of(const RobotKind& kind) {
  Catalog catalog;
  const Status added = catalog.add_from("library 'crab.so'", [&](Registrar& r) { r.add(kind); });
  return added.ok() ? "" : added.error().message;
}

TEST(RobotKind, HasThePartsThatItIsBuiltWithAndNoOthers) {
  const RobotKind kind = crab();
  ASSERT_NE(kind.part<WinchPart>(), nullptr);
  EXPECT_EQ(kind.part<WinchPart>()->force_N, 3.0);
  EXPECT_EQ(kind.part<ProximityPart>()->mounts.size(), 1U);
  EXPECT_EQ(kind.part<TurretPart>(), nullptr);
  EXPECT_EQ(kind.part<OtherWinchPart>(), nullptr) << "its form is another";
  EXPECT_EQ(kind.part<Body>(), &kind.body);
}

TEST(RobotKind, MovesInOneWayOrNotAtAll) {
  RobotKind kind = crab();
  EXPECT_EQ(kind.drive(), nullptr);
  EXPECT_FALSE(kind.flies());
  EXPECT_EQ(kind.top_speed_m_s(), 0.0);
  kind.locomotion = DifferentialDrive{.wheel_base_m = 0.1, .max_speed_m_s = 0.3};
  EXPECT_EQ(kind.part<DifferentialDrive>(), kind.drive());
  EXPECT_EQ(kind.part<Quadrotor>(), nullptr);
  EXPECT_EQ(kind.top_speed_m_s(), 0.3);
  kind.locomotion = Quadrotor{.max_speed_m_s = 2.0};
  EXPECT_TRUE(kind.flies());
  EXPECT_EQ(kind.drive(), nullptr);
  EXPECT_EQ(kind.top_speed_m_s(), 2.0);
}

TEST(RobotKind, CopiesHavePartsOfTheirOwn) {
  const RobotKind kind = crab();
  RobotKind copy = kind;
  copy.part<WinchPart>()->force_N = 5.0;
  copy.part<ProximityPart>()->mounts.clear();
  EXPECT_EQ(kind.part<WinchPart>()->force_N, 3.0);
  EXPECT_EQ(kind.part<ProximityPart>()->mounts.size(), 1U);
}

TEST(RobotKind, IsRegisteredWhenItCanBeUsed) {
  EXPECT_EQ(error_of(crab()), "");
  Catalog catalog;
  ASSERT_TRUE(catalog.add_from("tandem", register_robots).ok());
  EXPECT_EQ(catalog.find<RobotKind>("e-puck"), &epuck::kind());
}

TEST(RobotKind, WithoutABodyIsRefused) {
  for (const Body& body :
       {Body{.radius_m = 0.0, .height_m = 0.1, .mass_kg = 1.0}, Body{.radius_m = 0.1, .height_m = 0.0, .mass_kg = 1.0},
        Body{.radius_m = -0.1, .height_m = 0.1, .mass_kg = 1.0}}) {
    RobotKind kind = crab();
    kind.body = body;
    EXPECT_EQ(
        error_of(kind),
        "'library 'crab.so'' registers the robot 'crab', which has no body; give it a radius and a height above 0");
  }
  RobotKind light = crab();
  light.body.mass_kg = 0.0;
  EXPECT_THAT(error_of(light), HasSubstr("weighs nothing; give its body a mass above 0"));
}

TEST(RobotKind, WithTwoPartsOfOneNameIsRefused) {
  RobotKind kind = crab();
  kind.add(OtherWinchPart{});
  EXPECT_THAT(error_of(kind), HasSubstr("the robot 'crab', which has a part 'winch' twice; leave one of them out, or "
                                        "give it another name"));
}

TEST(RobotKind, WithAPartThatNoReadingCanTellIsRefused) {
  RobotKind kind = crab();
  kind.part<ProximityPart>()->mounts.clear();
  EXPECT_THAT(error_of(kind), HasSubstr("has a part 'proximity' that has no mounts; give it at least one"));
  kind.part<ProximityPart>()->mounts.resize(25);
  EXPECT_THAT(error_of(kind), HasSubstr("has 25 mounts, where a reading or command holds 24; leave some out"));
}

TEST(RobotKind, WithWheelsInOnePlaceIsRefused) {
  RobotKind kind = crab();
  kind.locomotion = DifferentialDrive{};
  EXPECT_THAT(error_of(kind), HasSubstr("give its differential_drive a wheel_base above 0"));
}

TEST(RobotKind, TellsEveryFactWithItsSource) {
  RobotKind kind = epuck::kind();
  FactWriter facts;
  kind.describe(facts);
  EXPECT_THAT(facts.text(), HasSubstr("radius: 0.035 m"));
  EXPECT_THAT(facts.text(), HasSubstr("wheel_base: 0.053 m"));
  EXPECT_THAT(facts.text(), HasSubstr("mount 7: bearing 17 deg x 0.03347"));
  EXPECT_THAT(facts.text(), HasSubstr("source: wheel radius: GCtronic's wiki"));
  for (const AnyPart& part : kind.parts()) EXPECT_THAT(facts.text(), HasSubstr(std::string(part.name()) + ": "));
}

TEST(RobotKind, OfTandemHasASourceForEveryPart) {
  Catalog catalog;
  ASSERT_TRUE(catalog.add_from("tandem", register_robots).ok());
  for (const RobotKind* known : catalog.all<RobotKind>()) {
    RobotKind kind = *known;
    FactWriter facts;
    kind.describe(facts);
    EXPECT_THAT(facts.text(), testing::Not(HasSubstr("source: \n"))) << kind.name;
    std::size_t sources = 0;
    for (std::size_t at = 0; (at = facts.text().find("source: ", at)) != std::string::npos; ++at) ++sources;
    EXPECT_EQ(sources, kind.parts().size() + 2) << kind.name;
  }
}

}  // namespace
}  // namespace tandem::hal
