// The whole emulator on real pseudo-terminals. The host's side is plain POSIX, and a foreign serial library.
#include "bridges/epuck_emulator/emulator.hpp"

#include <chrono>
#include <condition_variable>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <future>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mutex>
#include <numbers>
#include <poll.h>
#include <sys/wait.h>
#include <termios.h>
#include <thread>
#include <unistd.h>

#include "tests/bridges/epuck_emulator/held_body.hpp"
#include "tests/checkout.hpp"

namespace tandem::bridges::epuck_emulator {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using ::testing::HasSubstr;

constexpr auto kPatience = std::chrono::seconds(10);  // for what must happen; nothing takes nearly as long

struct Folder {
  fs::path path =
      fs::temp_directory_path() / ("epuck_emulator_" + std::to_string(getpid()) + "_" + std::to_string(next()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  static int next() {
    static int n = 0;
    return n++;
  }
};

/// Some of the options.
struct Given {
  std::string link{}, firmware = "gctronic", log_file{};
  std::vector<std::string> faults{};
  EmulatedBody* body = nullptr;

  Options options() const {
    Options all;
    if (!link.empty()) all.link = link;
    all.firmware = firmware;
    all.log_file = log_file;
    all.faults = faults;
    all.body = body;
    return all;
  }
};

/// An emulator on a thread of its own.
class Running {
 public:
  explicit Running(const Given& given = {}) : Running(given.options()) {}
  explicit Running(Options options) {
    if (options.link == Options{}.link) options.link = "pty:" + path();
    options.log_file = log_path();
    options.ready = [this](const std::string&) { ready_.set_value(); };
    options.events = [this](hal::TimeNs at, std::string_view name, const EventFields& fields) {
      const std::lock_guard lock(guard_);
      events_.push_back(to_json(at, name, fields));
      if (then_ && events_.back().find(awaited_) != std::string::npos) std::exchange(then_, {})();
      news_.notify_all();
    };
    thread_ = std::thread([this, options] { status_ = run(options, stop_); });
    EXPECT_EQ(ready_.get_future().wait_for(kPatience), std::future_status::ready);
  }
  ~Running() { stop_and_join(); }

  hal::Status end() {
    stop_and_join();
    return status_;
  }
  /// Calls `then`, on the emulator's thread, at the first event that contains `what`.
  void when(const std::string& what, std::function<void()> then) {
    const std::lock_guard lock(guard_);
    awaited_ = what;
    then_ = std::move(then);
  }
  std::string path() const { return (folder_.path / "ep0").string(); }
  std::string log_path() const { return (folder_.path / "log.json").string(); }
  std::string log_text() const {
    std::ifstream file(log_path());
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Waits until `count` events contain `what`.
  bool happened(const std::string& what, int count = 1) {
    std::unique_lock lock(guard_);
    return news_.wait_for(lock, kPatience, [&] {
      return std::count_if(events_.begin(), events_.end(),
                           [&](const std::string& e) { return e.find(what) != std::string::npos; }) >= count;
    });
  }

 private:
  void stop_and_join() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

  Folder folder_;
  std::promise<void> ready_;
  std::atomic<bool> stop_ = false;
  std::mutex guard_;
  std::condition_variable news_;
  std::vector<std::string> events_;
  std::string awaited_;
  std::function<void()> then_;
  hal::Status status_;
  std::thread thread_;
};

/// The host's end of the line.
class Host {
 public:
  explicit Host(const std::string& path, speed_t speed = B115200) {
    const auto deadline = Clock::now() + kPatience;
    while ((descriptor_ = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK)) < 0 && Clock::now() < deadline) {
      std::this_thread::yield();
    }
    EXPECT_GE(descriptor_, 0) << path;
    set_speed(speed);
  }
  /// Takes over a descriptor.
  explicit Host(int descriptor) : descriptor_(descriptor) {}
  ~Host() { ::close(descriptor_); }

  void set_speed(speed_t speed) {
    termios settings{};
    ASSERT_EQ(tcgetattr(descriptor_, &settings), 0);
    cfmakeraw(&settings);
    cfsetispeed(&settings, speed);
    cfsetospeed(&settings, speed);
    ASSERT_EQ(tcsetattr(descriptor_, TCSANOW, &settings), 0);
  }
  void write(std::string_view text) {
    ASSERT_EQ(::write(descriptor_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  /// Reads until `enough` of what has come since the last call; gives up after kPatience or when the line is gone.
  template <class Enough>
  std::string read(Enough enough) {
    const auto deadline = Clock::now() + kPatience;
    while (!enough(pending_) && Clock::now() < deadline) {
      pollfd wait{descriptor_, POLLIN, 0};
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
      ::poll(&wait, 1, static_cast<int>(left.count()) + 1);
      std::array<char, 4096> buffer{};
      const ssize_t n = ::read(descriptor_, buffer.data(), buffer.size());
      if (n > 0) pending_.append(buffer.data(), static_cast<std::size_t>(n));
      if ((wait.revents & POLLHUP) != 0) {
        hung_up = true;
        break;
      }
    }
    return std::exchange(pending_, {});
  }
  std::string read_bytes(std::size_t count) {
    return read([count](const std::string& got) { return got.size() >= count; });
  }
  std::string read_through(std::string_view end) {
    return read([end](const std::string& got) { return got.find(end) != std::string::npos; });
  }
  void skip_greeting() { EXPECT_THAT(read_through("for help\r\n"), HasSubstr("WELCOME to the SerCom")); }

  bool hung_up = false;

 private:
  int descriptor_ = -1;
  std::string pending_;
};

TEST(Emulator, AnswersAHostAndLogsIt) {
  Running robot;
  Host host(robot.path());
  host.skip_greeting();
  host.write("V\r");
  EXPECT_THAT(host.read_through("HW version: 1\r\n"), HasSubstr("v,Version 1.2.2 August 2008 GCtronic\r\n"));
  host.write(std::string_view("\xBC\xF4\x01\x0C\xFE\xAF\xB2\x9F\0", 9));
  EXPECT_EQ(host.read_bytes(26).size(), 26U);
  host.write("L,2,1\rS\r");
  EXPECT_EQ(host.read_through("s\r\n"), "l\r\ns\r\n");
  ASSERT_TRUE(robot.end().ok());

  const std::string log = robot.log_text();
  EXPECT_THAT(log, HasSubstr("\"event\":\"start\",\"firmware\":\"gctronic\",\"link\":\"pty:"));
  EXPECT_THAT(log, HasSubstr("\"event\":\"greeting\"}"));
  EXPECT_THAT(log, HasSubstr("\"event\":\"command\",\"mode\":\"ascii\",\"command\":\"V\",\"text\":\"V\"}"));
  EXPECT_THAT(log, HasSubstr("\"event\":\"command\",\"mode\":\"binary\",\"command\":\"D\",\"payload\":\"f4010cfe\"}"));
  EXPECT_THAT(log, HasSubstr("\"event\":\"wheels\",\"left\":500,\"right\":-500,\"by\":\"D\"}"));
  EXPECT_THAT(log, HasSubstr("\"event\":\"leds\",\"ring\":4,\"body\":false,\"front\":false}"));
  EXPECT_THAT(log, HasSubstr("\"event\":\"stop\"}"));
  EXPECT_THAT(log, HasSubstr("\"event\":\"end\",\"why\":\"stopped\"}\n"));
  std::istringstream lines(log);
  hal::TimeNs last_ns = 0;
  for (std::string line; std::getline(lines, line);) {
    ASSERT_TRUE(line.starts_with("{\"t_ns\":") && line.ends_with("}")) << line;
    const hal::TimeNs t_ns = std::stoll(line.substr(8));
    EXPECT_GE(t_ns, last_ns);
    last_ns = t_ns;
  }
}

TEST(Emulator, PassesEveryByteValue) {
  Running robot(Given{.firmware = "webots"});
  Host host(robot.path());
  host.skip_greeting();
  for (int low = 0; low < 256; low += 5) {  // XON, XOFF, CR, LF, interrupt characters …
    const auto byte = static_cast<char>(low);
    host.write(std::string{'\xB0', byte, byte, byte, byte, '\xAF', '\0'});
    EXPECT_EQ(host.read_bytes(4), std::string(4, byte));
  }
}

TEST(Emulator, KeepsItsLinkWhileItRunsAndTakesItAwayAtTheEnd) {
  Running robot;
  EXPECT_TRUE(fs::is_symlink(robot.path()));
  EXPECT_TRUE(fs::is_character_file(robot.path()));
  ASSERT_TRUE(robot.end().ok());
  EXPECT_FALSE(fs::is_symlink(fs::symlink_status(robot.path())));
}

TEST(Emulator, ReplacesAStaleLinkButNothingElse) {
  const Folder folder;
  const std::string path = (folder.path / "ep0").string();
  const std::atomic<bool> stop = true;
  fs::create_symlink("/dev/pts/no-such", path);
  EXPECT_TRUE(run(Given{.link = "pty:" + path}.options(), stop).ok());
  std::ofstream(path) << "precious";
  const hal::Status refused = run(Given{.link = "pty:" + path}.options(), stop);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr(path));
  EXPECT_TRUE(fs::is_regular_file(path));
}

TEST(Emulator, SaysWhatItWasGivenWrong) {
  const std::atomic<bool> stop = true;
  const auto message = [&stop](const Given& given) {
    const hal::Status status = run(given.options(), stop);
    EXPECT_FALSE(status.ok());
    return status.error().message;
  };
  EXPECT_THAT(message({.firmware = "v99"}), HasSubstr("btcom, gctronic, webots, epuck2"));
  EXPECT_THAT(message({.link = "can:can0"}), HasSubstr("pty:NAME"));
  EXPECT_THAT(message({.link = "pty:/nowhere/ep0"}), HasSubstr("/nowhere/ep0"));
  EXPECT_THAT(message({.link = "serial:/dev/nothing"}), HasSubstr("/dev/nothing"));
  EXPECT_THAT(message({.link = "serial:/dev/null@9600"}), HasSubstr("115200"));
  EXPECT_THAT(message({.faults = {"explode@3s"}}), HasSubstr("explode"));
  EXPECT_THAT(message({.log_file = "/nowhere/log"}), HasSubstr("/nowhere/log"));
}

TEST(Emulator, AnswersOnADeviceAndEndsWhenItIsUnplugged) {
  const int master = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);  // a device as good as any
  ASSERT_TRUE(master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0);
  Options options;
  options.link = std::string("serial:") + ptsname(master) + "@115200";
  Running robot(options);
  {
    Host host(master);
    host.skip_greeting();
    host.write("C\r");
    EXPECT_EQ(host.read_through("c,3\r\n"), "c,3\r\n");
  }
  ASSERT_TRUE(robot.happened("\"event\":\"end\",\"why\":\"the serial line"));
  EXPECT_THAT(robot.end().error().message, HasSubstr("has gone"));
}

TEST(Emulator, TakesItsTimeForEveryByte) {
  Running robot;
  Host host(robot.path());
  host.skip_greeting();
  const auto asked = Clock::now();
  host.write(std::string_view("\xB7\0", 2));
  EXPECT_EQ(host.read_bytes(3203).size(), 3203U);
  EXPECT_GE(Clock::now() - asked, std::chrono::nanoseconds(3205 * kByteNs)) << "faster than the line";
}

TEST(Emulator, HearsGarbageFromAHostWithAnotherBaudRate) {
  Running robot;
  Host host(robot.path());
  host.skip_greeting();
  host.set_speed(B9600);
  host.write("V\r");
  ASSERT_TRUE(robot.happened("\"event\":\"baud\",\"host\":9600,\"robot\":115200"));
  host.set_speed(B115200);
  host.write(std::string(40, '\0') + "\r" + "C\r");
  const std::string answer = host.read_through("c,3\r\n");
  EXPECT_THAT(answer, HasSubstr("c,3\r\n"));
  EXPECT_EQ(answer.find("v,Version"), std::string::npos) << "it understood a host at the wrong speed";
}

TEST(Emulator, SpeaksGarbageToAHostWithAnotherBaudRate) {
  Running robot;
  Host host(robot.path());
  host.skip_greeting();
  robot.when("\"command\":\"C\"", [&host] { host.set_speed(B57600); });  // between question and answer
  host.write("C\r");
  const std::string answer = "c,3\r\n";
  const std::string got = host.read_bytes(answer.size());
  ASSERT_EQ(got.size(), answer.size());
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NE(got[i], answer[i]) << i;
}

TEST(Emulator, FallsSilentOnDemand) {
  Running robot(Given{.faults = {"silent"}});
  Host host(robot.path());
  host.write("D,100,100\r");
  EXPECT_TRUE(robot.happened("\"event\":\"wheels\",\"left\":100,\"right\":100")) << "mute, not deaf";
  ASSERT_TRUE(robot.end().ok());
  EXPECT_EQ(host.read_bytes(1), "") << "neither greeting nor acknowledgement got through";
  EXPECT_TRUE(host.hung_up);
}

TEST(Emulator, SpeaksAgainAfterItsSilence) {
  Running robot(Given{.faults = {"silent@0s+0.05s"}});
  Host host(robot.path());
  ASSERT_TRUE(robot.happened("\"fault\":\"silent@0s+0.05s\",\"phase\":\"end\""));
  host.write("C\r");
  EXPECT_EQ(host.read_through("c,3\r\n"), "c,3\r\n") << "without the greeting";
}

TEST(Emulator, RestartsOnDemand) {
  Running robot(Given{.faults = {"reset@0.1s"}});
  Host host(robot.path());
  const auto twice = [](const std::string& got) { return got.find("for help\r\n") != got.rfind("for help\r\n"); };
  EXPECT_TRUE(twice(host.read(twice)));
  EXPECT_TRUE(robot.happened("\"event\":\"reset\",\"why\":\"fault\""));
}

TEST(Emulator, TruncatesOneAnswer) {
  Running robot(Given{.faults = {"truncate@0.05s"}});
  Host host(robot.path());
  host.skip_greeting();
  ASSERT_TRUE(robot.happened("\"fault\":\"truncate@0.05s\""));
  host.write(std::string_view("\xB2\0", 2));
  host.write("C\r");
  EXPECT_EQ(host.read_through("c,3\r\n").size(), 8U + 5U);
}

TEST(Emulator, TalksRubbishOnDemand) {
  Running robot(Given{.faults = {"garbage@0.05s+0.1s"}});
  Host host(robot.path());
  host.skip_greeting();
  ASSERT_TRUE(robot.happened("\"phase\":\"end\""));
  host.write("C\r");
  const std::string heard = host.read_through("c,3\r\n");
  EXPECT_GT(heard.size(), 5U) << "noise came unasked";
}

TEST(Emulator, DelaysItsAnswers) {
  Running robot(Given{.faults = {"delay=40ms"}});
  Host host(robot.path());
  host.skip_greeting();
  const auto asked = Clock::now();
  host.write("C\r");
  EXPECT_EQ(host.read_through("c,3\r\n"), "c,3\r\n");
  EXPECT_GE(Clock::now() - asked, std::chrono::milliseconds(40));
}

TEST(Emulator, HasALinkThatIsLateBothWays) {
  Options options;
  options.delays = {.to_robot_s = 0.06, .to_host_s = 0.04};
  Running robot(options);
  Host host(robot.path());
  host.skip_greeting();
  const auto now_ns = [] { return Clock::now().time_since_epoch() / std::chrono::nanoseconds(1); };
  const std::int64_t asked_ns = now_ns();
  host.write("D,100,100\r");
  EXPECT_EQ(host.read_through("d\r\n"), "d\r\n");
  EXPECT_GE(now_ns() - asked_ns, 100 * hal::kNsPerMs);
  ASSERT_TRUE(robot.happened("\"event\":\"wheels\",\"left\":100"));
  const std::string log = robot.log_text();
  const std::size_t line = log.rfind('\n', log.find("\"event\":\"wheels\",\"left\":100")) + 1;
  EXPECT_GE(std::stoll(log.substr(log.find(':', line) + 1)) - asked_ns, 60 * hal::kNsPerMs);
}

TEST(Emulator, HangsUpAndComesBackUnderTheSameName) {
  Running robot(Given{.faults = {"hangup@0.3s+0.1s"}});
  {
    Host host(robot.path());
    host.read([](const std::string&) { return false; });  // until the line is gone
    EXPECT_TRUE(host.hung_up);
  }
  ASSERT_TRUE(robot.happened("\"fault\":\"hangup@0.3s+0.1s\",\"phase\":\"end\""));
  Host again(robot.path());
  again.write("C\r");
  EXPECT_EQ(again.read_through("c,3\r\n"), "c,3\r\n") << "the robot itself was never off";
}

TEST(Emulator, LivesInABodyOfSomebodyElse) {
  HeldBody body;
  BodySenses senses;
  senses.distance_m.fill(0.05);
  Running robot(Given{.body = &body});
  Host host(robot.path());
  host.skip_greeting();
  body.set_senses(senses);
  host.write("N\r");
  EXPECT_EQ(host.read_through("\r\n"), "n,120,120,120,120,120,120,120,120\r\n");
  host.write("D,1000,-500\r");
  EXPECT_EQ(host.read_through("\r\n"), "d\r\n");
  EXPECT_NEAR(body.command().left_m_s, 1000 * (0.041 * std::numbers::pi / 1000), 1e-9);
  EXPECT_NEAR(body.command().right_m_s, -500 * (0.041 * std::numbers::pi / 1000), 1e-9);
}

/// A Python that has pyserial; empty: none. The first python3 of the path may be another than Debian's.
std::string python_with_serial() {
  for (const char* python : {"python3", "/usr/bin/python3"}) {
    if (std::system((std::string(python) + " -c 'import serial' >/dev/null 2>&1").c_str()) == 0) return python;
  }
  return {};
}

TEST(Emulator, UnderstandsAnIndependentSerialLibrary) {
  const std::string python = python_with_serial();
  if (python.empty()) GTEST_SKIP() << "pyserial is not installed (Debian packages: python3 python3-serial)";
  for (const char* firmware : {"gctronic", "epuck2"}) {
    Running robot(Given{.firmware = firmware});
    const std::string command = python + " " + test::kSourceDir + "/tests/bridges/epuck_emulator/serial_peer.py " +
                                robot.path() + " " + firmware;
    const int status = std::system(command.c_str());
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << command;
    EXPECT_TRUE(robot.happened("\"event\":\"wheels\",\"left\":300,\"right\":-200"));
  }
}

}  // namespace
}  // namespace tandem::bridges::epuck_emulator
