// Hubs and guardians that are frozen, killed and woken in any order, and robots that are switched off and on, of four
// kinds; verdicts come from the robots' own logs. TANDEM_PAIR_ROBOTS=20 for five of each kind, TANDEM_PAIR_STORIES=N
// and TANDEM_ABSENCE_STORIES=N for N stories: after the first ones, which are written down here, drawn from
// TANDEM_PAIR_SEED.
#include <cstdlib>
#include <gmock/gmock.h>
#include <random>
#include <sched.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using testing::HasSubstr;

constexpr long long kMs = 1'000'000;
constexpr long long kAfterDeath_ns = 250 * kMs, kAfterFreeze_ns = 500 * kMs;
constexpr long long kDeadMan_ns = 750 * kMs;  // of a foot-bot (0.5 s) and a Thymio (0.7 s), and a beat of theirs
constexpr auto kTemptation = std::chrono::seconds(4);  // time in which a robot that is not held would drive on

int number_of(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::atoi(text);
}

enum class Who { Hub, Guardian };

struct Step {
  Who who;
  int signal;
  int after_ms;  ///< the step before
};

struct Story {
  std::string name;
  std::vector<Step> steps;
  /// From this step on somebody is there to stop the robots, and has this long for it; behind the last: nobody is.
  std::size_t stopped_from;
  long long promised_ns;
  bool may_rearm = false;  ///< at the end both live, and a person may have the robots drive on
};

std::vector<Story> stories() {
  std::vector<Story> all = {
      {"GuardianFrozenThenHubKilled", {{Who::Guardian, SIGSTOP, 0}, {Who::Hub, SIGKILL, 3000}}, 0, kAfterFreeze_ns},
      {"BothFrozenAndTheHubWakesFirst",
       {{Who::Hub, SIGSTOP, 0}, {Who::Guardian, SIGSTOP, 0}, {Who::Hub, SIGCONT, 4000}, {Who::Guardian, SIGCONT, 300}},
       2,
       kAfterFreeze_ns,
       true},
      {"BothFrozenAndTheGuardianWakesFirst",
       {{Who::Guardian, SIGSTOP, 0}, {Who::Hub, SIGSTOP, 0}, {Who::Guardian, SIGCONT, 1500}, {Who::Hub, SIGCONT, 300}},
       2,
       kAfterFreeze_ns,
       true},
      {"BothKilled", {{Who::Guardian, SIGSTOP, 0}, {Who::Hub, SIGKILL, 0}, {Who::Guardian, SIGKILL, 0}}, 3, 0},
      {"GuardianKilled", {{Who::Guardian, SIGKILL, 0}}, 0, kAfterDeath_ns},
      {"HubFrozenAndItsGuardianKilled",
       {{Who::Hub, SIGSTOP, 0}, {Who::Guardian, SIGKILL, 0}, {Who::Hub, SIGCONT, 1000}},
       2,
       kAfterFreeze_ns},
  };
  std::mt19937 chance(static_cast<unsigned>(number_of("TANDEM_PAIR_SEED", 1)));
  const auto wanted = static_cast<std::size_t>(std::max(1, number_of("TANDEM_PAIR_STORIES", 4)));
  while (all.size() < wanted) {  // both frozen for a while that is no lateness, in any order
    const bool hub_first = chance() % 2 == 0, hub_wakes_first = chance() % 2 == 0;
    const auto who = [](bool hub) { return hub ? Who::Hub : Who::Guardian; };
    const int frozen_ms = 600 + static_cast<int>(chance() % 3000), apart_ms = static_cast<int>(chance() % 60);
    const int alone_ms = static_cast<int>(chance() % 1000);
    all.push_back({"Drawn" + std::to_string(all.size()),
                   {{who(hub_first), SIGSTOP, 0},
                    {who(!hub_first), SIGSTOP, apart_ms},
                    {who(hub_wakes_first), SIGCONT, frozen_ms},
                    {who(!hub_wakes_first), SIGCONT, alone_ms}},
                   2,
                   kAfterFreeze_ns,
                   true});
  }
  all.resize(std::min(all.size(), wanted));
  return all;
}

