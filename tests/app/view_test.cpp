// `tandem view` and `run --view` as a user starts them, with viewers that are no browsers.
#include <chrono>
#include <cstring>
#include <gtest/gtest.h>
#include <memory>
#include <string>
#include <vector>

#include "hal/json/json.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"
#include "window/wire/client.hpp"

namespace tandem::app {
namespace {

using hal::Json;
using scenarios::eventually;
using scenarios::Folder;
using scenarios::Tandem;
using window::Client;
using namespace std::chrono_literals;

constexpr double kPatience_s = 60.0;

std::string config(const std::string& name) {
  return std::string(test::kSourceDir) + "/configs/" + name;
}

/// What it prints first; empty: it never does.
std::string address_of(const Tandem& program) {
  std::string address;
  (void)eventually(
      [&] {
        const std::string text = program.errors();
        const std::size_t at = text.find("http://");
        const std::size_t end = text.find('\n', at);
        if (at == std::string::npos || end == std::string::npos) return false;
        address = text.substr(at, end - at);
        return true;
      },
      kPatience_s);
  return address;
}

/// What it prints besides, for those who look on alone.
std::string viewers_address_of(const Tandem& program) {
  const std::string text = program.errors();
  const std::size_t at = text.find("http://", text.find("to look on"));
  return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
}

/// A viewer, and the tick of the newest frame that it has.
class Watching {
 public:
  explicit Watching(const std::string& address) {
    auto joined = Client::connect(address);
    EXPECT_TRUE(joined.ok()) << (joined.ok() ? "" : joined.error().message);
    if (joined.ok()) client_ = std::make_unique<Client>(std::move(joined).value());
  }
  /// Takes what comes until `done` is content with a text, which is given; an empty object: never.
  template <class Done>
  Json until(Done&& done) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPatience_s);
    while (client_ != nullptr && std::chrono::steady_clock::now() < end) {
      const auto received = client_->receive(500ms);
      if (!received) continue;
      if (received->kind == Client::Received::Kind::Close) break;
      if (received->kind == Client::Received::Kind::Binary) {
        note(received->bytes);
        continue;
      }
      Json json = hal::parse_json(received->bytes).value();
      if (done(json)) return json;
    }
    return Json::object();
  }
  Json ask(const std::string& command) {
    const std::string id = std::to_string(++asked_);
    (void)client_->send(R"({"id":)" + id + "," + command.substr(1));
    return until([&](const Json& json) { return json["type"] == "answer" && json["id"] == asked_; });
  }
  Json state(std::int64_t tick) {
    return until([&](const Json& json) { return json["type"] == "state" && json["tick"] == tick; });
  }
  bool sees(std::int64_t tick) {
    return eventually(
        [&] {
          const auto received = client_->receive(200ms);
          if (received && received->kind == Client::Received::Kind::Binary) note(received->bytes);
          return shown_ == tick;
        },
        kPatience_s);
  }
  Client& client() { return *client_; }

 private:
  void note(const std::string& bytes) {
    std::uint32_t type = 0;
    std::memcpy(&type, bytes.data(), sizeof type);
    if (type == 1) std::memcpy(&shown_, bytes.data() + 8, sizeof shown_);
  }
  std::unique_ptr<Client> client_;
  std::int64_t shown_ = -1, asked_ = 0;
};

TEST(View, ARunWaitsForCommandsGoesBackAndEndsWithCtrlC) {
  const Folder folder;
  Tandem view({"view", config("epuck_diffusion.xml"), "--no-browser", "--paused"}, folder.path());
  Watching viewer(address_of(view));
  const Json hello = viewer.until([](const Json& json) { return json["type"] == "hello"; });
  EXPECT_EQ(hello["experiment"], "epuck_diffusion");
  EXPECT_EQ(hello["mode"], "run");
  EXPECT_TRUE(viewer.sees(0));
  EXPECT_EQ(viewer.ask(R"({"do":"step","ticks":5})")["ok"], true);
  EXPECT_EQ(viewer.state(5)["paused"], true);
  EXPECT_TRUE(viewer.sees(5));
  EXPECT_EQ(viewer.ask(R"({"do":"go_to","tick":2})")["ok"], true);
  EXPECT_TRUE(viewer.sees(2));
  EXPECT_EQ(viewer.ask(R"({"do":"inspect","robots":["ep0"]})")["ok"], true);
  const Json inside = viewer.until([](const Json& json) { return json["type"] == "inspection"; });
  ASSERT_EQ(inside["robots"].size(), 1U);
  EXPECT_EQ(inside["robots"][0]["id"], "ep0");
  EXPECT_FALSE(inside["robots"][0]["ports"].empty());
  EXPECT_NE(viewer.ask(R"({"do":"estop"})")["error"].get<std::string>().find("no real robots"), std::string::npos);
  EXPECT_NE(viewer.ask(R"({"do":"nonsense"})")["error"].get<std::string>().find("no command 'nonsense'"),
            std::string::npos);
  EXPECT_EQ(viewer.ask(R"({"do":"layers","on":["ids"],"robots":"*"})")["ok"], true);
  EXPECT_EQ(viewer.until([](const Json& json) { return json["type"] == "texts"; })["texts"].size(), 50U);
  view.signal(SIGINT);
  EXPECT_EQ(view.wait(kPatience_s), 0);
}

