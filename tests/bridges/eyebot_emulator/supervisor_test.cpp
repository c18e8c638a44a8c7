// The mode machine and the ladder of fail-safes as closed tables.
#include "bridges/eyebot_emulator/supervisor.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <map>

namespace tandem::bridges::eyebot_emulator {

void PrintTo(Mode mode, std::ostream* out) {
  *out << name_of(mode);
}
void PrintTo(Failsafe failsafe, std::ostream* out) {
  *out << name_of(failsafe);
}
void PrintTo(Verdict verdict, std::ostream* out) {
  *out << name_of(verdict);
}

namespace {

constexpr hal::TimeNs kSecond = hal::kNsPerSecond;
constexpr std::int32_t kHub = 7;
constexpr std::int32_t kOther = 8;

const Conditions kOnGround{};
const Conditions kInAir{.on_ground = false, .ceiling_seen = true, .height_m = 1.5};
const Conditions kAtCeiling{.on_ground = false, .at_ceiling = true, .ceiling_seen = true, .height_m = 2.0};

/// With a clock, and a hub that is in control.
struct Robot {
  Supervisor s;
  hal::TimeNs now = 100 * kSecond;

  Verdict order(Action action, std::int32_t session = kHub, float param = 0.0F) {
    return s.order(session, {static_cast<std::int8_t>(action), param}, now).verdict;
  }
  void see(const Conditions& c, bool hub_lives = true) {
    if (hub_lives) s.heartbeat(kHub, now);
    s.update(c, now);
  }
  /// The same for some seconds, looked at ten times a second.
  void see_for(const Conditions& c, int seconds, bool hub_lives) {
    for (int i = 0; i < 10 * seconds; ++i) {
      now += kSecond / 10;
      see(c, hub_lives);
    }
  }
};

const Conditions& usual(Mode mode) {
  return mode == Mode::Attached ? kAtCeiling : mode == Mode::Idle ? kOnGround : kInAir;
}

/// By the shortest way. Idle is armed.
Robot in(Mode mode) {
  Robot r;
  if (mode == Mode::Off) return r;
  r.s.power_on();
  r.see(kOnGround);
  r.order(Action::Arm);
  if (mode == Mode::Idle) return r;
  r.order(Action::TakeOff);
  if (mode == Mode::TakeOff) return r;
  r.see(kInAir);
  const std::map<Mode, Action> orders = {
      {Mode::Land, Action::Land}, {Mode::Attaching, Action::Attach}, {Mode::Estop, Action::Estop}};
  if (const auto found = orders.find(mode); found != orders.end()) r.order(found->second);
  if (mode == Mode::Position || mode == Mode::Velocity) (void)r.s.setpoint(kHub, mode, std::nullopt, r.now);
  if (mode == Mode::Attached || mode == Mode::Detaching) {
    r.order(Action::Attach);
    r.see(kAtCeiling);
  }
  if (mode == Mode::Detaching) r.order(Action::Detach);
  r.see(mode == Mode::Attached || mode == Mode::Detaching ? kAtCeiling : kInAir);
  return r;
}

constexpr std::array<Mode, kModes> kAllModes = {Mode::Off,      Mode::Idle,      Mode::TakeOff, Mode::Hover,
                                                Mode::Position, Mode::Velocity,  Mode::Land,    Mode::Attaching,
                                                Mode::Attached, Mode::Detaching, Mode::Estop};
/// A letter a mode, in the order of `kAllModes`.
constexpr std::string_view kLetters = "oithpvlgade";

Mode mode_of(char letter) {
  return kAllModes[kLetters.find(letter)];
}

TEST(ModeMachine, IsReachedInEveryMode) {
  for (const Mode mode : kAllModes) EXPECT_EQ(in(mode).s.mode(), mode);
}

// What becomes of every mode at every order: another mode, the same, or '.': refused.
TEST(ModeMachine, IsThisTable) {
  const std::vector<std::pair<Mode, std::string_view>> table = {
      // nop arm disarm takeoff hover land attach detach estop clear
      {Mode::Off, ".........."},       {Mode::Idle, "iiit.i..ei"},      {Mode::TakeOff, "tt.thl..et"},
      {Mode::Hover, "hh.hhlg.eh"},     {Mode::Position, "pp..hlg.ep"},  {Mode::Velocity, "vv..hlg.ev"},
      {Mode::Land, "ll..hl..el"},      {Mode::Attaching, "gg..hlg.eg"}, {Mode::Attached, "aaa...adea"},
      {Mode::Detaching, "dd..hl.ded"}, {Mode::Estop, "e.......ee"}};
  ASSERT_EQ(table.size(), kModes);
  for (const auto& [mode, row] : table) {
    for (int action = 0; action < 10; ++action) {
      Robot r = in(mode);
      const char expected = row[static_cast<std::size_t>(action)];
      const Verdict verdict = r.order(static_cast<Action>(action));
      const auto where =
          std::string(name_of(mode)) + " " + std::string(name_of_action(static_cast<std::int8_t>(action)));
      EXPECT_EQ(verdict, expected == '.' ? Verdict::RejectedMode : Verdict::Ok) << where;
      EXPECT_EQ(r.s.mode(), expected == '.' ? mode : mode_of(expected)) << where;
    }
  }
}

TEST(ModeMachine, TakesSetpointsInTheAirAlone) {
  for (const Mode mode : kAllModes) {
    for (const Mode setpoint : {Mode::Position, Mode::Velocity}) {
      Robot r = in(mode);
      const bool takes = mode == Mode::Hover || mode == Mode::Position || mode == Mode::Velocity;
      const Verdict verdict = r.s.setpoint(kHub, setpoint, std::nullopt, r.now).verdict;
      const Verdict otherwise = mode == Mode::Off ? Verdict::RejectedSource : Verdict::RejectedMode;
      EXPECT_EQ(verdict, takes ? Verdict::Ok : otherwise) << name_of(mode);
      EXPECT_EQ(r.s.mode(), takes ? setpoint : mode);
    }
  }
}

TEST(ModeMachine, RunsItsMotorsWhereItMust) {
  std::string running;
  for (const Mode mode : kAllModes) {
    if (in(mode).s.motors()) running += kLetters[static_cast<std::size_t>(mode)];
  }
  EXPECT_EQ(running, "thpvlgd");
}

TEST(ModeMachine, EndsWhatIsComplete) {
  Robot takes_off = in(Mode::TakeOff);
  takes_off.see({.on_ground = false, .height_m = 0.94});
  EXPECT_EQ(takes_off.s.mode(), Mode::TakeOff);
  takes_off.see({.on_ground = false, .height_m = 1.0});
  EXPECT_EQ(takes_off.s.mode(), Mode::Hover);

  Robot lands = in(Mode::Land);
  lands.see(kOnGround);
  EXPECT_EQ(lands.s.mode(), Mode::Idle);
  EXPECT_TRUE(lands.s.armed()) << "it was told to land, not to disarm";

  Robot attaches = in(Mode::Attaching);
  EXPECT_TRUE(attaches.s.magnet());
  attaches.see(kAtCeiling);
  EXPECT_EQ(attaches.s.mode(), Mode::Attached);
  EXPECT_TRUE(attaches.s.magnet());

  Robot detaches = in(Mode::Detaching);
  EXPECT_FALSE(detaches.s.magnet());
  detaches.see({.on_ground = false, .height_m = 1.75});
  EXPECT_EQ(detaches.s.mode(), Mode::Detaching);
  detaches.see({.on_ground = false, .height_m = 1.7});
  EXPECT_EQ(detaches.s.mode(), Mode::Hover);
}

TEST(ModeMachine, WantsACeilingToAttachTo) {
  Robot r = in(Mode::Hover);
  r.see({.on_ground = false, .ceiling_seen = false, .height_m = 1.5});
  EXPECT_EQ(r.order(Action::Attach), Verdict::Failed);
  EXPECT_EQ(r.s.mode(), Mode::Hover);
}

TEST(ModeMachine, TakesSpeedsThatAreSpeeds) {
  Robot r = in(Mode::Idle);
  EXPECT_EQ(r.order(Action::TakeOff, kHub, -0.1F), Verdict::RejectedRange);
  EXPECT_EQ(r.order(Action::TakeOff, kHub, std::numeric_limits<float>::quiet_NaN()), Verdict::RejectedRange);
  EXPECT_EQ(r.order(Action::TakeOff, kHub, std::numeric_limits<float>::infinity()), Verdict::RejectedRange);
  EXPECT_EQ(r.s.mode(), Mode::Idle);
  EXPECT_EQ(r.order(Action::TakeOff, kHub, 0.25F), Verdict::Ok);
  EXPECT_EQ(r.s.speed_m_s(), 0.25);
  Robot lands = in(Mode::Hover);
  lands.order(Action::Land);
  EXPECT_EQ(lands.s.speed_m_s(), 0.3) << "its own";
}

TEST(ModeMachine, KnowsNoOtherActions) {
  Robot r = in(Mode::Hover);
  for (const int action : {-128, -1, 10, 127}) {
    EXPECT_EQ(r.s.order(kHub, {static_cast<std::int8_t>(action), 0.0F}, r.now).verdict, Verdict::Unsupported);
  }
}

TEST(EmergencyStop, IsLeftByClearingAndDisarmingOnly) {
  Robot r = in(Mode::Estop);
  r.see(kOnGround);
  EXPECT_EQ(r.order(Action::Disarm), Verdict::RejectedMode);
  EXPECT_EQ(r.order(Action::Arm), Verdict::RejectedMode);
  EXPECT_EQ(r.order(Action::ClearFailsafe), Verdict::Ok);
  EXPECT_EQ(r.s.mode(), Mode::Estop);
  EXPECT_EQ(r.order(Action::Arm), Verdict::RejectedMode);
  EXPECT_EQ(r.order(Action::Disarm), Verdict::Ok);
  EXPECT_EQ(r.s.mode(), Mode::Idle);
  EXPECT_EQ(r.order(Action::TakeOff), Verdict::RejectedSource) << "nobody is in control";
}

TEST(EmergencyStop, IsNotLeftWhileItFalls) {
  Robot r = in(Mode::Estop);
  r.order(Action::ClearFailsafe);
  EXPECT_EQ(r.order(Action::Disarm), Verdict::RejectedMode);
  EXPECT_EQ(r.s.mode(), Mode::Estop);
}

TEST(EmergencyStop, ComesFromAnybodyAndAgain) {
  Robot r = in(Mode::Velocity);
  EXPECT_EQ(r.order(Action::Estop, kOther), Verdict::Ok);
  EXPECT_EQ(r.s.mode(), Mode::Estop);
  EXPECT_FALSE(r.s.armed());
  r.order(Action::ClearFailsafe);
  EXPECT_EQ(r.order(Action::Estop, kOther), Verdict::Ok);
  r.see(kOnGround);
  EXPECT_EQ(r.order(Action::Disarm), Verdict::RejectedMode) << "stopped again, to be cleared again";
}

TEST(EmergencyStop, LeavesTheMagnetOn) {
  Robot r = in(Mode::Attached);
  r.order(Action::Estop);
  EXPECT_TRUE(r.s.magnet());
  r.order(Action::ClearFailsafe);
  EXPECT_EQ(r.order(Action::Disarm), Verdict::Ok);
  EXPECT_EQ(r.s.mode(), Mode::Attached);
  EXPECT_TRUE(r.s.magnet());
  EXPECT_EQ(r.order(Action::Arm), Verdict::Ok);
  EXPECT_EQ(r.order(Action::Detach), Verdict::Ok);
}

TEST(Control, IsTheFirstHubsThatArms) {
  Robot r = in(Mode::Hover);
  EXPECT_EQ(r.s.controller(), kHub);
  for (const Action action : {Action::Arm, Action::Disarm, Action::TakeOff, Action::Hover, Action::Land, Action::Attach,
                              Action::Detach, Action::ClearFailsafe}) {
    EXPECT_EQ(r.order(action, kOther), Verdict::RejectedSource);
  }
  EXPECT_EQ(r.order(Action::Nop, kOther), Verdict::Ok);
  EXPECT_EQ(r.s.setpoint(kOther, Mode::Velocity, std::nullopt, r.now).verdict, Verdict::RejectedSource);
  EXPECT_EQ(r.s.mode(), Mode::Hover);
}

TEST(Control, IsGivenUpByDisarming) {
  Robot r = in(Mode::Idle);
  EXPECT_EQ(r.order(Action::Arm, kOther), Verdict::RejectedSource);
  EXPECT_EQ(r.order(Action::Disarm), Verdict::Ok);
  EXPECT_EQ(r.order(Action::TakeOff), Verdict::RejectedSource);
  EXPECT_EQ(r.order(Action::Arm, kOther), Verdict::Ok);
  EXPECT_EQ(r.s.controller(), kOther);
}

TEST(Control, IsLostAfterTenSecondsOfSilence) {
  Robot r = in(Mode::Hover);
  r.see_for(kInAir, 9, false);
  EXPECT_EQ(r.order(Action::Arm, kOther), Verdict::RejectedSource);
  r.see_for(kInAir, 1, false);
  EXPECT_EQ(r.s.controller(), 0);
  EXPECT_EQ(r.s.mode(), Mode::Land);
  EXPECT_EQ(r.order(Action::Arm, kOther), Verdict::Ok) << "in the air, to save it";
  EXPECT_EQ(r.order(Action::Hover, kOther), Verdict::RejectedMode) << "the fail-safe is latched";
  EXPECT_EQ(r.order(Action::ClearFailsafe, kOther), Verdict::Ok);
  EXPECT_EQ(r.order(Action::Hover, kOther), Verdict::Ok);
  EXPECT_EQ(r.s.mode(), Mode::Hover);
}

TEST(Control, IsKeptByHeartbeatsOfItsHubAlone) {
  Robot r = in(Mode::Hover);
  for (int i = 0; i < 30; ++i) {
    r.now += kSecond / 10;
    r.s.heartbeat(kOther, r.now);
    r.see(kInAir, false);
  }
  EXPECT_EQ(r.s.failsafe(), Failsafe::LinkLost);
}

// Conditions, in the order of the ladder, and what each makes of every mode.
struct Rung {
  const char* name;
  Failsafe failsafe;
  void (*worsen)(Robot&, Conditions);
  std::string_view becomes;  // of i t h p v l g a d
  bool latched;
};
const std::vector<Rung> kLadder = {
    {"hardware", Failsafe::Hardware, [](Robot& r, Conditions c) { c.hardware_fault = true, r.see(c); }, "illllllll",
     true},
    {"battery", Failsafe::LowBattery, [](Robot& r, Conditions c) { c.battery_critical = true, r.see(c); }, "illllllll",
     true},
    {"position", Failsafe::NoPosition, [](Robot& r, Conditions c) { c.position_valid = false, r.see(c); },
     "illlll"
     "lal",
     false},
    {"fence", Failsafe::Geofence, [](Robot& r, Conditions c) { c.inside_fence = false, r.see(c); }, "ihhhhlhah", true},
    {"link", Failsafe::LinkLost, [](Robot& r, Conditions c) { r.see_for(c, 2, false); }, "ihhhhlhah", true},
    {"link for long", Failsafe::LinkLost, [](Robot& r, Conditions c) { r.see_for(c, 10, false); }, "illllllal", true}};
constexpr std::string_view kRungModes = "ithpvlgad";

TEST(Ladder, IsThisTable) {
  for (const Rung& rung : kLadder) {
    for (std::size_t i = 0; i < kRungModes.size(); ++i) {
      const Mode mode = mode_of(kRungModes[i]);
      Robot r = in(mode);
      // What would complete the mode meanwhile is not shown.
      Conditions c = usual(mode);
      if (mode == Mode::TakeOff) c.height_m = 0.5;
      if (mode == Mode::Detaching) c = kAtCeiling;
      rung.worsen(r, c);
      EXPECT_EQ(r.s.mode(), mode_of(rung.becomes[i])) << rung.name << " in " << name_of(mode);
      const bool fence_at_rest = rung.failsafe == Failsafe::Geofence && (mode == Mode::Idle || mode == Mode::Attached);
      EXPECT_EQ(r.s.failsafe(), fence_at_rest ? Failsafe::None : rung.failsafe) << rung.name << " in " << name_of(mode);
    }
  }
}

TEST(Ladder, ReportsTheHighestOfTwo) {
  for (std::size_t high = 0; high < 5; ++high) {
    for (std::size_t low = high + 1; low < 5; ++low) {
      for (const bool high_first : {true, false}) {
        // All conditions of the second hold while the first is still seen.
        Robot r = in(Mode::Hover);
        Conditions c = kInAir;
        const auto add = [&](std::size_t i) {
          if (i == 0) c.hardware_fault = true;
          if (i == 1) c.battery_critical = true;
          if (i == 2) c.position_valid = false;
          if (i == 3) c.inside_fence = false;
          r.see_for(c, 3, i != 4);
        };
        add(high_first ? high : low);
        add(high_first ? low : high);
        EXPECT_EQ(r.s.failsafe(), kLadder[high].failsafe) << kLadder[high].name << " and " << kLadder[low].name;
        const bool lands = high < 3;
        EXPECT_EQ(r.s.mode(), lands ? Mode::Land : Mode::Hover) << kLadder[high].name << " and " << kLadder[low].name;
      }
    }
  }
}

TEST(Ladder, LandsAtTheFenceWhenTheHubIsGone) {
  Robot r = in(Mode::Hover);
  Conditions c = kInAir;
  c.inside_fence = false;
  r.see_for(c, 10, false);
  EXPECT_EQ(r.s.failsafe(), Failsafe::Geofence) << "the higher one is told";
  EXPECT_EQ(r.s.mode(), Mode::Land) << "and the graver one is done";
}

TEST(Ladder, LatchesUntilItIsCleared) {
  for (const Rung& rung : kLadder) {
    Robot r = in(Mode::Hover);
    rung.worsen(r, kInAir);
    r.see_for(kInAir, 1, true);
    const bool gone = r.s.controller() == 0;
    EXPECT_EQ(r.s.failsafe(), rung.latched ? rung.failsafe : Failsafe::None) << rung.name;
    if (!rung.latched) continue;
    EXPECT_EQ(r.order(Action::ClearFailsafe, gone ? kOther : kHub), Verdict::Ok) << rung.name;
    EXPECT_EQ(r.s.failsafe(), Failsafe::None) << rung.name;
    r.see(kInAir);
    EXPECT_EQ(r.s.failsafe(), Failsafe::None) << rung.name;
  }
}

TEST(Ladder, IsNotClearedWhileTheCauseLasts) {
  const std::array<Conditions, 3> causes = {{{.hardware_fault = true, .on_ground = false, .height_m = 1.0},
                                             {.battery_critical = true, .on_ground = false, .height_m = 1.0},
                                             {.inside_fence = false, .on_ground = false, .height_m = 1.0}}};
  for (const Conditions& c : causes) {
    Robot r = in(Mode::Hover);
    r.see(c);
    const Failsafe failsafe = r.s.failsafe();
    EXPECT_NE(failsafe, Failsafe::None);
    EXPECT_EQ(r.order(Action::ClearFailsafe), Verdict::Failed);
    EXPECT_EQ(r.s.failsafe(), failsafe);
  }
  Robot unheard = in(Mode::Hover);
  unheard.see_for(kInAir, 3, false);
  EXPECT_EQ(unheard.order(Action::ClearFailsafe), Verdict::Failed) << "a hub whose heart does not beat";
}

TEST(Ladder, TakesNoFlightsWhileItHolds) {
  for (const Rung& rung : kLadder) {
    Robot r = in(Mode::Hover);
    rung.worsen(r, kInAir);
    if (r.s.controller() == 0) r.order(Action::Arm);
    EXPECT_EQ(r.s.setpoint(kHub, Mode::Velocity, std::nullopt, r.now).verdict, Verdict::RejectedMode) << rung.name;
    EXPECT_EQ(r.order(Action::Attach), Verdict::RejectedMode) << rung.name;
    EXPECT_EQ(r.order(Action::Land), Verdict::Ok) << rung.name;
    EXPECT_EQ(r.s.mode(), Mode::Land) << rung.name;
  }
  for (const Rung& rung : kLadder) {
    Robot r = in(Mode::Idle);
    r.order(Action::Disarm);
    rung.worsen(r, kOnGround);
    const bool matters = r.s.failsafe() != Failsafe::None;  // without a hub in control none is missed
    EXPECT_EQ(r.order(Action::Arm), matters ? Verdict::RejectedMode : Verdict::Ok) << rung.name;
  }
}

TEST(NoPosition, SinksBlindlyAndHoversWhenItKnowsAgain) {
  Robot r = in(Mode::Velocity);
  Conditions lost = kInAir;
  lost.position_valid = false;
  r.see(lost);
  EXPECT_TRUE(r.s.blind());
  EXPECT_EQ(r.s.speed_m_s(), 0.3);
  r.see(kInAir);
  EXPECT_EQ(r.s.mode(), Mode::Hover);
  EXPECT_EQ(r.s.failsafe(), Failsafe::None);
}

TEST(NoPosition, DoesNotStopALandingThatWasOrdered) {
  Robot r = in(Mode::Land);
  Conditions lost = kInAir;
  lost.position_valid = false;
  r.see(lost);
  r.see(kInAir);
  EXPECT_EQ(r.s.mode(), Mode::Land);
}

TEST(CommandTimeout, HoversAndEndsWithTheNextCommand) {
  for (const Mode mode : {Mode::Velocity, Mode::Position}) {
    Robot r = in(Mode::Hover);
    ASSERT_TRUE(r.s.setpoint(kHub, mode, r.now + kSecond / 2, r.now).ok());
    r.now += kSecond / 2 - 1;
    r.see(kInAir);
    EXPECT_EQ(r.s.mode(), mode);
    r.now += 1;
    r.see(kInAir);
    EXPECT_EQ(r.s.mode(), Mode::Hover);
    EXPECT_EQ(r.s.failsafe(), Failsafe::CommandTimeout);
    ASSERT_TRUE(r.s.setpoint(kHub, mode, r.now + kSecond / 2, r.now).ok());
    EXPECT_EQ(r.s.failsafe(), Failsafe::None);
    EXPECT_EQ(r.s.mode(), mode);
  }
}

TEST(CommandTimeout, EndsWithAnyFlightOrder) {
  for (const Action action : {Action::Hover, Action::Land, Action::Attach, Action::TakeOff}) {
    Robot r = in(Mode::Hover);
    (void)r.s.setpoint(kHub, Mode::Velocity, r.now + 1, r.now);
    r.now += 1;
    r.see(kInAir);
    ASSERT_EQ(r.s.failsafe(), Failsafe::CommandTimeout);
    EXPECT_EQ(r.order(action), Verdict::Ok);
    EXPECT_EQ(r.s.failsafe(), Failsafe::None);
  }
}

TEST(CommandTimeout, EndsWithTheNextArmingOnTheGround) {
  Robot r = in(Mode::Hover);
  (void)r.s.setpoint(kHub, Mode::Velocity, r.now + 1, r.now);
  r.now += 1;
  r.see(kInAir);
  ASSERT_EQ(r.s.failsafe(), Failsafe::CommandTimeout);
  r.see_for(kInAir, 12, false);  // its hub is gone: it lands
  r.see_for(kOnGround, 1, false);
  ASSERT_EQ(r.s.mode(), Mode::Idle);
  ASSERT_EQ(r.order(Action::ClearFailsafe), Verdict::Ok);
  EXPECT_EQ(r.order(Action::Arm), Verdict::Ok);
  EXPECT_EQ(r.s.failsafe(), Failsafe::None);
}

TEST(LinkLost, OnTheGroundDisarms) {
  Robot r = in(Mode::Idle);
  r.see_for(kOnGround, 10, false);
  EXPECT_EQ(r.s.mode(), Mode::Idle);
  EXPECT_FALSE(r.s.armed());
  EXPECT_EQ(r.s.controller(), 0);
}

TEST(LinkLost, LandsAndDisarms) {
  Robot r = in(Mode::Velocity);
  r.see_for(kInAir, 2, false);
  EXPECT_EQ(r.s.mode(), Mode::Hover);
  r.see_for(kInAir, 8, false);
  EXPECT_EQ(r.s.mode(), Mode::Land);
  r.see(kOnGround, false);
  EXPECT_EQ(r.s.mode(), Mode::Idle);
  EXPECT_FALSE(r.s.armed());
  EXPECT_EQ(r.s.failsafe(), Failsafe::LinkLost);
}

TEST(LinkLost, AtTheCeilingStaysThereForWhoeverComes) {
  Robot r = in(Mode::Attached);
  r.see_for(kAtCeiling, 60, false);
  EXPECT_EQ(r.s.mode(), Mode::Attached);
  EXPECT_TRUE(r.s.magnet());
  EXPECT_EQ(r.order(Action::Arm, kOther), Verdict::Ok);
  EXPECT_EQ(r.order(Action::Detach, kOther), Verdict::RejectedMode);
  EXPECT_EQ(r.order(Action::ClearFailsafe, kOther), Verdict::Ok);
  EXPECT_EQ(r.order(Action::Detach, kOther), Verdict::Ok);
}

}  // namespace
}  // namespace tandem::bridges::eyebot_emulator
