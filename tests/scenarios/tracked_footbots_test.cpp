// Emulated foot-bots that an emulated tracker sees, with a hub that fuses both: how far twins are from the truth, by
// the robots' own logs, and what robots do when trackers err.
#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <gmock/gmock.h>
#include <mutex>
#include <numbers>

#include "app/experiment/plugins.hpp"
#include "bridges/footbot_emulator/emulator.hpp"
#include "bridges/tracker_emulator/emulator.hpp"
#include "core/config/reader.hpp"
#include "mixed_reality/session/mixed_session.hpp"
#include "mixed_reality/settings/tracker_check.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/free_port.hpp"
#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {
namespace {

using hal::TimeNs;
using testing::HasSubstr;
namespace robot_emulator = bridges::footbot_emulator;
namespace tracker_emulator = bridges::tracker_emulator;

const std::atomic<bool> kGoOn{false};

struct Pose {
  TimeNs at_ns;
  double x_m, y_m, heading_rad;
};

double turn_between(double a_rad, double b_rad) {
  return std::remainder(a_rad - b_rad, 2.0 * std::numbers::pi);
}

/// A thread that emulates something, until its end.
template <class Options>
class Emulated {
 public:
  using Run = hal::Status (*)(const Options&, const std::atomic<bool>&);
  Emulated(Options options, Run run) : options_(std::move(options)) {
    options_.ready = [this](const std::string& text) {
      const std::lock_guard lock(mutex_);
      text_ = text;
      ready_.notify_all();
    };
    thread_ = std::thread([this, run] {
      const hal::Status ended = run(options_, stop_);
      EXPECT_TRUE(ended.ok()) << ended.error().message;
    });
    std::unique_lock lock(mutex_);
    EXPECT_TRUE(ready_.wait_for(lock, std::chrono::seconds(30), [this] { return !text_.empty(); }));
  }
  ~Emulated() {
    stop_ = true;
    thread_.join();
  }
  const std::string& text() const { return text_; }

 private:
  Options options_;
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::condition_variable ready_;
  std::string text_;
  std::thread thread_;
};

/// The hub, two foot-bots in circles at 0.2 m/s whose wheels are not as their kind says, and a tracker.
class Stage {
 public:
  struct Robot {
    std::string id;
    robot_emulator::Options options;
    std::mutex mutex;
    std::vector<Pose> truth;
    std::int64_t left = 0, right = 0;  // as last commanded
    TimeNs driven_ns = 0;              // when it was first told to move; 0: never
    std::vector<Pose> twin;
    std::unique_ptr<Emulated<robot_emulator::Options>> emulated;  // ends first: its thread writes the rest
  };

  Stage() : Stage({-2.0, -0.7, 0.0}, {2.0, -0.7, 0.0}, R"(left="0.18" right="0.22")") {}
  Stage(const bridges::BodyPose& start0, const bridges::BodyPose& start1, std::string speeds)
      : speeds_(std::move(speeds)) {
    add_robot("fb0", start0, 1.012, 0.99);
    add_robot("fb1", start1, 0.985, 1.008);
    port_ = free_port(SOCK_DGRAM);
  }
  /// Begins to see, of one kind of link and clock.
  void add_tracker(const std::string& id, const std::vector<std::string>& faults, const std::string& clock = "own",
                   int port = 0) {
    tracker_emulator::Options options;
    options.link = "udp:127.0.0.1:" + std::to_string(port == 0 ? port_ : port);
    options.faults = faults;
    options.log_file = folder_.path() / (id + ".log");
    options.clock = clock;
    options.form = trackers_.empty() ? "compact" : "json";
    options.seed = 7 + trackers_.size();
    for (const auto& robot : robots_) options.sees.emplace_back(robot->id, log_of(*robot));
    trackers_.push_back(std::make_unique<Emulated<tracker_emulator::Options>>(options, &tracker_emulator::run));
    elements_ += "<udp id=\"" + id + "\" port=\"" + std::to_string(port == 0 ? port_ : port) + "\" clock=\"" + clock +
                 "\" latency=\"60 ms\" sd=\"2 mm\" sd_heading=\"0.01\"/>";
  }
  void fault(std::size_t robot, const std::string& text) { robots_[robot]->options.faults.push_back(text); }
  void switch_robots_on() {
    for (auto& robot : robots_)
      robot->emulated = std::make_unique<Emulated<robot_emulator::Options>>(robot->options, &robot_emulator::run);
  }