TEST(View, ARunThatIsWatchedIsTheSameRun) {
  const Folder folder;
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run",    config("footbot_foraging.xml"), "--steps", "150", "--report", "-",
                                      "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return std::make_unique<Tandem>(words, folder.path());
  };
  const auto alone = run({});
  ASSERT_EQ(alone->wait(kPatience_s), 0) << alone->errors();
  const std::string hash = scenarios::json_value(alone->output(), "state_hash");
  ASSERT_FALSE(hash.empty());

  const auto watched = run({"--view", "--speed", "50"});
  const std::string address = address_of(*watched);
  std::vector<std::unique_ptr<Watching>> viewers;
  for (int i = 0; i < 20; ++i) viewers.push_back(std::make_unique<Watching>(address));
  // One that looks at everything, hostile ones, and some that never read.
  (void)viewers[0]->client().send(
      R"({"id":1,"do":"layers","on":["proximity","range_and_bearing","ids"],"robots":"*"})");
  (void)viewers[0]->client().send(R"({"id":2,"do":"inspect","robots":["fb0","fb1"]})");
  (void)viewers[1]->client().send("nonsense");
  (void)viewers[2]->client().send_frame(0x82, "bytes");
  (void)viewers[3]->client().send_bytes(std::string(1000, '\xff'));
  for (int i = 0; i < 300; ++i) (void)viewers[4]->client().send(R"({"id":1,"do":"inspect","robots":["fb0"]})");
  EXPECT_EQ(watched->wait(2 * kPatience_s), 0) << watched->errors();
  EXPECT_EQ(scenarios::json_value(watched->output(), "state_hash"), hash);

  const auto unseen = run({"--view"});
  EXPECT_EQ(unseen->wait(kPatience_s), 0) << unseen->errors();
  EXPECT_EQ(scenarios::json_value(unseen->output(), "state_hash"), hash);
}

TEST(View, GoingBackAndOnIsTheSameRun) {
  const Folder folder;
  const std::vector<std::string> words = {config("footbot_foraging.xml"), "--steps", "40", "--report", "-", "--quiet"};
  std::vector<std::string> run_words = {"run"}, view_words = {"view", "--no-browser", "--paused"};
  run_words.insert(run_words.end(), words.begin(), words.end());
  view_words.insert(view_words.end(), words.begin(), words.end());
  Tandem alone(run_words, folder.path());
  ASSERT_EQ(alone.wait(kPatience_s), 0) << alone.errors();
  Tandem view(view_words, folder.path());
  Watching viewer(address_of(view));
  EXPECT_EQ(viewer.ask(R"({"do":"step","ticks":30})")["ok"], true);
  viewer.state(30);
  EXPECT_EQ(viewer.ask(R"({"do":"go_to","tick":11})")["tick"], 11);
  EXPECT_EQ(viewer.ask(R"({"do":"play","speed":null})")["ok"], true);
  const Json end = viewer.until([](const Json& json) { return json["type"] == "state" && !json["ended"].is_null(); });
  EXPECT_EQ(end["tick"], 40);
  view.signal(SIGINT);
  EXPECT_EQ(view.wait(kPatience_s), 0);
  EXPECT_EQ(scenarios::json_value(view.output(), "state_hash"), scenarios::json_value(alone.output(), "state_hash"));
}

