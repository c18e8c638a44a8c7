// A real robot that somebody watches and stops from a page: verdicts come from the robot's own log.
#include <chrono>
#include <csignal>
#include <gtest/gtest.h>
#include <memory>
#include <string>

#include "hal/json/json.hpp"
#include "tests/checkout.hpp"
#include "tests/scenarios/process.hpp"
#include "window/wire/client.hpp"

namespace tandem::scenarios {
namespace {

using namespace std::chrono_literals;
constexpr double kPatience_s = 30.0;

/// One who watches and commands.
class Viewer {
 public:
  explicit Viewer(const Tandem& program) {
    EXPECT_TRUE(eventually([&] { return program.errors().find("?token=") != std::string::npos; }, kPatience_s));
    const std::string text = program.errors();
    const std::size_t at = text.find("http://");
    auto joined = window::Client::connect(text.substr(at, text.find('\n', at) - at));
    EXPECT_TRUE(joined.ok());
    if (joined.ok()) client_ = std::make_unique<window::Client>(std::move(joined).value());
  }
  /// The next text of this type, or an empty object.
  hal::Json next(const std::string& type) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kPatience_s);
    while (client_ != nullptr && std::chrono::steady_clock::now() < end) {
      const auto received = client_->receive(200ms);
      if (!received || received->kind != window::Client::Received::Kind::Text) continue;
      const auto json = hal::parse_json_object(received->bytes);
      if (json.ok() && json.value().value("type", "") == type) return json.value();
    }
    return hal::Json::object();
  }
  hal::Json ask(const std::string& command) {
    EXPECT_TRUE(client_ != nullptr && client_->send(command).ok());
    return next("answer");
  }
  /// The state of the only real robot, once it is this one.
  bool sees(const std::string& state) {
    return eventually(
        [&] {
          const hal::Json real = next("real");
          return real.contains("robots") && !real["robots"].empty() && real["robots"][0]["state"] == state;
        },
        kPatience_s);
  }

 private:
  std::unique_ptr<window::Client> client_;
};

TEST(ViewedRobot, IsPausedAndStoppedFromThePageAndStandsUntilItIsArmed) {
  const Folder folder;
  EmulatedEpuck epuck(folder);
  ASSERT_TRUE(epuck.ready());
  Tandem view({"view", std::string(test::kSourceDir) + "/configs/epuck_mixed.xml", "--no-browser"}, folder.path());
  Viewer viewer(view);
  ASSERT_TRUE(eventually([&] { return epuck.moves(); }, kPatience_s)) << view.errors();
  ASSERT_TRUE(viewer.sees("driving"));

  const hal::Json faster = viewer.ask(R"({"id":1,"do":"speed","times":2})");
  EXPECT_EQ(faster["ok"], false);
  EXPECT_NE(faster["error"].get<std::string>().find("real robots take part"), std::string::npos) << faster;
  const hal::Json paused = viewer.ask(R"({"id":2,"do":"pause"})");
  EXPECT_EQ(paused["ok"], true) << paused;
  EXPECT_TRUE(stands_at_once(epuck));
  EXPECT_TRUE(viewer.sees("paused"));
  const hal::Json on = viewer.ask(R"({"id":3,"do":"play"})");
  EXPECT_EQ(on["tick"], paused["tick"]) << "time stood still";
  ASSERT_TRUE(eventually([&] { return epuck.moves(); }, kPatience_s));

  EXPECT_EQ(viewer.ask(R"({"id":2,"do":"estop"})")["ok"], true);
  EXPECT_TRUE(stands_at_once(epuck));
  EXPECT_TRUE(viewer.sees("emergency stop; waits to be armed"));
  for (int i = 0; i < 4; ++i) {  // two seconds of the run
    (void)viewer.next("real");
    EXPECT_FALSE(epuck.moves());
  }
  EXPECT_EQ(viewer.ask(R"({"id":3,"do":"release","robot":"ep0"})").contains("ok"), true);
  (void)viewer.next("real");
  EXPECT_FALSE(epuck.moves()) << "letting go of it does not arm it";
  EXPECT_EQ(viewer.ask(R"({"id":4,"do":"rearm","robot":"ep0"})")["ok"], false);
  EXPECT_EQ(viewer.ask(R"({"id":5,"do":"arm","robot":"nobody"})")["ok"], false);

  EXPECT_EQ(viewer.ask(R"({"id":6,"do":"arm","robot":"ep0"})")["ok"], true);
  EXPECT_TRUE(eventually([&] { return epuck.moves(); }, kPatience_s));
  EXPECT_EQ(viewer.ask(R"({"id":7,"do":"halt","robot":"ep0"})")["ok"], true);
  EXPECT_TRUE(stands_at_once(epuck));
  EXPECT_TRUE(viewer.sees("held by the operator"));
  view.signal(SIGINT);
  EXPECT_EQ(view.wait(), 0) << view.errors();
  EXPECT_FALSE(epuck.moves());
}

}  // namespace
}  // namespace tandem::scenarios
