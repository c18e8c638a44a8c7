// A hub of many robots of all kinds that freezes and is killed while some of them cannot be reached: how soon each has
// its safe command. TANDEM_MANY_ROBOTS=50 holds it to the bounds of tests/README.md; the small run is generous, since
// it shares the machine.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <gmock/gmock.h>
#include <sched.h>

#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

constexpr long long kMs = 1'000'000;

long long monotonic_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<long long>(t.tv_sec) * 1000 * kMs + t.tv_nsec;
}

/// As `eventually`, but logs of many robots are not read all the time.
bool in_the_end(const std::function<bool()>& condition, double seconds) {
  return eventually(
      [&] {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
        return false;
      },
      seconds);
}

/// Since when it has been told to rest; -1: it has not.
long long rests_since(const EmulatedRobot& robot) {
  long long since = -1;
  for (const auto& w : robot.wheels()) {
    if (w.left != 0 || w.right != 0) {
      since = -1;
    } else if (since < 0) {
      since = w.t_ns;
    }
  }
  return since;
}

std::string robot_element(const std::string& kind, const std::string& id, double x, double y,
                          const std::string& controller, const std::string& bridge) {
  return "<" + kind + " id=\"" + id + "\"><body position=\"" + std::to_string(x) + "," + std::to_string(y) +
         ",0\"/><controller config=\"" + controller + "\"/><bridge link=\"" + bridge + "\"/></" + kind + ">";
}

/// One on wheels, in a folder and a process of its own.
struct Roller {
  Folder folder;
  std::unique_ptr<EmulatedRobot> robot;
  bool reachable = true;
};

/// In a network of its own, where LCM reaches this program's children and nobody else.
class ManyRobots : public testing::Test {
 protected:
  void SetUp() override {
    const bool apart =
        ::unshare(CLONE_NEWNET) == 0 && std::system("ip link set lo up && ip route add 224.0.0.0/4 dev lo") == 0;
    if (!apart) GTEST_SKIP() << "this machine does not permit a network of its own (unshare, as root; iproute2)";
    ::setenv("XDG_RUNTIME_DIR", hub_folder.path().c_str(), 1);
    const char* wanted = std::getenv("TANDEM_MANY_ROBOTS");
    const int robots = wanted == nullptr ? 9 : std::max(9, std::atoi(wanted));
    strict = robots >= 50;
    flyers = std::max(3, robots / 5);
    const int rollers = robots - flyers;
    std::string elements;
    for (int i = 0; i < rollers; ++i) elements += add_roller(i, i < rollers / 2 ? "e-puck" : "foot-bot", rollers);
    add_flyers(elements);
    hub_folder.write("run.xml", experiment(elements));
  }

  std::string add_roller(int i, const std::string& kind, int rollers) {
    const int half = rollers / 2;
    const int in_kind = i < half ? i : i - half;
    Roller& r = *all.emplace_back(std::make_unique<Roller>());
    r.reachable = in_kind >= std::max(1, half / 5);
    const std::string id = (kind == "e-puck" ? "ep" : "fb") + std::to_string(in_kind);
    const double y = 0.6 * i - 0.3 * rollers;
    if (kind == "e-puck") {
      r.robot = std::make_unique<EmulatedEpuck>(r.folder);
      EXPECT_TRUE(r.robot->ready());
      return robot_element(kind, id, -30, y, i == half - 1 ? "f" : "d", "serial:" + (r.folder.path() / "ep0").string());
    }
    r.robot = std::make_unique<EmulatedFootbot>(r.folder);
    EXPECT_TRUE(r.robot->ready());
    return robot_element(kind, id, -30, y, "d",
                         "slcan:" + (r.folder.path() / "fb0").string() + "@1000000\" map=\"" +
                             std::string(test::kSourceDir) + "/configs/footbot_map.xml");
  }

  /// Those that cannot be reached have a process of their own, which emulates all places and serves the last ones.
  void add_flyers(std::string& elements) {
    const int mute = std::max(1, flyers / 5);
    near = std::make_unique<EmulatedEyebot>(
        near_folder, std::vector<std::string>{"--name", "eb0", "--count", std::to_string(flyers - mute)});
    far = std::make_unique<EmulatedEyebot>(
        far_folder, std::vector<std::string>{"--name", "ex0", "--count", std::to_string(flyers)});
    EXPECT_TRUE(near->ready() && far->ready());
    for (int i = 0; i < flyers; ++i) {
      const bool reachable = i < flyers - mute;
      const std::string id = (reachable ? "eb" : "ex") + std::to_string(i);
      (reachable ? near_names : far_names).push_back(id);
      elements += robot_element("eye-bot", id, 2.0 * (i % 5), 2.0 * (i / 5), "h", EmulatedEyebot::kLink);
    }
  }