TEST(View, WhatWasTouchedIsInTheRecordAndIsRepeated) {
  const Folder folder;
  const std::vector<std::string> words = {config("footbot_foraging.xml"), "--steps", "60", "--report", "-", "--quiet"};
  std::vector<std::string> view_words = {
      "view", "--no-browser", "--paused", "--record", "x.rec", "--set", "record.fingerprint_every=7"};
  std::vector<std::string> run_words = {"run", "--repeat", "x.rec"};
  run_words.insert(run_words.end(), words.begin(), words.end());
  view_words.insert(view_words.end(), words.begin(), words.end());
  Tandem view(view_words, folder.path());
  Watching viewer(address_of(view));
  const Json hello = viewer.until([](const Json& json) { return json["type"] == "hello"; });
  ASSERT_EQ(hello["controls"][0]["name"], "radius") << hello;
  const auto owner = hello["controls"][0]["owner"].get<std::string>();
  const auto done = [&](const std::string& command) { EXPECT_EQ(viewer.ask(command)["ok"], true) << command; };
  const auto walk = [&](int ticks, std::int64_t to) {
    done(R"({"do":"step","ticks":)" + std::to_string(ticks) + "}");
    viewer.state(to);
  };
  walk(20, 20);
  done(R"({"do":"halt","robot":"fb0"})");
  walk(10, 30);
  done(R"({"do":"remove","robot":"fb1"})");
  walk(10, 40);
  done(R"({"do":"go_to","tick":25})");
  done(R"({"do":"set","owner":")" + owner + R"(","control":"radius","value":20})");
  done(R"({"do":"press","owner":")" + owner + R"(","control":"scatter"})");
  done(R"({"do":"play","speed":null})");
  viewer.until([](const Json& json) { return json["type"] == "state" && !json["ended"].is_null(); });
  view.signal(SIGINT);
  EXPECT_EQ(view.wait(kPatience_s), 0) << view.errors();
  Tandem again(run_words, folder.path());
  EXPECT_EQ(again.wait(kPatience_s), 0) << again.errors();
  EXPECT_EQ(scenarios::json_value(again.output(), "state_hash"), scenarios::json_value(view.output(), "state_hash"));
  run_words.insert(run_words.end(), {"--seed", "4711"});
  Tandem other(run_words, folder.path());
  EXPECT_EQ(other.wait(kPatience_s), 3);
  EXPECT_NE(other.errors().find("is not as in x.rec"), std::string::npos) << other.errors();
}

TEST(View, AScriptThatIsChangedIsReadAnewAndRepeatedFromTheRecord) {
  const Folder folder;
  folder.write("e.xml", R"(<tandem><framework><experiment length="0" ticks_per_second="10" random_seed="3"/></framework>
<controllers><lua_controller id="walk"><actuators><differential_steering/></actuators><sensors/>
<params script="walk.lua"/></lua_controller></controllers><arena size="4,4,1">
<e-puck id="ep0"><body position="0,0,0"/><controller config="walk"/></e-puck>
<e-puck id="ep1"><body position="0,1,0"/><controller config="walk"/></e-puck></arena>
<physics_engines><kinematics2d id="e"/></physics_engines></tandem>)");
  folder.write("walk.lua", "function step() robot.wheels.set_velocity(5, 5) end");
  Tandem view({"view", "e.xml", "--no-browser", "--paused", "--record", "x.rec", "--set", "record.fingerprint_every=5",
               "--steps", "60", "--report", "-", "--quiet"},
              folder.path());
  Watching viewer(address_of(view));
  viewer.until([](const Json& json) { return json["type"] == "hello"; });
  const auto said = [&](const std::string& text) {
    const Json found = viewer.until(
        [&](const Json& json) { return json["type"] == "log" && hal::to_text(json).find(text) != std::string::npos; });
    EXPECT_FALSE(found.empty()) << text << "\n" << view.errors();
  };
  EXPECT_EQ(viewer.ask(R"({"do":"step","ticks":20})")["ok"], true);
  viewer.state(20);
  folder.write("walk.lua", "function step()\n  robot.wheels.set_velocity(5, 5\nend");
  said("the old one goes on: walk.lua:3: syntax error: ");
  folder.write("turn.lua", "return {left = 2, right = 4}");
  folder.write("walk.lua",
               "local turn = require 'turn'\nfunction step() robot.wheels.set_velocity(turn.left, turn.right) end");
  said("2 robots began anew at tick 20");
  EXPECT_EQ(viewer.ask(R"({"do":"step","ticks":20})")["ok"], true);
  viewer.state(40);
  folder.write("turn.lua", "return {left = 5, right = 1}");
  said("2 robots began anew at tick 40");
  EXPECT_EQ(viewer.ask(R"({"do":"go_to","tick":10})")["ok"], true);
  EXPECT_EQ(viewer.ask(R"({"do":"play","speed":null})")["ok"], true);
  viewer.until([](const Json& json) { return json["type"] == "state" && !json["ended"].is_null(); });
  view.signal(SIGINT);
  EXPECT_EQ(view.wait(kPatience_s), 0) << view.errors();
  EXPECT_EQ(view.errors().find("came out different"), std::string::npos) << view.errors();
  Tandem again({"run", "e.xml", "--repeat", "x.rec", "--steps", "60", "--report", "-", "--quiet"}, folder.path());
  EXPECT_EQ(again.wait(kPatience_s), 0) << again.errors();
  EXPECT_NE(again.errors().find("begins with its script as the record has it"), std::string::npos) << again.errors();
  EXPECT_EQ(scenarios::json_value(again.output(), "state_hash"), scenarios::json_value(view.output(), "state_hash"));
}