  /// Runs for so long after a robot was first told to move; `each` is called after each tick.
  void run(double seconds, const std::function<void()>& each = {}) {
    constexpr double kUntilDriven_s = 60.0;
    run_until(
        seconds + kUntilDriven_s,
        [&] { return drive_ns() > 0 && ended_ns_ >= drive_ns() + static_cast<TimeNs>(seconds * 1e9); }, each);
    ASSERT_GT(drive_ns(), 0) << incidents();
  }
  /// For so long, or until `enough`.
  void run_until(double seconds, const std::function<bool()>& enough, const std::function<void()>& each) {
    core::Problems problems;
    scenario_ =
        core::read_experiment_text(experiment(), folder_.path() / "tracked.xml", {}, loader_.catalog(), problems);
    for (const core::Problem& p : problems) ADD_FAILURE() << hal::to_text(p);
    ASSERT_TRUE(scenario_);
    mixed_reality::check_trackers(*scenario_, loader_.catalog(), problems);
    auto world = core::World::make(*scenario_, loader_, {}, problems);
    for (const core::Problem& p : problems) ADD_FAILURE() << hal::to_text(p);
    ASSERT_TRUE(world);
    mixed_reality::MixedOptions options;
    options.make_tracker = [&](const core::TrackerItem& item) {
      return mixed_reality::make_tracker(loader_.catalog(),
                                         mixed_reality::tracker_request(*scenario_, loader_.catalog(), item), {});
    };
    auto made = mixed_reality::MixedSession::make(
        std::move(world),
        [&](const bridges::BridgeRequest& request) {
          return mixed_reality::make_bridge(loader_.catalog(), request, {});
        },
        time_, options);
    ASSERT_TRUE(made.ok()) << made.error().message;
    session_ = std::move(made).value();
    const hal::Status connected = session_->connect(kGoOn);
    ASSERT_TRUE(connected.ok()) << connected.error().message;
    std::atomic<bool> stop{false};
    const hal::Status ran = session_->run(static_cast<hal::Tick>(seconds * 10.0), stop, [&](core::World& w) {
      ended_ns_ = session_->now().monotonic_ns;
      for (auto& robot : robots_) {
        const core::Pose pose = w.space().pose(w.space().find_robot(robot->id));
        robot->twin.push_back({session_->now().monotonic_ns, pose.x_m, pose.y_m, pose.heading_rad()});
      }
      if (each) each();
      if (enough()) stop = true;
    });
    EXPECT_TRUE(ran.ok()) << ran.error().message;
    report_ = session_->report();
  }

  /// How near the middles of both came to each other, by their own logs.
  double nearest_m() {
    double nearest = 10.0;
    const std::scoped_lock lock(robots_[0]->mutex, robots_[1]->mutex);
    auto other = robots_[1]->truth.begin();
    for (const Pose& p : robots_[0]->truth) {
      while (other != robots_[1]->truth.end() && other->at_ns < p.at_ns) ++other;
      if (other == robots_[1]->truth.end()) break;
      nearest = std::min(nearest, std::hypot(other->x_m - p.x_m, other->y_m - p.y_m));
    }
    return nearest;
  }