  static std::string experiment(const std::string& robots) {
    const std::string drives =
        "<actuators><differential_steering/></actuators><sensors/><params left=\"3 cm/s\" right=\"3 cm/s\"/>";
    return "<tandem><framework><experiment length=\"0\" ticks_per_second=\"10\" random_seed=\"1\"/><time "
           "mode=\"realtime\"/></framework><controllers><drive id=\"d\" library=\"test_controllers\">" +
           drives + "</drive><forker id=\"f\" library=\"test_controllers\">" + drives +
           "</forker><eyebot_hover id=\"h\" library=\"eyebot_hover\"><actuators><quadrotor_position/><flight_task/>"
           "</actuators><sensors><positioning/><flight_state/><clock/></sensors><params height=\"1.5 m\" "
           "offset=\"1,0,0\" duration=\"600 s\"/></eyebot_hover></controllers><arena size=\"80,80,4\" "
           "center=\"0,0,2\">" +
           robots + "</arena><physics_engines><dynamics3d id=\"k\"/></physics_engines></tandem>";
  }

  static std::string mode_of(const EmulatedEyebot& crew, const std::string& name, long long* at = nullptr) {
    const auto changes = crew.lines("mode", {"\"robot\":\"" + name + "\""});
    if (changes.empty()) return "off";
    if (at != nullptr) *at = std::stoll(json_value(changes.back(), "t_ns"));
    return json_value(changes.back(), "to");
  }
  static bool fly(const EmulatedEyebot& crew, const std::vector<std::string>& names) {
    return std::all_of(names.begin(), names.end(),
                       [&](const std::string& name) { return mode_of(crew, name) == "position"; });
  }
  bool move(bool all_of_them) const {
    for (const auto& r : all) {
      if ((all_of_them || r->reachable) && !r->robot->moves()) return false;
    }
    return fly(*near, near_names) && (!all_of_them || fly(*far, far_names));
  }
  void reach(bool reachable) const {
    for (const auto& r : all) {
      if (!r->reachable) r->robot->signal(reachable ? SIGCONT : SIGSTOP);
    }
    far->signal(reachable ? SIGCONT : SIGSTOP);
  }

  /// The longest time from `since` until one of these robots had its safe command; none within 20 s: a failure.
  long long slowest_ms(bool reachable, long long since) const {
    long long slowest = 0;
    for (const auto& r : all) {
      if (r->reachable != reachable) continue;
      EXPECT_TRUE(in_the_end([&] { return rests_since(*r->robot) > 0; }, 20.0)) << r->folder.path();
      slowest = std::max(slowest, rests_since(*r->robot) - since);
    }
    const EmulatedEyebot& crew = reachable ? *near : *far;
    for (const std::string& name : reachable ? near_names : far_names) {
      EXPECT_TRUE(in_the_end([&] { return mode_of(crew, name) != "position"; }, 20.0)) << name;
      long long at = 0;
      for (const std::string& line : crew.lines("mode", {"\"robot\":\"" + name + "\"", R"("from":"position")"})) {
        at = std::stoll(json_value(line, "t_ns"));
      }
      slowest = std::max(slowest, at - since);
    }
    return slowest / kMs;
  }

  bool strict = false;
  int flyers = 0;
  Folder hub_folder, near_folder, far_folder;
  std::vector<std::unique_ptr<Roller>> all;
  std::unique_ptr<EmulatedEyebot> near, far;
  std::vector<std::string> near_names, far_names;
};

TEST_F(ManyRobots, HaveTheirSafeCommandSoonAfterTheirHubFrozeOrDied) {
  const long long generous = strict ? 1 : 4;
  Tandem first({"run", "run.xml"}, hub_folder.path());
  ASSERT_TRUE(in_the_end([&] { return move(true) || first.wait(0.0) != -1000; }, 90.0) && move(true)) << first.errors();

  reach(false);
  const long long frozen = monotonic_ns();
  first.signal(SIGSTOP);
  const long long freeze_ms = slowest_ms(true, frozen);
  first.signal(SIGCONT);
  reach(true);
  first.signal(SIGINT);  // each of its robots would wait for a person
  EXPECT_NE(first.wait(60.0), -1000) << first.errors();
  Tandem hub({"run", "run.xml"}, hub_folder.path());
  ASSERT_TRUE(in_the_end([&] { return move(true) || hub.wait(0.0) != -1000; }, 90.0) && move(true)) << hub.errors();

  reach(false);
  const long long killed = monotonic_ns();
  hub.signal(SIGKILL);
  const long long death_ms = slowest_ms(true, killed);
  const long long back = monotonic_ns();
  reach(true);
  const long long back_ms = slowest_ms(false, back);

  std::printf("%zu robots: safe %lld ms after a freeze, %lld ms after a death, %lld ms after being reachable again\n",
              all.size() + static_cast<std::size_t>(flyers), freeze_ms, death_ms, back_ms);
  EXPECT_LE(freeze_ms, 500 * generous);
  EXPECT_LE(death_ms, 250 * generous);
  EXPECT_LE(back_ms, 1000 * generous);
  hub.wait();
}

}  // namespace
}  // namespace tandem::scenarios