TEST(View, PicturesOfTheMomentAreServed) {
  const Folder folder;
  Tandem view({"view", config("epuck_diffusion.xml"), "--no-browser", "--paused"}, folder.path());
  const std::string address = address_of(view);
  const std::size_t colon = address.find(':', 7);
  const auto port = static_cast<std::uint16_t>(std::stoi(address.substr(colon + 1)));
  const auto picture = window::ask("127.0.0.1", port,
                                   "GET /picture.svg" + address.substr(address.find('?')) +
                                       " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  ASSERT_TRUE(picture.ok());
  EXPECT_EQ(picture.value().status, 200);
  EXPECT_NE(picture.value().body.find("<svg"), std::string::npos);
  view.signal(SIGTERM);
  EXPECT_EQ(view.wait(kPatience_s), 0);
}

TEST(View, AreasOfARecordAreThoseOfItsRun) {
  const Folder folder;
  const std::vector<std::string> simulated = {"--without", "fb0",   "--without",
                                              "fb1",       "--set", "framework.time.mode=fast"};
  std::vector<std::string> words = {"run",  config("footbot_safety.xml"), "--steps", "5", "--quiet", "--record",
                                    "x.rec"};
  words.insert(words.end(), simulated.begin(), simulated.end());
  Tandem run(words, folder.path());
  ASSERT_EQ(run.wait(kPatience_s), 0) << run.errors();
  const auto areas_of = [&](std::vector<std::string> view_words) {
    view_words.insert(view_words.end(), {"--no-browser", "--paused"});
    Tandem view(view_words, folder.path());
    Watching viewer(address_of(view));
    return viewer.until([](const Json& json) { return json["type"] == "hello"; })["areas"];
  };
  const Json recorded = areas_of({"view", "x.rec"});
  ASSERT_EQ(recorded.size(), 3U) << recorded;
  EXPECT_EQ(recorded[0]["kind"], "fence");
  EXPECT_EQ(recorded[1]["kind"], "keep_out");
  EXPECT_EQ(recorded[2]["kind"], "zone");
  EXPECT_EQ(recorded[2]["id"], "dock");
  EXPECT_EQ(recorded[2]["max_speed"], 0.05);
  EXPECT_GT(recorded[0]["corners"].size(), 2U);
  EXPECT_GT(recorded[1]["to"].get<double>(), recorded[1]["from"].get<double>());
  std::vector<std::string> live = {"view", config("footbot_safety.xml")};
  live.insert(live.end(), simulated.begin(), simulated.end());
  EXPECT_EQ(areas_of(live), recorded);
}

TEST(View, ARecordIsPlayedAndLookedInto) {
  const Folder folder;
  Tandem run({"run", config("footbot_foraging.xml"), "--steps", "50", "--quiet", "--record", "x.rec"}, folder.path());
  ASSERT_EQ(run.wait(kPatience_s), 0) << run.errors();
  Tandem view({"view", "x.rec", "--no-browser", "--paused"}, folder.path());
  Watching viewer(address_of(view));
  const Json hello = viewer.until([](const Json& json) { return json["type"] == "hello"; });
  EXPECT_EQ(hello["mode"], "record");
  EXPECT_GT(hello["layers"].size(), 5U) << "those of a run";
  EXPECT_EQ(viewer.state(0)["latest"], 50);
  EXPECT_EQ(viewer.ask(R"({"do":"go_to","tick":37})")["tick"], 37);
  EXPECT_TRUE(viewer.sees(37));
  const Json history = viewer.ask(R"({"do":"history","robot":"fb0","role":"pose","field":"x","from":10,"to":20})");
  ASSERT_EQ(history["ticks"].size(), 11U) << history;
  EXPECT_EQ(history["ticks"][0], 10);
  EXPECT_TRUE(history["values"][10].is_number());
  EXPECT_NE(viewer.ask(R"({"do":"move","robot":"fb0","x":0,"y":0})")["error"].get<std::string>().find("a record"),
            std::string::npos);
  EXPECT_EQ(viewer.ask(R"({"do":"inspect","robots":["fb0"]})")["ok"], true);
  const Json inside = viewer.until([](const Json& json) { return json["type"] == "inspection"; });
  ASSERT_EQ(inside["robots"].size(), 1U);
  EXPECT_EQ(inside["robots"][0]["alive"], true);
  EXPECT_TRUE(inside["robots"][0]["pose"]["x"].is_number());
  EXPECT_EQ(viewer.ask(R"({"do":"play","speed":null})")["ok"], true);
  EXPECT_TRUE(viewer.sees(50));
  EXPECT_EQ(viewer.state(50)["paused"], true);
  view.signal(SIGINT);
  EXPECT_EQ(view.wait(kPatience_s), 0);
}

/// Whether the page gets a message of real robots of which that holds.
bool told_of_real_robots(Watching& viewer, const std::function<bool(const Json&)>& holds) {
  const Json message = viewer.until([&](const Json& json) { return json["type"] == "real" && holds(json); });
  return message.value("type", "") == "real";
}

TEST(View, RealRobotsAreShownStoppedAndArmed) {
  const Folder folder;
  const scenarios::EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  Tandem run({"run", config("epuck_mixed.xml"), "--seconds", "120", "--view", "--quiet", "--record", "x.rec", "--log",
              "x.log"},
             folder.path());
  Watching viewer(address_of(run));
  const Json hello = viewer.until([](const Json& json) { return json["type"] == "hello"; });
  EXPECT_EQ(hello["mode"], "mixed");
  const auto real = [&](const auto& holds) { return told_of_real_robots(viewer, holds); };
  EXPECT_TRUE(real([](const Json& json) { return json["robots"][0]["driving"] == true; }));
  EXPECT_EQ(viewer.ask(R"({"do":"pause"})")["ok"], true);
  EXPECT_TRUE(eventually([&] { return !epuck.moves(); }, kPatience_s));
  EXPECT_EQ(viewer.ask(R"({"do":"play"})")["ok"], true);
  EXPECT_TRUE(eventually([&] { return epuck.moves(); }, kPatience_s));
  Watching looking_on(viewers_address_of(run));
  EXPECT_EQ(looking_on.ask(R"({"do":"arm","robot":"ep0","who":"ben"})")["ok"], false);
  EXPECT_EQ(looking_on.ask(R"({"do":"estop","who":"ben"})")["ok"], true);
  EXPECT_TRUE(eventually([&] { return !epuck.moves(); }, kPatience_s));
  EXPECT_TRUE(real([](const Json& json) { return json["estop"] == true && json["robots"][0]["driving"] == false; }));
  EXPECT_TRUE(eventually([&] { return viewer.ask(R"({"do":"arm","robot":"ep0"})")["ok"] == true; }, kPatience_s))
      << "nobody else arms within a second of a stop";
  EXPECT_TRUE(real([](const Json& json) { return json["robots"][0]["driving"] == true; }));
  run.signal(SIGINT);
  EXPECT_EQ(run.wait(kPatience_s), 130) << run.errors();
  const std::string record = scenarios::text_of(folder.path() / "x.rec");
  const std::string log = scenarios::text_of(folder.path() / "x.log");
  EXPECT_NE(record.find(R"({"do":"estop","who":"ben","by":{"role":"viewer","address":"127.0.0.1"}})"),
            std::string::npos);
  EXPECT_NE(log.find("'ben' (viewer, 127.0.0.1): estop"), std::string::npos) << log;
  EXPECT_NE(log.find("'window' (operator, 127.0.0.1): arm ep0"), std::string::npos) << log;
}

TEST(View, OneRealRobotByItselfIsShownStoppedAndArmed) {
  const Folder folder;
  const scenarios::EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  Tandem robot({"robot", config("epuck_robot.xml"), "--seconds", "120", "--view"}, folder.path());
  Watching viewer(address_of(robot));
  const Json hello = viewer.until([](const Json& json) { return json["type"] == "hello"; });
  EXPECT_EQ(hello["mode"], "mixed");
  const auto real = [&](const auto& holds) { return told_of_real_robots(viewer, holds); };
  EXPECT_TRUE(real([](const Json& json) { return json["robots"][0]["driving"] == true; }));
  EXPECT_EQ(viewer.ask(R"({"do":"inspect","robots":["ep0"]})")["ok"], true);
  const Json inside = viewer.until([](const Json& json) { return json["type"] == "inspection"; });
  ASSERT_EQ(inside["robots"].size(), 1U);
  EXPECT_FALSE(inside["robots"][0]["ports"].empty());
  EXPECT_TRUE(eventually([&] { return epuck.moves(); }, kPatience_s));
  Watching looking_on(viewers_address_of(robot));
  EXPECT_EQ(looking_on.ask(R"({"do":"arm","robot":"ep0"})")["ok"], false);
  EXPECT_EQ(looking_on.ask(R"({"do":"estop"})")["ok"], true);
  EXPECT_NE(viewer.ask(R"({"do":"arm","robot":"ep0"})")["error"].get<std::string>().find("less than a second ago"),
            std::string::npos);
  EXPECT_TRUE(eventually([&] { return !epuck.moves(); }, kPatience_s));
  EXPECT_TRUE(real([](const Json& json) { return json["estop"] == true && json["robots"][0]["driving"] == false; }));
  EXPECT_NE(viewer.ask(R"({"do":"pause"})")["error"].get<std::string>().find("its time has one speed"),
            std::string::npos);
  EXPECT_TRUE(eventually([&] { return viewer.ask(R"({"do":"arm","robot":"ep0"})")["ok"] == true; }, kPatience_s));
  EXPECT_TRUE(real([](const Json& json) { return json["robots"][0]["driving"] == true; }));
  robot.signal(SIGINT);
  EXPECT_EQ(robot.wait(kPatience_s), 130) << robot.errors();
  EXPECT_FALSE(epuck.moves());
}

TEST(View, WhereAProjectorShowsTheArenaIsKeptWithTheUserNotBesideTheExperiment) {
  const Folder folder, state;
  const scenarios::fs::path experiment = folder.path() / "e.xml";
  scenarios::fs::copy_file(config("epuck_diffusion.xml"), experiment);
  ::setenv("XDG_STATE_HOME", state.path().c_str(), 1);
  const std::string corners = "[[0.1,0.1],[0.9,0.1],[0.9,0.9],[0.1,0.9]]";
  for (const bool first : {true, false}) {
    Tandem view({"view", "e.xml", "--projector", "--no-browser", "--paused"}, folder.path());
    Watching viewer(address_of(view));
    const Json told = viewer.until([](const Json& json) { return json["type"] == "projector"; });
    EXPECT_EQ(told["corners"], first ? Json(nullptr) : hal::parse_json(corners).value());
    if (first) {
      EXPECT_EQ(viewer.ask(R"({"do":"projector","corners":)" + corners + "}")["ok"], true);
    }
    view.signal(SIGINT);
    EXPECT_EQ(view.wait(kPatience_s), 0) << view.errors();
  }
  ::unsetenv("XDG_STATE_HOME");
  std::vector<std::string> beside;
  for (const auto& entry : scenarios::fs::directory_iterator(folder.path())) {
    const std::string name = entry.path().filename();
    if (name.find("projector") != std::string::npos) beside.push_back(name);
  }
  EXPECT_TRUE(beside.empty()) << beside.front();
}

TEST(View, WhatCannotBeServedIsSaid) {
  const Folder folder;
  Tandem first({"view", config("epuck_diffusion.xml"), "--no-browser", "--paused"}, folder.path());
  const std::string address = address_of(first);
  const std::string port = address.substr(address.find(':', 7) + 1, address.find('/', 7) - address.find(':', 7) - 1);
  Tandem second({"view", config("epuck_diffusion.xml"), "--no-browser", "--port", port}, folder.path());
  EXPECT_EQ(second.wait(kPatience_s), 1);
  EXPECT_NE(second.errors().find("another program has this port"), std::string::npos) << second.errors();
  Tandem third({"run", config("epuck_diffusion.xml"), "--view=70000"}, folder.path());
  EXPECT_EQ(third.wait(kPatience_s), 1);
  EXPECT_NE(third.errors().find("there is no port 70000"), std::string::npos) << third.errors();
  Tandem fourth({"view", config("epuck_diffusion.xml"), "--no-browser", "--view-address", "nowhere"}, folder.path());
  EXPECT_EQ(fourth.wait(kPatience_s), 1);
  EXPECT_NE(fourth.errors().find("no address in numbers"), std::string::npos) << fourth.errors();
}

}  // namespace
}  // namespace tandem::app