  struct Error {
    double rms_m = 0.0, rms_rad = 0.0, most_m = 0.0;
    int count = 0;
  };
  /// Of a twin against the truth, between two times.
  Error error(std::size_t i, TimeNs from_ns, TimeNs until_ns) {
    Robot& robot = *robots_[i];
    const std::lock_guard lock(robot.mutex);
    Error e;
    for (const Pose& twin : robot.twin) {
      if (twin.at_ns < from_ns || twin.at_ns > until_ns) continue;
      const auto next = std::lower_bound(robot.truth.begin(), robot.truth.end(), twin.at_ns,
                                         [](const Pose& p, TimeNs t) { return p.at_ns < t; });
      if (next == robot.truth.begin() || next == robot.truth.end()) continue;
      const Pose &a = *std::prev(next), &b = *next;
      const double part = static_cast<double>(twin.at_ns - a.at_ns) / static_cast<double>(b.at_ns - a.at_ns);
      const double x_m = twin.x_m - (a.x_m + part * (b.x_m - a.x_m));
      const double y_m = twin.y_m - (a.y_m + part * (b.y_m - a.y_m));
      const double turn_rad =
          turn_between(twin.heading_rad, a.heading_rad + part * turn_between(b.heading_rad, a.heading_rad));
      e.rms_m += x_m * x_m + y_m * y_m;
      e.rms_rad += turn_rad * turn_rad;
      e.most_m = std::max(e.most_m, std::hypot(x_m, y_m));
      ++e.count;
    }
    if (e.count > 0) e.rms_m = std::sqrt(e.rms_m / e.count);
    if (e.count > 0) e.rms_rad = std::sqrt(e.rms_rad / e.count);
    return e;
  }
  bool stands(std::size_t i) {
    const std::lock_guard lock(robots_[i]->mutex);
    return robots_[i]->left == 0 && robots_[i]->right == 0;
  }
  std::string incidents() const {
    std::string all;
    for (const auto& robot : report_.robots) {
      for (const std::string& text : robot.incidents) all += text + "\n";
    }
    return all;
  }

  /// When the first robot was first told to move; 0: none was.
  TimeNs drive_ns() {
    TimeNs first = 0;
    for (auto& robot : robots_) {
      const std::lock_guard lock(robot->mutex);
      if (robot->driven_ns > 0 && (first == 0 || robot->driven_ns < first)) first = robot->driven_ns;
    }
    return first;
  }
  /// Of the last tick.
  TimeNs ended_ns() const { return ended_ns_; }
  /// When a tracker's fault began or ended; 0: it has not.
  TimeNs fault_ns(const std::string& tracker, const std::string& fault, const std::string& phase) const {
    const std::string log = text_of(folder_.path() / (tracker + ".log"));
    const std::size_t at = log.find("\"fault\":\"" + fault + "\",\"phase\":\"" + phase + "\"");
    return at == std::string::npos ? 0 : std::stoll(json_value(log, "t_ns", log.rfind('\n', at) + 1));
  }
  const mixed_reality::MixedReport& report() const { return report_; }
  mixed_reality::MixedSession& session() { return *session_; }

 private:
  std::string log_of(const Robot& robot) const { return folder_.path() / (robot.id + ".log"); }

  void add_robot(const std::string& id, const bridges::BodyPose& start, double left_scale, double right_scale) {
    auto robot = std::make_unique<Robot>();
    robot->id = id;
    robot->options.link = "tcp-listen:127.0.0.1:0";
    robot->options.log_file = log_of(*robot);
    robot->options.poses.start = start;
    robot->options.wheels.left = left_scale;
    robot->options.wheels.right = right_scale;
    robot->options.poses.poses_hz = 100.0;
    robot->options.events = [r = robot.get()](TimeNs at, std::string_view event, const bridges::EventFields& fields) {
      const std::lock_guard lock(r->mutex);
      if (event == "pose")
        r->truth.push_back({at, std::get<double>(fields[0].value), std::get<double>(fields[1].value),
                            std::get<double>(fields[2].value)});
      if (event != "wheels") return;
      for (const bridges::EventField& f : fields) {
        if (f.name == "left") r->left = std::get<std::int64_t>(f.value);
        if (f.name == "right") r->right = std::get<std::int64_t>(f.value);
      }
      if (r->driven_ns == 0 && (r->left != 0 || r->right != 0)) r->driven_ns = at;
    };
    robots_.push_back(std::move(robot));
  }