/// One on wheels, in a folder and a process of its own.
struct Roller {
  std::string kind;
  Folder folder;
  std::unique_ptr<EmulatedRobot> robot;
  bool stops_by_itself() const { return kind != "e-puck"; }
  inline void switch_on(bool exchanged = false);
};

class EmulatedThymio : public EmulatedRobot {
 public:
  explicit EmulatedThymio(const Folder& folder) : EmulatedRobot(folder, "thymio", "pty:th0", {}) {}
};

/// With a log of its own; `exchanged`: another one of its kind, where an option makes one.
void Roller::switch_on(bool exchanged) {
  if (kind == "e-puck") {
    robot = std::make_unique<EmulatedEpuck>(
        folder, exchanged ? std::vector<std::string>{"--selector", "7"} : std::vector<std::string>{});
  } else if (kind == "foot-bot") {
    robot = std::make_unique<EmulatedFootbot>(folder);
  } else {
    robot = std::make_unique<EmulatedThymio>(folder);
  }
  EXPECT_TRUE(robot->ready());
}

/// In a network of its own, where LCM reaches this program's children and nobody else.
class FourKinds : public testing::Test {
 protected:
  void SetUp() override {
    static const bool apart =
        ::unshare(CLONE_NEWNET) == 0 && std::system("ip link set lo up && ip route add 224.0.0.0/4 dev lo") == 0;
    if (!apart) GTEST_SKIP() << "this machine does not permit a network of its own (unshare, as root; iproute2)";
    ::setenv("XDG_RUNTIME_DIR", hub_folder.path().c_str(), 1);
    flyers = std::max(1, number_of("TANDEM_PAIR_ROBOTS", 4) / 4);
    std::string elements;
    for (int i = 0; i < flyers; ++i) {
      for (const std::string kind : {"e-puck", "foot-bot", "thymio"}) elements += add_roller(kind, i);
      elements += robot("eye-bot", "eb" + std::to_string(i), 2.0 * i, 0.0, "h", EmulatedEyebot::kLink);
    }
    switch_flyers_on();
    hub_folder.write("run.xml", experiment(elements));
  }

  void switch_flyers_on() {
    eyebots = std::make_unique<EmulatedEyebot>(
        eyebot_folder, std::vector<std::string>{"--name", "eb0", "--count", std::to_string(flyers)});
    ASSERT_TRUE(eyebots->ready());
  }

  static std::string robot(const std::string& kind, const std::string& id, double x, double y,
                           const std::string& controller, const std::string& link) {
    return "<" + kind + " id=\"" + id + "\"><body position=\"" + std::to_string(x) + "," + std::to_string(y) +
           ",0\"/><controller config=\"" + controller + "\"/><bridge rearm=\"operator\" link=\"" + link + "\"/></" +
           kind + ">";
  }

  std::string add_roller(const std::string& kind, int i) {
    Roller& r = *rollers.emplace_back(std::make_unique<Roller>());
    r.kind = kind;
    const std::string number = std::to_string(i);
    const double x = -30.0, y = 0.6 * static_cast<double>(rollers.size());
    const auto device = [&r](const char* name) { return (r.folder.path() / name).string(); };
    r.switch_on();
    if (kind == "e-puck") return robot(kind, "ep" + number, x, y, "d", "serial:" + device("ep0"));
    if (kind == "foot-bot") {
      return robot(kind, "fb" + number, x, y, "d",
                   "slcan:" + device("fb0") + "@1000000\" map=\"" + test::kSourceDir + "/configs/footbot_map.xml");
    }
    return robot(kind, "th" + number, x, y, "d", "serial:" + device("th0"));
  }

