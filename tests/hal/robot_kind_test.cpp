#include "hal/robot_kind.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

#include "hal/device/body_sensors.hpp"
#include "hal/device/ports.hpp"
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

TEST(RobotKind, WithAResponseThatCannotBeInvertedIsRefused) {
  RobotKind kind = crab();
  kind.part<ProximityPart>()->response = {{0.0, 100.0}, {0.1, 50.0}, {0.1, 20.0}};
  EXPECT_THAT(error_of(kind), HasSubstr("point 2 is not farther, with fewer counts, than the one before"));
}

TEST(PartType, MakesAPartWithTheDefaultsOfItsClass) {
  Catalog catalog;
  ASSERT_TRUE(catalog.add_from("library 'crab.so'", [](Registrar& r) { r.add(part_type<WinchPart>()); }).ok());
  const auto* const type = catalog.find<PartType>("winch");
  ASSERT_NE(type, nullptr);
  EXPECT_EQ(type->summary, "Pulls a rope.");
  RobotKind kind = crab();
  EXPECT_TRUE(kind.remove("winch"));
  EXPECT_FALSE(kind.remove("winch"));
  kind.add(type->make());
  ASSERT_NE(kind.part<WinchPart>(), nullptr);
  EXPECT_EQ(kind.part<WinchPart>()->force_N, 0.0);
}

TEST(PartType, IsThereForEveryPartOfTandemsRobots) {
  Catalog catalog;
  ASSERT_TRUE(catalog.add_from("tandem", register_robots).ok());
  ASSERT_TRUE(catalog.add_from("ports", register_ports).ok());
  for (const RobotKind* kind : catalog.all<RobotKind>()) {
    for (const AnyPart& part : kind->parts())
      EXPECT_NE(catalog.find<PartType>(part.name()), nullptr) << kind->name << ": " << part.name();
  }
  for (const PartType* type : catalog.all<PartType>()) {
    EXPECT_EQ(type->make().name(), type->name);
    EXPECT_EQ(type->make().doc(), type->summary);
  }
}

/// The mounts of a proximity element with these.
std::vector<Mount> mounts_of(const std::vector<std::vector<std::pair<std::string, std::string>>>& elements) {
  Element proximity{"proximity", "crab.xml", 3, {}, {}};
  for (const auto& attributes : elements) {
    Element& mount = proximity.children.emplace_back();
    mount.name = "mount";
    for (const auto& [name, value] : attributes) mount.attributes.push_back({name, value, 4});
  }
  ProximityPart part;
  Problems problems;
  ElementReader reader(proximity, problems);
  part.describe(reader);
  reader.finish();
  for (const Problem& p : problems) ADD_FAILURE() << to_text(p);
  return part.mounts;
}

TEST(Mount, OfAFileMayStandForARing) {
  const auto mounts =
      mounts_of({{{"bearing", "45"}, {"radius", "0.1"}, {"z", "0.02"}, {"count", "4"}}, {{"x", "0.01"}, {"z", "0.3"}}});
  ASSERT_EQ(mounts.size(), 5U);
  constexpr double kDiagonal_m = 0.07071067811865475;
  const double signs[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  const double degrees[4] = {45, 135, -135, -45};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(mounts[i].bearing_rad, degrees[i] * unit::deg.to_si, 1e-12) << i;
    EXPECT_NEAR(mounts[i].x_m, kDiagonal_m * signs[i][0], 1e-15) << i;
    EXPECT_NEAR(mounts[i].y_m, kDiagonal_m * signs[i][1], 1e-15) << i;
    EXPECT_EQ(mounts[i].z_m, 0.02);
  }
  EXPECT_EQ(mounts[4].x_m, 0.01);
  EXPECT_EQ(mounts[4].bearing_rad, 0.0);
}

TEST(Mount, OfARingBesideTheAxisGoesAroundTheAxis) {
  const auto mounts = mounts_of({{{"x", "0.03"}, {"y", "0.04"}, {"count", "2"}}});
  ASSERT_EQ(mounts.size(), 2U);
  EXPECT_NEAR(mounts[1].x_m, -0.03, 1e-15);
  EXPECT_NEAR(mounts[1].y_m, -0.04, 1e-15);
  EXPECT_NEAR(std::fabs(mounts[1].bearing_rad), std::numbers::pi, 1e-15);
}

TEST(Mount, TellsInItsManualThatItMayBeARing) {
  ManualWriter manual;
  ProximityPart part;
  part.describe(manual);
  EXPECT_THAT(manual.text(), HasSubstr("count=\"1\""));
  EXPECT_THAT(manual.text(), HasSubstr("radius=\"0 m\""));
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