  std::string experiment() const {
    std::string text = R"(<tandem><framework><experiment length="0" ticks_per_second="10" random_seed="1"/>
<time mode="realtime"/></framework><controllers><drive id="d" library="test_controllers"><actuators><differential_steering/>
</actuators><params )" +
                       speeds_ + R"(/></drive></controllers><arena size="12,8,1">)";
    for (const auto& robot : robots_) {
      const bridges::BodyPose& start = robot->options.poses.start;
      text += "<foot-bot id=\"" + robot->id + "\"><body position=\"" + std::to_string(start.x_m) + "," +
              std::to_string(start.y_m) + ",0\" orientation=\"" +
              std::to_string(start.heading_rad * 180.0 / std::numbers::pi) +
              R"(,0,0"/><controller config="d"/><bridge rearm="after 0.5 s" link=")" + robot->emulated->text() +
              "\" map=\"" + test::kSourceDir + "/configs/footbot_map.xml\"/></foot-bot>";
    }
    return text + "</arena><trackers>" + elements_ +
           "</trackers><physics_engines><kinematics2d id=\"k\"/></physics_engines></tandem>";
  }

  std::string speeds_;  // of their wheels
  Folder folder_;
  int port_ = 0;
  std::vector<std::unique_ptr<Robot>> robots_;
  std::vector<std::unique_ptr<Emulated<tracker_emulator::Options>>> trackers_;
  std::string elements_;
  hal::PluginLoader loader_ = app::make_loader();
  std::optional<core::Scenario> scenario_;
  mixed_reality::MonotonicTime time_;
  std::unique_ptr<mixed_reality::MixedSession> session_;
  mixed_reality::MixedReport report_;
  TimeNs ended_ns_ = 0;
};

constexpr TimeNs seconds(double s) {
  return static_cast<TimeNs>(s * 1e9);
}

TEST(TrackedFootbots, HaveTwinsWithinMillimetresAndTwoCentimetresAfterTwoSecondsUnseen) {
  Stage stage;
  stage.switch_robots_on();
  stage.add_tracker("ceiling", {"lose=0.05", "gap@drive+23s+2s"});
  stage.run(27.0);
  const TimeNs gap_ns = stage.fault_ns("ceiling", "gap@drive+23s+2s", "begin");
  ASSERT_GT(gap_ns, 0);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto seen = stage.error(i, stage.drive_ns() + seconds(7.0), gap_ns);
    const auto unseen = stage.error(i, gap_ns, gap_ns + seconds(2.0));
    RecordProperty("seen_mm_" + std::to_string(i), std::to_string(seen.rms_m * 1e3));
    std::printf("robot %zu: seen %.2f mm RMS, %.2f mm at most, %.3f degrees RMS (%d ticks); unseen for 2 s: %.2f mm\n",
                i, seen.rms_m * 1e3, seen.most_m * 1e3, seen.rms_rad * 180.0 / std::numbers::pi, seen.count,
                unseen.most_m * 1e3);
    EXPECT_GT(seen.count, 50);
    EXPECT_LE(seen.rms_m, 0.005);
    EXPECT_LE(seen.rms_rad, std::numbers::pi / 180.0);
    EXPECT_GT(unseen.count, 10);
    EXPECT_LE(unseen.most_m, 0.02);
    const auto& robot = stage.report().robots[i];
    ASSERT_TRUE(robot.sightings && robot.learnt);
    EXPECT_GT(robot.sightings->used, 400U);
    EXPECT_EQ(robot.sightings->jumps, 0U);
  }
  EXPECT_NEAR(stage.report().robots[0].learnt->left, 1.012, 0.01);
  EXPECT_NEAR(stage.report().robots[0].learnt->right, 0.99, 0.01);
  EXPECT_GT(stage.report().trackers.at(0).heard.messages, 500U);
}

