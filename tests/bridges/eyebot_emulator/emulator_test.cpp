// The whole emulator in real time, over LCM within this process. The hub's side writes and reads bytes by hand.
#include "bridges/eyebot_emulator/emulator.hpp"

#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <future>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mutex>
#include <random>
#include <set>
#include <thread>
#include <unistd.h>

#include "tests/bridges/eyebot_emulator/hand_written.hpp"

namespace tandem::bridges::eyebot_emulator {
namespace {

namespace fs = std::filesystem;
using hand_written::Head;
using lcm_bus::LcmLink;
using lcm_bus::LcmMessage;
using testing::HasSubstr;

constexpr auto kPatience = std::chrono::seconds(20);  // for what must happen; nothing takes nearly as long
constexpr std::int32_t kSession = 0x1234;

std::int64_t unix_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// An emulator on a thread of its own, and a hub that hears all it says.
class Running {
 public:
  explicit Running(Options options = {}) {
    auto link = LcmLink::open("memq://");
    EXPECT_TRUE(link.ok());
    link_ = std::move(link).value();
    EXPECT_TRUE(link_->subscribe("eyebot/[^/]+/[a-z_]+", [this](const LcmMessage& m) { hear(m); }).ok());
    options.shared = link_;
    options.log_file = log_file_.string();
    options.ready = [this](const std::string&) { ready_.set_value(); };
    options.events = [this](hal::TimeNs at, std::string_view name, const EventFields& fields) {
      const std::lock_guard lock(guard_);
      events_.push_back(to_json(at, name, fields));
      news_.notify_all();
    };
    thread_ = std::thread([this, options] { status_ = run(options, stop_); });
    EXPECT_EQ(ready_.get_future().wait_for(kPatience), std::future_status::ready);
  }
  ~Running() {
    (void)end();
    link_.reset();  // its thread calls what is below
    fs::remove(log_file_);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  hal::Status end() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    return status_;
  }
  std::string log_text() const {
    std::ifstream file(log_file_);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  Head head() { return {unix_us(), seq_++, kSession}; }
  void say(const std::string& channel, const hand_written::Bytes& bytes) {
    EXPECT_TRUE(link_->publish(channel, bytes));
  }
  void order(int action, const std::string& robot = "eb0") {
    say("eyebot/" + robot + "/cmd/mode", hand_written::mode(head(), action));
  }
  /// Waits until `condition` holds of what has been heard by then.
  bool heard(const std::function<bool(const std::map<std::string, std::vector<hand_written::Bytes>>&)>& condition) {
    std::unique_lock lock(guard_);
    return news_.wait_for(lock, kPatience, [&] { return condition(heard_); });
  }
  bool in_mode(int mode, const std::string& robot = "eb0") {
    return heard([&](const auto& all) {
      const auto found = all.find("eyebot/" + robot + "/status");
      return found != all.end() && hand_written::read_status(found->second.back()).mode == mode;
    });
  }
  bool happened(const std::string& what, int count = 1) {
    std::unique_lock lock(guard_);
    return news_.wait_for(lock, kPatience, [&] {
      return std::count_if(events_.begin(), events_.end(),
                           [&](const std::string& e) { return e.find(what) != std::string::npos; }) >= count;
    });
  }

 private:
  void hear(const LcmMessage& message) {
    const std::lock_guard lock(guard_);
    heard_[std::string(message.channel)].emplace_back(message.data.begin(), message.data.end());
    news_.notify_all();
  }
  static fs::path next_log() {
    static int n = 0;
    return fs::temp_directory_path() /
           ("eyebot_emulator_" + std::to_string(getpid()) + "_" + std::to_string(n++) + ".json");
  }

  fs::path log_file_ = next_log();
  std::shared_ptr<LcmLink> link_;
  std::promise<void> ready_;
  std::mutex guard_;
  std::condition_variable news_;
  std::map<std::string, std::vector<hand_written::Bytes>> heard_;
  std::vector<std::string> events_;
  std::int32_t seq_ = 0;
  std::atomic<bool> stop_{false};
  hal::Status status_;
  std::thread thread_;
};

Options with(std::vector<std::string> faults) {
  Options options;
  options.faults = std::move(faults);
  return options;
}

TEST(Emulator, FliesAndTells) {
  Running emulator;
  ASSERT_TRUE(emulator.in_mode(1));
  emulator.order(1);
  emulator.order(3);
  ASSERT_TRUE(emulator.in_mode(2));
  ASSERT_TRUE(emulator.heard([](const auto& all) {
    const auto acks = all.find("eyebot/eb0/ack");
    return acks != all.end() && acks->second.size() == 2;
  }));
  emulator.order(8);
  ASSERT_TRUE(emulator.in_mode(10));
  ASSERT_TRUE(emulator.end().ok());
  const std::string log = emulator.log_text();
  EXPECT_THAT(log, HasSubstr(R"("event":"control","robot":"eb0","session":4660)"));
  EXPECT_THAT(log, HasSubstr(R"("event":"mode","robot":"eb0","from":"idle","to":"takeoff")"));
  EXPECT_THAT(log, HasSubstr(R"("event":"sent","robot":"eb0","channel":"eyebot/eb0/ack","count":3,"last_seq":2)"));
  EXPECT_THAT(log, HasSubstr(R"("event":"end","robot":"eb0","why":"stopped","mode":"estop")"));
}

TEST(Emulator, HasSeveralRobots) {
  Options options;
  options.count = 3;
  Running emulator(options);
  for (const char* robot : {"eb0", "eb1", "eb2"}) ASSERT_TRUE(emulator.in_mode(1, robot));
  emulator.order(1, "eb1");
  emulator.order(3, "eb1");
  ASSERT_TRUE(emulator.in_mode(2, "eb1"));
  EXPECT_TRUE(emulator.in_mode(1, "eb0"));
  EXPECT_TRUE(emulator.in_mode(1, "eb2"));
}

TEST(Emulator, OutlivesWhateverIsSentToIt) {
  Running emulator;
  ASSERT_TRUE(emulator.in_mode(1));
  std::mt19937 chance(1);
  const std::vector<std::string> channels = {
      "eyebot/eb0/cmd/mode",     "eyebot/eb0/cmd/rab",     "eyebot/eb0/cmd/leds", "hub/lab/heartbeat",
      "eyebot/eb0/cmd/velocity", "eyebot/eb0/cmd/explode", "eyebot/eb9/cmd/mode", "hub/lab/state"};
  for (int i = 0; i < 2000; ++i) {
    hand_written::Bytes bytes(chance() % 200);
    for (std::byte& b : bytes) b = static_cast<std::byte>(chance());
    emulator.say(channels[chance() % channels.size()], bytes);
  }
  emulator.order(1);
  ASSERT_TRUE(emulator.heard([](const auto& all) { return all.contains("eyebot/eb0/ack"); }));
  EXPECT_TRUE(emulator.happened(R"("event":"malformed")", 5));
  EXPECT_TRUE(emulator.end().ok());
}

TEST(Emulator, RestartsWithAnotherSession) {
  Running emulator(with({"restart@500ms"}));
  ASSERT_TRUE(emulator.happened(R"("event":"boot")", 2));
  ASSERT_TRUE(emulator.heard([](const auto& all) {
    const auto states = all.find("eyebot/eb0/state");
    if (states == all.end()) return false;
    std::set<std::int32_t> sessions;
    for (const auto& bytes : states->second) {
      hand_written::Reader r(bytes);
      r.fingerprint();
      sessions.insert(r.head().session);
    }
    return sessions.size() == 2;
  }));
  EXPECT_TRUE(emulator.happened(R"("fault":"restart@500ms","phase":"begin")"));
}

TEST(Emulator, MayHaveATwin) {
  Running emulator(with({"namesake@200ms+300ms"}));
  ASSERT_TRUE(emulator.happened(R"("fault":"namesake@200ms+300ms","phase":"end")"));
  ASSERT_TRUE(emulator.heard([](const auto& all) {
    std::set<std::int32_t> sessions;
    for (const auto& bytes : all.at("eyebot/eb0/status")) {
      sessions.insert(hand_written::read_status(bytes).head.session);
    }
    return sessions.size() == 2;
  }));
}

TEST(Emulator, GoesSilentAndComesBack) {
  Running emulator(with({"silent=state@0s+500ms"}));
  ASSERT_TRUE(emulator.heard([](const auto& all) { return all.contains("eyebot/eb0/state"); }));
  ASSERT_TRUE(emulator.heard([](const auto& all) {
    hand_written::Reader r(all.at("eyebot/eb0/state").front());
    r.fingerprint();
    return r.head().seq >= 15;  // those before are missing
  }));
}

TEST(Emulator, RefusesWhatItCannotDo) {
  const std::atomic<bool> stop{true};
  const auto why = [&](const Options& options) { return run(options, stop).error().message; };
  Options options;
  options.link = "serial:/dev/ttyUSB0";
  EXPECT_THAT(why(options), HasSubstr("lcm:udpm://"));
  options = {};
  options.robot.name = "eb 0";
  EXPECT_THAT(why(options), HasSubstr("'eb 0'"));
  options.robot.name = "a-name-of-far-too-many-letters";
  EXPECT_THAT(why(options), HasSubstr("1 to 24"));
  options = {};
  options.count = 0;
  EXPECT_THAT(why(options), HasSubstr("--count 0"));
  EXPECT_THAT(why(with({"explode@1s"})), HasSubstr("explode"));
  options = {};
  options.log_file = "/nowhere/at/all";
  EXPECT_THAT(why(options), HasSubstr("/nowhere/at/all"));
}

TEST(Names, CountOnFromTheFirst) {
  EXPECT_EQ(names_of("eb0", 1), (std::vector<std::string>{"eb0"}));
  EXPECT_EQ(names_of("eb0", 3), (std::vector<std::string>{"eb0", "eb1", "eb2"}));
  EXPECT_EQ(names_of("eb9", 2), (std::vector<std::string>{"eb9", "eb10"}));
  EXPECT_EQ(names_of("hawk", 2), (std::vector<std::string>{"hawk0", "hawk1"}));
}

}  // namespace
}  // namespace tandem::bridges::eyebot_emulator