  static std::string experiment(const std::string& robots) {
    return "<tandem><framework><experiment length=\"0\" ticks_per_second=\"20\" random_seed=\"1\"/><time "
           "mode=\"realtime\"/></framework><controllers><drive id=\"d\" library=\"test_controllers\"><actuators>"
           "<differential_steering/></actuators><sensors/><params left=\"3 cm/s\" right=\"3 cm/s\"/></drive>"
           "<eyebot_hover id=\"h\" library=\"eyebot_hover\"><actuators><quadrotor_position/><flight_task/>"
           "</actuators><sensors><positioning/><flight_state/><clock/></sensors><params height=\"1.5 m\" "
           "offset=\"1,0,0\" duration=\"600 s\"/></eyebot_hover></controllers><arena size=\"80,80,4\" "
           "center=\"0,0,2\">" +
           robots + "</arena><physics_engines><dynamics3d id=\"k\"/></physics_engines><desk lcm=\"" +
           std::string(EmulatedEyebot::kLink).substr(4) + "\"/></tandem>";
  }

  std::string mode_of(int flyer) const {
    const auto changes = eyebots->lines("mode", {"\"robot\":\"eb" + std::to_string(flyer) + "\""});
    return changes.empty() ? "off" : json_value(changes.back(), "to");
  }
  /// Flights by command that began after this time.
  std::size_t flights_since(long long since_ns) const {
    std::size_t count = 0;
    for (const std::string& line : eyebots->lines("mode", {R"("to":"position")"}))
      count += std::stoll(json_value(line, "t_ns")) > since_ns ? 1 : 0;
    return count;
  }
  bool all_move() const {
    for (const auto& r : rollers) {
      if (!r->robot->moves()) return false;
    }
    for (int i = 0; i < flyers; ++i) {
      if (mode_of(i) != "position") return false;
    }
    return true;
  }
  bool come_to_move(Tandem& hub) const {
    return eventually([&] { return all_move() || hub.wait(0.0) != -1000; }, 60.0) && all_move();
  }

  /// @returns when each step was taken.
  std::vector<long long> tell(const Story& story, const Tandem& hub, pid_t guardian) const {
    std::vector<long long> at;
    for (const Step& step : story.steps) {
      std::this_thread::sleep_for(std::chrono::milliseconds(step.after_ms));
      step.who == Who::Hub ? hub.signal(step.signal) : void(kill(guardian, step.signal));
      at.push_back(monotonic_ns());
    }
    return at;
  }

  /// Each came to rest in time, counted from when somebody could stop it.
  void expect_rest(const Story& story, const std::vector<long long>& at) const {
    const bool stopped = story.stopped_from < at.size();
    for (const auto& r : rollers) {
      if (!stopped && !r->stops_by_itself()) continue;
      ASSERT_TRUE(eventually([&] { return r->robot->stands_since() > 0; }, 20.0)) << r->kind << r->robot->log();
      const long long stood = r->robot->stands_since();
      const bool by_itself = r->stops_by_itself() && (!stopped || stood < at[story.stopped_from]);
      if (!by_itself) {
        const long long from = at[story.stopped_from];
        EXPECT_TRUE(stood_within(story.promised_ns, *r->robot, from, std::max(stood, from))) << r->kind;
      }
      if (r->stops_by_itself()) {
        EXPECT_TRUE(stood_within(kDeadMan_ns, *r->robot, at.front(), stood)) << r->kind;
      }
    }
  }
  void expect_nobody_moves_since(long long since_ns) const {
    for (const auto& r : rollers) {
      for (const auto& w : r->robot->wheels())
        EXPECT_TRUE(w.t_ns <= since_ns || (w.left == 0 && w.right == 0)) << r->kind << " moved on";
    }
    EXPECT_EQ(flights_since(since_ns), 0U);
  }
  bool all_rest() const {
    for (const auto& r : rollers) {
      if (r->robot->moves()) return false;
    }
    for (int i = 0; i < flyers; ++i) {
      if (mode_of(i) == "position") return false;
    }
    return true;
  }