TEST(TrackedFootbots, ThatAreDrivenAtOneAnotherStandApartAlthoughTheirPosesAreLateAndNoisy) {
  constexpr double kRadius_m = 0.085036758;
  Stage stage({-0.7, 0.0, 0.0}, {0.7, 0.02, std::numbers::pi}, R"(left="0.2" right="0.2")");
  stage.switch_robots_on();
  stage.add_tracker("ceiling", {"lose=0.05"});
  stage.run(8.0);
  const double gap_m = stage.nearest_m() - 2.0 * kRadius_m;
  std::printf("%.1f mm between them\n", gap_m * 1e3);
  EXPECT_GT(gap_m, 0.0);
  EXPECT_LT(gap_m, 0.1) << stage.incidents();
  for (const auto& robot : stage.report().robots) EXPECT_GT(robot.counts.barrier.changed_ticks, 5U);
}

TEST(TrackedFootbots, AreFoundAgainWhenSomebodyCarriesThem) {
  Stage stage;
  stage.fault(0, "carry=0.5:0.3:40@drive+10s");
  stage.switch_robots_on();
  stage.add_tracker("ceiling", {});
  stage.run(14.0);
  EXPECT_EQ(stage.report().robots[0].sightings->jumps, 1U);
  EXPECT_EQ(stage.report().robots[1].sightings->jumps, 0U);
  EXPECT_EQ(stage.report().robots[0].state, "moved by something else; waits to be re-armed") << stage.incidents();
  EXPECT_EQ(stage.report().robots[1].state, "driving") << stage.incidents();
  const TimeNs end_ns = stage.ended_ns();
  EXPECT_LE(stage.error(0, end_ns - seconds(1.0), end_ns).rms_m, 0.02);
}

TEST(TrackedFootbots, StandWhereTheirWheelsTurnAndTheyDoNotMove) {
  Stage stage;
  stage.fault(0, "held@drive+8s");
  stage.switch_robots_on();
  stage.add_tracker("ceiling", {});
  stage.run(18.0);
  EXPECT_GE(stage.report().robots[0].counts.stops, 1U) << stage.incidents();
  EXPECT_EQ(stage.report().robots[1].counts.stops, 0U);
  const TimeNs end_ns = stage.ended_ns();
  EXPECT_LE(stage.error(0, end_ns - seconds(1.0), end_ns).most_m, 0.15) << "the twin stays where the robot is";
}

TEST(TrackedFootbots, StandAsLongAsTwoTrackersDisagree) {
  Stage stage;
  stage.switch_robots_on();
  stage.add_tracker("ceiling", {});
  stage.add_tracker("wall", {"shift=0.3@drive+6s"}, "monotonic", free_port(SOCK_DGRAM));
  bool stood = false;
  stage.run(14.0, [&] { stood = stage.stands(0) && stage.stands(1); });
  EXPECT_TRUE(stood);
  EXPECT_THAT(stage.incidents(), HasSubstr("'fb0' at "));
  EXPECT_THAT(stage.incidents(), HasSubstr("trackers disagree"));
  for (const auto& robot : stage.report().robots) {
    EXPECT_GT(robot.sightings->disputed, 0U);
    EXPECT_FALSE(robot.driving);
  }
}

TEST(TrackedFootbots, StandWhenTheTrackerBecomesAMirrorUntilSomebodyRearmsThem) {
  Stage stage;
  stage.switch_robots_on();
  stage.add_tracker("ceiling", {"mirror@drive+6s"});
  bool stood = false;
  stage.run(24.0, [&] { stood = stage.stands(0) && stage.stands(1); });
  EXPECT_TRUE(stood) << stage.incidents();
  for (const auto& robot : stage.report().robots) {
    EXPECT_FALSE(robot.driving) << stage.incidents();
    EXPECT_EQ(robot.counts.stops, 1U) << "nobody has re-armed it";
  }
}

TEST(TrackedFootbots, StandWhenTheirTagsChangePlaces) {
  Stage stage;
  stage.switch_robots_on();
  stage.add_tracker("ceiling", {"swap=1@drive+7s"});
  stage.run(12.0);
  for (const auto& robot : stage.report().robots) {
    EXPECT_GE(robot.sightings->jumps, 1U);
    EXPECT_EQ(robot.counts.stops, 1U) << "nobody has re-armed it";
    EXPECT_FALSE(robot.driving) << stage.incidents();
  }
}

