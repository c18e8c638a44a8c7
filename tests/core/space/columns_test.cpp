// State that is kept for robots whose devices need it, and for no others.
#include "core/space/columns.hpp"

#include <gmock/gmock.h>

#include "core/space/mechanisms.hpp"
#include "hal/robot/epuck.hpp"
#include "hal/robot/footbot.hpp"
#include "tests/core/space_by_hand.hpp"

namespace tandem::core {
namespace {

using testing::HasSubstr;

/// A turret as another library might see it.
struct OtherTurret {
  static constexpr std::string_view kName = TurretState::kName;
  static constexpr std::string_view kDoc = "";
  double angle_rad = 0.0;
  void describe(hal::FieldList& f) const { f.add("angle", angle_rad, hal::unit::rad, ""); }
};

TEST(Columns, AreOneForEachName) {
  Columns columns;
  const auto first = columns.of(hal::row_type<TurretState>());
  ASSERT_TRUE(first.ok());
  EXPECT_EQ(columns.of(hal::row_type<TurretState>()).value(), first.value());
  EXPECT_NE(columns.of(hal::row_type<GripState>()).value(), first.value());
  EXPECT_EQ(columns.all().size(), 2U);
}

TEST(Columns, OfOneNameAndTwoLayoutsAreRefused) {
  Columns columns;
  ASSERT_TRUE(columns.of(hal::row_type<TurretState>()).ok());
  const auto other = columns.of(hal::row_type<OtherTurret>());
  ASSERT_FALSE(other.ok());
  EXPECT_THAT(other.error().message, HasSubstr("'turret'"));
}

TEST(Columns, HaveRowsForRobotsThatNeedThemAlone) {
  Space space;
  const RobotId plain = add_robot(space, hal::epuck::kind(), "ep", 0.0, 0.0, 0.0);
  const RobotId turning = add_robot(space, hal::footbot::kind(), "fb", 1.0, 0.0, 0.0);
  add_state<TurretState>(space, turning).angle_rad = 0.5;
  EXPECT_EQ(space.state<TurretState>(plain), nullptr);
  EXPECT_EQ(space.turret_rad(plain), 0.0);
  EXPECT_EQ(space.turret_rad(turning), 0.5);
  const SpaceStores& s = space.stores();
  const Column<TurretState> column = space.stores().columns.of<TurretState>();
  EXPECT_EQ(s.state_of(column, s.row_of(plain)), nullptr);
  EXPECT_EQ(s.state_of(column, s.row_of(turning))->angle_rad, 0.5);
  EXPECT_TRUE(space.stores().columns.of<GripState>().empty());
}

TEST(Columns, StartRobotsAsTheirDeviceSays) {
  Space space;
  const RobotId robot = add_robot(space, hal::epuck::kind(), "ep", 0.0, 0.0, 0.0);
  ChargeState& state = add_state<ChargeState>(space, robot);
  EXPECT_EQ(state.charge, 0.0);
  KeptColumn full = keeps(ChargeState{0.75});
  full.arrays = space.stores().columns.of(*full.type).value();
  full.start(0, 0);
  EXPECT_EQ(state.charge, 0.75);
}

}  // namespace
}  // namespace tandem::core