  /// A person re-arms each of them by its name.
  void rearm_each(const Tandem& hub) const {
    for (int i = 0; i < flyers; ++i) {
      for (const char* kind : {"ep", "fb", "th", "eb"}) {
        const auto armed = [&] {
          Tandem desk({"desk", EmulatedEyebot::kLink, "rearm", kind + std::to_string(i)}, hub_folder.path());
          return desk.wait() == 0;
        };
        EXPECT_TRUE(eventually(armed, 20.0)) << kind << i << ": " << hub.errors() << hub.threads();
      }
    }
  }

  int flyers = 0;
  Folder hub_folder, eyebot_folder;
  std::vector<std::unique_ptr<Roller>> rollers;
  std::unique_ptr<EmulatedEyebot> eyebots;
};
class FrozenPairs : public FourKinds, public testing::WithParamInterface<Story> {};
INSTANTIATE_TEST_SUITE_P(Stories, FrozenPairs, testing::ValuesIn(stories()),
                         [](const auto& story) { return story.param.name; });

TEST_P(FrozenPairs, LeaveNoRobotMovingUntilAPersonArmsIt) {
  const Story& story = GetParam();
  Tandem hub({"run", "run.xml"}, hub_folder.path());
  ASSERT_TRUE(come_to_move(hub)) << hub.errors();
  const pid_t guardian = hub.guardian();
  ASSERT_GT(guardian, 1);
  const auto at = tell(story, hub, guardian);
  expect_rest(story, at);
  if (story.stopped_from >= at.size()) {  // nobody is left: the next command tells of it, and stops them
    Tandem next({"preflight", "run.xml", "--wait", "1"}, hub_folder.path());
    EXPECT_TRUE(eventually([&] { return all_rest(); }, 20.0)) << next.errors();
    next.wait(60.0);
    EXPECT_THAT(next.errors(),
                HasSubstr("are both gone, and it had confirmed no stop. It was stopped now, and has confirmed that"));
    EXPECT_THAT(next.output(), HasSubstr("left behind"));
  }
  ASSERT_TRUE(eventually([&] { return all_rest(); }, 20.0));
  const long long rested = monotonic_ns();
  std::this_thread::sleep_for(kTemptation);
  expect_nobody_moves_since(rested);
  if (!story.may_rearm) return;
  hub.signal(SIGUSR1);  // re-arms all that are proved: their links were opened anew
  std::this_thread::sleep_for(kTemptation);
  expect_nobody_moves_since(rested);
  rearm_each(hub);
  EXPECT_TRUE(come_to_move(hub)) << "a person has armed each of them: " << hub.errors();
}

TEST_F(FourKinds, ThatWereSwitchedOffWaitForAPersonWhenTheyAreBack) {
  std::mt19937 chance(static_cast<unsigned>(number_of("TANDEM_PAIR_SEED", 1)));
  std::vector<int> away_ms = {300, 3000, 15'000, 60'000};  // how long; then drawn
  const auto wanted = static_cast<std::size_t>(std::max(1, number_of("TANDEM_ABSENCE_STORIES", 2)));
  while (away_ms.size() < wanted) away_ms.push_back(50 + static_cast<int>(chance() % 8000));
  away_ms.resize(wanted);
  Tandem hub({"run", "run.xml"}, hub_folder.path());
  ASSERT_TRUE(come_to_move(hub)) << hub.errors();
  for (const int away : away_ms) {
    SCOPED_TRACE(std::to_string(away) + " ms away");
    for (const auto& r : rollers) r->robot.reset();
    eyebots.reset();
    std::this_thread::sleep_for(std::chrono::milliseconds(away));
    for (const auto& r : rollers) r->switch_on(chance() % 2 == 0);
    switch_flyers_on();
    std::this_thread::sleep_for(kTemptation);
    expect_nobody_moves_since(0);  // logs begin anew with their robots
    ASSERT_EQ(hub.wait(0.0), -1000) << hub.errors();
    rearm_each(hub);
    ASSERT_TRUE(come_to_move(hub)) << hub.errors();
  }
}

}  // namespace
}  // namespace tandem::scenarios