TEST(TrackedFootbots, DriveOnThroughLostDoubledSwappedLateAndDamagedMessagesAndAClockThatIsSet) {
  Stage stage;
  stage.switch_robots_on();
  stage.add_tracker("ceiling",
                    {"lose=0.05", "double=0.05", "swap=0.02", "late=0.05", "garbage=0.02", "clock=1h@drive+10s"});
  stage.run(18.0);
  const auto& tracker = stage.report().trackers.at(0);
  EXPECT_GT(tracker.heard.malformed, 0U);
  EXPECT_GE(tracker.clock_jumps, 1U);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& robot = stage.report().robots[i];
    EXPECT_GT(robot.sightings->doubled, 0U);
    EXPECT_GT(robot.sightings->gated, 0U) << "swapped";
    EXPECT_EQ(robot.sightings->jumps, 0U) << stage.incidents();
    EXPECT_EQ(robot.counts.stops, 0U) << stage.incidents();
    EXPECT_LE(stage.error(i, stage.drive_ns() + seconds(7.0), stage.ended_ns()).rms_m, 0.008);
  }
}

TEST(TrackedFootbots, DoNotMoveBeforeATrackerHasFoundThem) {
  Stage stage;
  stage.switch_robots_on();
  stage.add_tracker("ceiling", {"gap@0s"});
  bool moved = false;
  stage.run_until(
      4.0, [] { return false; }, [&] { moved = moved || !stage.stands(0) || !stage.stands(1); });
  EXPECT_FALSE(moved);
  EXPECT_THAT(stage.incidents(), HasSubstr("pose unknown"));
}

TEST(TrackedFootbots, AreRunByTheCommandsThatAUserTypes) {
  Folder folder;
  const std::string port = std::to_string(free_port(SOCK_DGRAM));
  EmulatedFootbot footbot(folder, {"--poses", "50", "--left_wheel", "1.01"});
  ASSERT_TRUE(footbot.ready());
  Tandem tracker(
      {"emulate", "tracker", "--link", "udp:127.0.0.1:" + port, "--sees", "12=witness.jsonl", "--rate", "20"},
      folder.path());
  folder.write(
      "tracked.xml",
      R"(<tandem><framework><experiment length="6" ticks_per_second="10"/></framework><controllers>
<drive id="d" library="test_controllers"><actuators><differential_steering/></actuators><params left="0.1" right="0.1"/></drive>
</controllers><arena size="4,4,1"><foot-bot id="fb0"><body position="0.5,0.5,0"/><controller config="d"/><bridge link=")" +
          footbot.link() + R"(" map=")" + test::kSourceDir + R"(/configs/footbot_map.xml"/><tracker id="12"/></foot-bot>
</arena><trackers><udp port=")" +
          port + R"(" latency="60 ms"/></trackers><physics_engines><kinematics2d id="k"/></physics_engines></tandem>)");
  Tandem run({"run", "tracked.xml", "--report", "r.json"}, folder.path());
  ASSERT_EQ(run.wait(60), 0) << run.errors();
  const std::string report = text_of(folder.path() / "r.json");
  EXPECT_EQ(json_value(report, "pose_source"), "fused") << report;
  EXPECT_GT(std::stoi(json_value(report, "used")), 50) << report;
  EXPECT_TRUE(footbot.has_moved());
  EXPECT_FALSE(footbot.moves());
}

/// The last pose that a log tells.
Pose last_pose(const std::string& log) {
  const std::string line = log.substr(log.rfind("{\"t_ns\"", log.rfind("\"event\":\"pose\"")));
  return {0, std::stod(json_value(line, "x_m")), std::stod(json_value(line, "y_m")),
          std::stod(json_value(line, "heading_rad"))};
}

TEST(TrackedFootbots, AreSeenByACameraThatTakesFramesOfTheirTags) {
  Folder folder;
  folder.write("camera.json", R"({"lens":{"size_px":[640,480],"focal_px":[450,452],"centre_px":[325,236],
"distortion":[-0.15,0.03,0.0004,-0.0003,0],"residual_px":0.1,"views":20},"arena":{"position_m":[0.4,0.1,1.6],
"quaternion_wxyz":[0.02,0.9995,0.02,0.01]}})");
  EmulatedFootbot footbot(folder, {"--poses", "100", "--left_wheel", "1.01", "--x", "0.1", "--y", "0.2"});
  ASSERT_TRUE(footbot.ready());
  Tandem camera(
      {"emulate", "tracker", "--link", "pipe:frames", "--camera", "camera.json", "--sees", "12=witness.jsonl", "--rate",
       "12", "--tag_size", "10cm", "--tag_height", "0.2", "--log", "camera.jsonl", "--fault", "mirror@drive+1s+0.5s"},
      folder.path());
  folder.write("tagged.xml",
               R"(<tandem><framework><experiment length="0" ticks_per_second="10"/></framework><controllers>
<drive id="d" library="test_controllers"><actuators><differential_steering/></actuators><params left="0.08" right="0.1"/></drive>
</controllers><arena size="4,4,1"><foot-bot id="fb0"><body position="0,0,0"/><controller config="d"/><bridge link=")" +
                   footbot.link() + R"(" map=")" + test::kSourceDir +
                   R"(/configs/footbot_map.xml"/><tracker id="12" height="0.2"/></foot-bot>
</arena><trackers><apriltag frames="pipe:frames" camera="camera.json" size="10 cm" clock="own" latency="60 ms"/></trackers>
<physics_engines><kinematics2d id="k"/></physics_engines></tandem>)");
  Tandem check({"check", "tagged.xml"}, folder.path());
  ASSERT_EQ(check.wait(60), 0) << check.errors();
  EXPECT_THAT(check.output(), HasSubstr("pixels along a side"));
  Tandem run({"run", "tagged.xml", "--report", "r.json"}, folder.path());
  const auto has_mirrored = [&] {
    return text_of(folder.path() / "camera.jsonl").find(R"("phase":"end")") != std::string::npos;
  };
  ASSERT_TRUE(eventually(has_mirrored, 60.0)) << run.errors();
  // And 25 cm further, which takes less than three seconds.
  const Pose then = last_pose(footbot.log());
  const auto is_further = [&] {
    const Pose now = last_pose(footbot.log());
    return std::hypot(now.x_m - then.x_m, now.y_m - then.y_m) > 0.25;
  };
  ASSERT_TRUE(eventually(is_further, 60.0)) << run.errors();
  run.signal(SIGINT);
  ASSERT_EQ(run.wait(60), 130) << run.errors();
  const std::string report = text_of(folder.path() / "r.json");
  EXPECT_EQ(json_value(report, "pose_source"), "fused") << report;
  EXPECT_GT(std::stoi(json_value(report, "used")), 8) << report;
  EXPECT_GT(std::stoi(json_value(report, "frames_without_tags")), 0) << "mirrored: " << report;
  EXPECT_TRUE(footbot.has_moved());
  // It rolls on after the last tick until its stop arrives, for longer when its program is late to take it.
  const Pose truth = last_pose(footbot.log());
  const long long stood_ns = footbot.stands_since();
  ASSERT_GT(stood_ns, 0);
  const double late_s = static_cast<double>(footbot.late_ns(stood_ns - 1'000'000'000, stood_ns)) * 1e-9;
  const double near_m = 0.02 + 0.1 * late_s, near_rad = 0.04 + 0.15 * late_s;
  EXPECT_NEAR(std::stod(json_value(report, "x_m")), truth.x_m, near_m) << report;
  EXPECT_NEAR(std::stod(json_value(report, "y_m")), truth.y_m, near_m) << report;
  EXPECT_NEAR(turn_between(std::stod(json_value(report, "heading_rad")), truth.heading_rad), 0.0, near_rad) << report;
}

}  // namespace
}  // namespace tandem::scenarios
