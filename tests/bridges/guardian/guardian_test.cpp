// The guardian process with hubs that are killed, frozen and left, and robots that are files: what they were told, and
// when. Waits end with events; limits are longer than any machine needs, but for those that are promised.
#include <chrono>
#include <csignal>
#include <ctime>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <map>
#include <memory>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include "bridges/guardian/abandoned.hpp"
#include "bridges/guardian/client.hpp"
#include "tests/bridges/guardian/runtime_folder.hpp"

#ifdef __SANITIZE_THREAD__
/// A guardian ends at once, and without waiting for its threads: one may be held up by a dead link.
extern "C" const char* __tsan_default_options() {
  return "report_thread_leaks=0:atexit_sleep_ms=0";
}
#endif

namespace tandem::bridges::guardian {
namespace {

namespace fs = std::filesystem;
using hal::kNsPerMs;
using namespace std::chrono_literals;
using hal::TimeNs;
using testing::HasSubstr;

TimeNs now_ns() {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<TimeNs>(t.tv_sec) * hal::kNsPerSecond + t.tv_nsec;
}

bool eventually(const std::function<bool()>& condition, double seconds = 30.0) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream in(path);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// A robot that is a file: a line for all that it was told. Its body says how it behaves: "obeys", "hangs" (in the
/// system, for ever), "deaf" (until there is a file of its name with ".hears").
class FileStopper final : public Stopper {
 public:
  FileStopper(const StopMessages& messages, StopCause cause) : messages_(messages), cause_(cause) {}
  ~FileStopper() override { note("closed"); }

  StopState step(TimeNs) override {
    if (steps_++ == 0) note(cause_ == StopCause::HubGone ? "gone" : "frozen");
    if (messages_.body == "hangs") std::this_thread::sleep_for(std::chrono::seconds(5));
    if (messages_.body == "throws" && steps_ < 5) throw std::runtime_error("no memory");
    const bool deaf = messages_.body == "deaf" && ::access((messages_.link + ".hears").c_str(), F_OK) != 0;
    if (deaf || messages_.body == "hangs") return StopState::Unreachable;
    if (steps_ < 3) return StopState::Stopping;
    note("rests");
    return StopState::Confirmed;
  }
  std::string trouble() const override { return "it does not listen"; }

 private:
  void note(const std::string& what) const {
    const std::string line = what + " " + std::to_string(now_ns()) + "\n";
    const int fd = ::open(messages_.link.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
    (void)!::write(fd, line.data(), line.size());
    ::close(fd);
  }
  StopMessages messages_;
  StopCause cause_;
  int steps_ = 0;
};

std::unique_ptr<Stopper> make_file_stopper(const StopMessages& messages, StopCause cause) {
  return std::make_unique<FileStopper>(messages, cause);
}

/// A robot on a plug: a file that is there as long as it is plugged in; beside it, in PLUG.told, is a line for all that
/// was told to whoever was there. It rests at once. "serial:PLUG", by whatever name; its body "deaf": it does not
/// answer; "moves NAME": after it was told, and before anybody hears that it rests, its name leads to that plug.
class PlugStopper final : public Stopper {
 public:
  PlugStopper(const StopMessages& messages, StopCause) : messages_(messages) {}
  StopState step(TimeNs) override {
    std::error_code error;
    const auto plug = std::filesystem::canonical(messages_.link.substr(messages_.link.find(':') + 1), error);
    if (error) return StopState::Unreachable;
    std::ofstream(plug.string() + ".told", std::ios::app) << "stop" << std::endl;
    if (messages_.body.starts_with("moves ")) {
      const std::filesystem::path link = messages_.link.substr(messages_.link.find(':') + 1);
      std::filesystem::create_symlink(messages_.body.substr(6), link.string() + ".made", error);
      std::filesystem::rename(link.string() + ".made", link, error);
    }
    return messages_.body == "deaf" ? StopState::Unreachable : StopState::Confirmed;
  }
  std::string trouble() const override { return "it is not there"; }

 private:
  StopMessages messages_;
};

std::unique_ptr<Stopper> make_plug_stopper(const StopMessages& messages, StopCause cause) {
  return std::make_unique<PlugStopper>(messages, cause);
}

/// Instrumented, a hub beside other work may be silent for long; one that the system has stopped is noticed at once.
PulseLimits limits() {
  PulseLimits limits;
#ifdef __SANITIZE_THREAD__
  limits.silent_ns = 20 * hal::kNsPerSecond;
  limits.asleep_ns = 3 * hal::kNsPerSecond;
#endif
  return limits;
}

/// Longer by this than what is excused.
void sleep_through(std::chrono::milliseconds longer) {
  std::this_thread::sleep_for(std::chrono::nanoseconds(limits().beat_ns + limits().asleep_ns) + longer);
}

const std::vector<StopperType> kTypes = {{"file", &make_file_stopper}, {"plug", &make_plug_stopper}};

/// A hub in a process of its own, which writes lines for the test, and does what it is told in letters.
class Hub {
 public:
  using Story = std::function<int(Hub&)>;
  Hub(const std::filesystem::path& folder, const Story& story) : lines_(folder / "hub") {
    std::filesystem::remove(lines_);
    if (::pipe2(orders_, O_CLOEXEC) != 0) return;
    pid_ = ::fork();
    if (pid_ != 0) return;
    errors_ = ::open((folder / "errors").c_str(), O_WRONLY | O_APPEND | O_CREAT, 0600);
    ::dup2(errors_, STDERR_FILENO);
    ::_exit(story(*this));
  }
  /// Ends all that the hub has left behind as well: a guardian goes on until its robots have confirmed.
  ~Hub() {
    signal(SIGKILL);
    wait();
    for (const char* begin : {"guardian ", "forked "}) end_left(static_cast<pid_t>(std::atoi(line(begin).c_str())));
    ::close(orders_[0]);
    ::close(orders_[1]);
  }
  Hub(const Hub&) = delete;
  Hub& operator=(const Hub&) = delete;

  // The hub's side.
  void say(const std::string& line) const { std::ofstream(lines_, std::ios::app) << line << std::endl; }
  char order() const {
    char letter = 0;
    while (::read(orders_[0], &letter, 1) < 0) {
    }
    return letter;
  }

  // The test's side.
  void tell(char letter) const { (void)!::write(orders_[1], &letter, 1); }
  /// Only as long as it was not waited for: no other process may get it.
  void signal(int number) const {
    if (pid_ > 0) ::kill(pid_, number);
  }
  bool said(const std::string& line) const {
    return eventually([&] { return ("\n" + text_of(lines_)).find("\n" + line) != std::string::npos; });
  }
  /// The rest of the line that begins so.
  std::string line(const std::string& begin) const {
    const std::string text = "\n" + text_of(lines_);
    const std::size_t at = text.find("\n" + begin);
    return at == std::string::npos
               ? ""
               : text.substr(at + 1 + begin.size(), text.find('\n', at + 1) - at - 1 - begin.size());
  }
  pid_t guardian() const { return static_cast<pid_t>(std::atoi(line("guardian ").c_str())); }
  void signal_guardian(int number) const {
    if (guardian() > 1) ::kill(guardian(), number);
  }
  int wait() {
    if (pid_ > 0) ::waitpid(pid_, &status_, 0);
    pid_ = -1;
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
  }
  pid_t pid() const { return pid_; }

 private:
  /// Nothing happens to a process that is not the hub's: the number may be another's by now.
  static void end_left(pid_t process) {
    const std::string proc = "/proc/" + std::to_string(process);
    const auto gone = [&] {
      const std::string name = text_of(proc + "/comm");
      return (name != "tandem-guard\n" && name != text_of("/proc/self/comm")) ||
             text_of(proc + "/stat").find(") Z ") != std::string::npos;
    };
    if (process <= 1 || gone()) return;
    ::kill(process, SIGKILL);
    EXPECT_TRUE(eventually(gone)) << process;
  }

  std::filesystem::path lines_;
  int orders_[2] = {-1, -1};
  int errors_ = -1;
  pid_t pid_ = -1;
  int status_ = 0;
};

/// Asks for the permit that was granted at first, as a link does before each write, for 3 s of being awake. @returns
/// how often it was granted after a sleep of a second.
int grants_after_freezes(const SendPermit& permit) {
  const std::uint32_t turn = permit.turn();
  int grants = 0;
  bool slept = false;
  TimeNs before = now_ns();
  for (TimeNs awake = 0; awake < 3 * hal::kNsPerSecond;) {
    const TimeNs begin = now_ns();
    slept = slept || begin - before >= hal::kNsPerSecond;
    const bool granted = permit.granted_since(turn);
    before = now_ns();
    const bool asked_awake = before - begin < hal::kNsPerSecond;  // else it may have been granted before the sleep
    grants += slept && granted && asked_awake ? 1 : 0;
    slept = slept || !asked_awake;
    awake += std::min(before - begin, 10 * kNsPerMs);
  }
  return grants;
}

class Guarded : public testing::Test {
 protected:
  StopMessages robot(const std::string& id, const std::string& body = "obeys") const {
    return {id, "file", (runtime_.path() / id).string(), body, 1};
  }
  /// Times at which it was told or noted `what`.
  std::vector<TimeNs> times(const std::string& id, const std::string& what) const {
    std::istringstream in(text_of(runtime_.path() / id));
    std::vector<TimeNs> all;
    std::string word;
    for (TimeNs at = 0; in >> word >> at;) {
      if (word == what) all.push_back(at);
    }
    return all;
  }
  bool was(const std::string& id, const std::string& what, std::size_t count = 1) const {
    return eventually([&] { return times(id, what).size() >= count; });
  }
  /// Kills a hub that drives this many robots, and its guardian, which has heard of all of them and stops none.
  void kill_both(Hub& hub, int robots) const {
    ASSERT_TRUE(hub.said("drives"));
    const auto heard = [&] {
      int count = 0;
      for (const auto& file : fs::directory_iterator(runtime_.path() / "tandem")) {
        const std::string text = file.is_regular_file() ? text_of(file) : "";
        const std::string guardian = "\nguardian " + std::to_string(hub.guardian()) + "\nstate driven\n";
        count += text.find(guardian) != std::string::npos ? 1 : 0;
      }
      return count == robots;
    };
    ASSERT_TRUE(eventually(heard));
    hub.signal_guardian(SIGSTOP);
    hub.signal(SIGKILL);
    hub.signal_guardian(SIGKILL);
    hub.wait();
    ASSERT_TRUE(ended(hub.guardian()));
  }
  void let_hear(const std::string& id) const { std::ofstream(runtime_.path() / (id + ".hears")) << ""; }
  std::string errors() const { return text_of(runtime_.path() / "errors"); }
  /// Also one for which its parent has not waited yet: what it had open is closed.
  bool ended(pid_t process) const {
    return eventually([&] {
      const std::string stat = text_of("/proc/" + std::to_string(process) + "/stat");
      return stat.empty() || stat.find(") Z ") != std::string::npos;
    });
  }
  bool gone(pid_t process) const {
    return eventually([&] { return ::kill(process, 0) != 0; });
  }

  /// Drives these robots, and does as it is told: 'r' releases the first, 'e' ends, 'f' forks a child that keeps all
  /// descriptors, 'n' tells the news, 'v' renews the stop messages of the first, 'c' claims that anew, 'o' on another
  /// link.
  Hub::Story drives(std::vector<StopMessages> robots, std::atomic<bool>* suspend = nullptr) const {
    return [robots, suspend](Hub& hub) mutable {
      auto started = GuardianClient::start(kTypes, {suspend, limits()});
      if (!started.ok()) return 99;
      GuardianClient& guardian = **started;
      if (const auto claimed = guardian.claim(robots); !claimed.ok()) {
        hub.say("refused " + claimed.error().message);
        return 98;
      }
      for (const StopMessages& r : robots) guardian.watch(r);
      hub.say("guardian " + std::to_string(guardian.process()));
      hub.say("drives");
      for (std::uint64_t freezes = 0;;) {
        switch (hub.order()) {
          case 'r':
            guardian.release(robots.front().robot);
            break;
          case 'f':
            if (const pid_t child = ::fork(); child == 0) {
              std::this_thread::sleep_for(std::chrono::seconds(20));
              ::_exit(0);
            } else {
              hub.say("forked " + std::to_string(child));
            }
            break;
          case 'w':  // waits for a freeze to be over
            eventually([&] { return guardian.freezes().count > freezes && guardian.permit().granted(); });
            freezes = guardian.freezes().count;
            hub.say("back " + std::to_string(guardian.freezes().last_ns / kNsPerMs) + " " +
                    std::to_string(guardian.permit().turn()));
            break;
          case 'u':  // waits for being unguarded, and guarded again
            hub.say(eventually([&] { return !guardian.guards(); }) ? "unguarded" : "guarded");
            hub.say(eventually([&] { return guardian.guards(); }) ? "guarded again" : "unguarded for long");
            break;
          case 'p':
            hub.say("speaks");
            hub.say("after freezes " + std::to_string(grants_after_freezes(guardian.permit())));
            break;
          case 'v':  // a module came
            robots.front().version++;
            guardian.watch(robots.front());
            break;
          case 'n':
            for (const std::string& line : guardian.take_news()) hub.say("news " + line);
            hub.say("freezes " + std::to_string(guardian.freezes().count));
            break;
          case 'o':
            robots.front().link += "-other";
            [[fallthrough]];
          case 'c':
            if (const auto claimed = guardian.claim({robots.data(), 1}); claimed.ok()) {
              guardian.watch(robots.front());
              hub.say("claimed " + robots.front().link);
            } else {
              hub.say("refused " + claimed.error().message);
            }
            break;
          case 'e': {
            const auto unstopped = guardian.end(hal::kNsPerSecond);
            for (const UnstoppedRobot& r : unstopped) hub.say("unstopped " + r.robot + ": " + r.trouble);
            return static_cast<int>(unstopped.size());
          }
          default:
            return 97;
        }
      }
    };
  }

  RuntimeFolder runtime_;
};

TEST_F(Guarded, RobotsAreAllStoppedAtOnceWhenTheirHubIsKilled) {
  std::vector<StopMessages> robots;
  for (int i = 0; i < 50; ++i) {
    robots.push_back(robot("r" + std::to_string(i), i % 5 != 0 ? "obeys" : i % 10 == 0 ? "hangs" : "deaf"));
  }
  Hub hub(runtime_.path(), drives(robots));
  ASSERT_TRUE(hub.said("drives"));
  const pid_t guardian = hub.guardian();
  const TimeNs killed = now_ns();
  hub.signal(SIGKILL);
  hub.wait();
  for (const StopMessages& r : robots) {
    ASSERT_TRUE(was(r.robot, "gone")) << r.robot;
    EXPECT_LE(times(r.robot, "gone").front() - killed, 250 * kNsPerMs) << r.robot;
    EXPECT_TRUE(r.body != "obeys" || was(r.robot, "rests")) << r.robot;
  }
  EXPECT_TRUE(eventually([&] { return errors().find("kill " + std::to_string(guardian)) != std::string::npos; }));
  EXPECT_THAT(errors(), HasSubstr("not stopped yet: 'r0' on "));
  EXPECT_THAT(errors(), HasSubstr("'r5' on " + robots[5].link + " (it does not listen)"));
  EXPECT_THAT(errors(), testing::Not(HasSubstr("'r1' on")));
  // Nothing but a person ends it as long as robots have not confirmed.
  hub.signal_guardian(SIGHUP);
  hub.signal_guardian(SIGTSTP);
  EXPECT_EQ(::kill(guardian, 0), 0);
  hub.signal_guardian(SIGTERM);
  EXPECT_TRUE(gone(guardian));
  EXPECT_THAT(errors(), HasSubstr("see to these robots by hand"));
}

TEST_F(Guarded, RobotIsStoppedUntilItConfirmsHoweverLongThatTakes) {
  Hub hub(runtime_.path(), drives({robot("r", "deaf"), robot("thrower", "throws")}));
  ASSERT_TRUE(hub.said("drives"));
  const pid_t guardian = hub.guardian();
  hub.signal(SIGKILL);
  hub.wait();
  ASSERT_TRUE(was("thrower", "rests"));
  ASSERT_TRUE(eventually([&] { return !errors().empty(); }));
  EXPECT_TRUE(times("r", "rests").empty());
  const TimeNs reachable = now_ns();
  let_hear("r");
  ASSERT_TRUE(was("r", "rests"));
  EXPECT_LE(times("r", "rests").front() - reachable, hal::kNsPerSecond);
  EXPECT_TRUE(gone(guardian));
  EXPECT_THAT(errors(), HasSubstr("all robots have confirmed their stop"));
  EXPECT_TRUE(std::filesystem::is_empty(runtime_.path() / "tandem"));
}

TEST_F(Guarded, RobotIsStoppedThoughAChildOfItsHubKeepsAllDescriptors) {
  Hub hub(runtime_.path(), drives({robot("r")}));
  ASSERT_TRUE(hub.said("drives"));
  hub.tell('f');
  ASSERT_TRUE(hub.said("forked"));
  const TimeNs killed = now_ns();
  hub.signal(SIGKILL);
  hub.wait();
  ASSERT_TRUE(was("r", "rests"));
  EXPECT_LE(times("r", "gone").front() - killed, 250 * kNsPerMs);
}

TEST_F(Guarded, RobotIsStoppedWhenItsHubIsFrozenAndTheHubKnowsWhenItIsBack) {
  Hub hub(runtime_.path(), drives({robot("r"), robot("deaf", "deaf")}));
  ASSERT_TRUE(hub.said("drives"));
  const pid_t guardian = hub.guardian();
  const TimeNs frozen = now_ns();
  hub.signal(SIGSTOP);
  ASSERT_TRUE(was("r", "rests"));
  EXPECT_LE(times("r", "frozen").front() - frozen, 500 * kNsPerMs);
  const auto open = [&](const std::string& id) { return times(id, "frozen").size() - times(id, "closed").size(); };
  EXPECT_TRUE(eventually([&] { return open("r") == 0; }));
  EXPECT_TRUE(eventually([&] { return open("deaf") == 1U; }));  // it is still tried to be stopped
  hub.tell('w');
  hub.signal(SIGCONT);
  // What the hub may have written while it woke up is followed by one more stop; then all links are closed.
  ASSERT_TRUE(hub.said("back "));
  EXPECT_EQ(times("r", "rests").size(), 2U);
  EXPECT_EQ(open("r"), 0U);
  EXPECT_EQ(open("deaf"), 0U);
  std::istringstream back(hub.line("back "));
  TimeNs lasted_ms = 0, turn = 0;
  back >> lasted_ms >> turn;
  EXPECT_GE(lasted_ms, 80);
  EXPECT_LE(lasted_ms, (now_ns() - frozen) / kNsPerMs);
  EXPECT_EQ(turn % 2, 0) << "the hub's again";
  EXPECT_GT(turn, 0);
  hub.tell('v');  // nothing of the hub's turn has the guardian stop anybody
  hub.tell('n');
  ASSERT_TRUE(hub.said("freezes 1"));
  EXPECT_THAT(hub.line("news this program was frozen for"),
              HasSubstr("its guardian process has stopped all real robots"));
  EXPECT_EQ(times("r", "frozen").size(), 2U);
  // It happens again; and this time the hub does not come back.
  hub.signal(SIGSTOP);
  ASSERT_TRUE(was("r", "rests", 3));
  hub.signal(SIGKILL);
  hub.wait();
  ASSERT_TRUE(was("r", "rests", 4));
  EXPECT_EQ(times("r", "gone").size(), 1U);
  let_hear("deaf");
  EXPECT_TRUE(was("deaf", "rests"));
  EXPECT_TRUE(gone(guardian));
}

TEST_F(Guarded, RobotsAreStoppedBeforeTheHubSleepsWhenThatIsAsked) {
  static std::atomic<bool> asked{false};
  const auto story = drives({robot("r")}, &asked);
  Hub hub(runtime_.path(), [&](Hub& h) {
    ::signal(SIGTSTP, [](int) { asked = true; });
    return story(h);
  });
  ASSERT_TRUE(hub.said("drives"));
  hub.signal(SIGTSTP);
  int status = 0;
  ASSERT_EQ(::waitpid(hub.pid(), &status, WUNTRACED), hub.pid());
  ASSERT_TRUE(WIFSTOPPED(status));
  EXPECT_EQ(times("r", "rests").size(), 1U);
  hub.tell('w');
  hub.signal(SIGCONT);
  ASSERT_TRUE(hub.said("back "));
  EXPECT_EQ(times("r", "rests").size(), 2U);
  hub.tell('r');
  hub.tell('e');
  EXPECT_EQ(hub.wait(), 0);
}

TEST_F(Guarded, HubKnowsThatItsGuardianIsFrozenAndTheGuardianStopsAllWhenItIsBack) {
  Hub hub(runtime_.path(), drives({robot("r")}));
  ASSERT_TRUE(hub.said("drives"));
  hub.tell('u');
  hub.signal_guardian(SIGSTOP);
  ASSERT_TRUE(hub.said("unguarded"));
  EXPECT_TRUE(times("r", "frozen").empty());
  sleep_through(200ms);
  hub.signal_guardian(SIGCONT);
  ASSERT_TRUE(hub.said("guarded again"));
  ASSERT_TRUE(was("r", "rests")) << text_of(runtime_.path() / "r") << text_of(runtime_.path() / "hub") << errors();
  hub.tell('w');
  ASSERT_TRUE(hub.said("back "));
  hub.tell('n');
  ASSERT_TRUE(hub.said("freezes "));
  EXPECT_GE(std::atoi(hub.line("freezes ").c_str()), 1) << "nothing may move until it is re-armed";
  EXPECT_THAT(hub.line("news the guardian process is frozen"), HasSubstr("nobody would stop real robots"));
  EXPECT_THAT(hub.line("news the guardian process was frozen for"), HasSubstr("stops all real robots once more"));
}

class FrozenTogether : public Guarded, public testing::WithParamInterface<bool> {};
INSTANTIATE_TEST_SUITE_P(GuardianWakesFirst, FrozenTogether, testing::Bool());

TEST_P(FrozenTogether, AHubWritesToNoLinkThatWasOpenWhoeverWakesFirst) {
  Hub hub(runtime_.path(), drives({robot("r")}));
  ASSERT_TRUE(hub.said("drives"));
  hub.tell('p');
  ASSERT_TRUE(hub.said("speaks"));
  const auto signal = [&](int number, bool guardian) { guardian ? hub.signal_guardian(number) : hub.signal(number); };
  // Both within a few milliseconds: neither has noticed that the other one is frozen.
  signal(SIGSTOP, GetParam());
  signal(SIGSTOP, !GetParam());
  sleep_through(1s);
  signal(SIGCONT, GetParam());
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  signal(SIGCONT, !GetParam());
  ASSERT_TRUE(hub.said("after freezes "));
  EXPECT_EQ(hub.line("after freezes "), "0");
  EXPECT_TRUE(was("r", "rests"));
  hub.tell('n');
  ASSERT_TRUE(hub.said("freezes "));
  EXPECT_GE(std::atoi(hub.line("freezes ").c_str()), 1);
}

class DeadInItsTurn : public Guarded, public testing::WithParamInterface<bool> {};
INSTANTIATE_TEST_SUITE_P(BeforeTheHubWakes, DeadInItsTurn, testing::Bool());

TEST_P(DeadInItsTurn, AHubStopsItsRobotsItself) {
  Hub hub(runtime_.path(), drives({robot("r", "deaf")}));
  ASSERT_TRUE(hub.said("drives"));
  hub.signal(SIGSTOP);
  ASSERT_TRUE(was("r", "frozen"));
  hub.signal_guardian(SIGKILL);
  // Its end has been seen to, or not yet, when the hub looks.
  if (GetParam()) {
    EXPECT_TRUE(ended(hub.guardian()));
  }
  hub.tell('w');
  hub.signal(SIGCONT);
  ASSERT_TRUE(hub.said("back "));
  const std::string back = hub.line("back ");
  EXPECT_EQ(std::atoi(back.substr(back.find(' ')).c_str()) % 2, 0) << "nobody else can stop them: it may write again";
}

TEST_F(Guarded, RobotThatWasReleasedIsLeftAlone) {
  Hub hub(runtime_.path(), drives({robot("r"), robot("s")}));
  ASSERT_TRUE(hub.said("drives"));
  const pid_t guardian = hub.guardian();
  hub.tell('r');
  hub.tell('n');
  ASSERT_TRUE(hub.said("freezes"));
  hub.signal(SIGKILL);
  hub.wait();
  ASSERT_TRUE(was("s", "rests"));
  EXPECT_TRUE(gone(guardian));
  EXPECT_EQ(text_of(runtime_.path() / "r"), "");
}

TEST_F(Guarded, RobotThatWasReleasedMayBeClaimedAnewAlsoOnAnotherLink) {
  Hub hub(runtime_.path(), drives({robot("r"), robot("s")}));
  ASSERT_TRUE(hub.said("drives"));
  const pid_t guardian = hub.guardian();
  hub.tell('c');
  ASSERT_TRUE(hub.said("refused robot 'r' is claimed already")) << "it is driven";
  hub.tell('r');
  hub.tell('c');
  ASSERT_TRUE(hub.said("claimed " + robot("r").link + "\n"));
  hub.tell('r');
  hub.tell('o');
  ASSERT_TRUE(hub.said("claimed " + robot("r").link + "-other"));
  hub.signal(SIGKILL);
  hub.wait();
  EXPECT_TRUE(was("r-other", "rests"));
  EXPECT_TRUE(was("s", "rests"));
  EXPECT_TRUE(gone(guardian));
  EXPECT_EQ(text_of(runtime_.path() / "r"), "");
}

TEST_F(Guarded, RobotsThatHaveNotConfirmedAreNamedByAHubThatEndsAndStayGuarded) {
  Hub hub(runtime_.path(), drives({robot("r"), robot("deaf", "deaf")}));
  ASSERT_TRUE(hub.said("drives"));
  const pid_t guardian = hub.guardian();
  hub.tell('e');
  EXPECT_EQ(hub.wait(), 1);
  EXPECT_EQ(hub.line("unstopped "), "deaf: it does not listen");
  EXPECT_EQ(::kill(guardian, 0), 0);
  let_hear("deaf");
  EXPECT_TRUE(was("deaf", "rests"));
  EXPECT_TRUE(gone(guardian));
}

TEST_F(Guarded, GuardianEndsAtOnceWithAHubThatHasReleasedItsRobots) {
  Hub hub(runtime_.path(), drives({robot("r")}));
  ASSERT_TRUE(hub.said("drives"));
  hub.tell('r');
  hub.tell('e');
  EXPECT_EQ(hub.wait(), 0);
  EXPECT_NE(::kill(hub.guardian(), 0), 0);
  EXPECT_EQ(text_of(runtime_.path() / "r"), "");
  EXPECT_EQ(errors(), "");
}

TEST_F(Guarded, RobotHasOneHubAndTheOtherOneIsNamed) {
  Hub hub(runtime_.path(), drives({robot("r")}));
  ASSERT_TRUE(hub.said("drives"));
  StopMessages same = robot("r");
  same.robot = "other name";
  const RuntimeFolder elsewhere;
  ::setenv("XDG_RUNTIME_DIR", runtime_.path().c_str(), 1);
  Hub second(elsewhere.path(), drives({same}));
  EXPECT_EQ(second.wait(), 98);
  EXPECT_EQ(second.line("refused "), "robot 'other name' on " + same.link + " is driven by process " +
                                         std::to_string(hub.pid()) +
                                         ", as 'r'; end that one first, a robot has one hub");
  EXPECT_EQ(text_of(runtime_.path() / "r"), "");
}

TEST_F(Guarded, RobotsOfOneHubHaveLinksOfTheirOwn) {
  StopMessages same = robot("r");
  same.robot = "s";
  Hub hub(runtime_.path(), drives({robot("r"), same}));
  EXPECT_EQ(hub.wait(), 98);
  EXPECT_THAT(hub.line("refused "), HasSubstr("robots 'r' and 's' have the same link"));
}

TEST_F(Guarded, RobotOfAKindThatNobodyCanStopIsRefused) {
  StopMessages strange = robot("r");
  strange.kind = "toaster";
  Hub hub(runtime_.path(), drives({strange}));
  EXPECT_EQ(hub.wait(), 98);
  EXPECT_THAT(hub.line("refused "), HasSubstr("no guardian knows how to stop a robot of the kind 'toaster'"));
}

TEST_F(Guarded, RobotIsTakenOverFromTheGuardianOfAHubThatIsGone) {
  Hub first(runtime_.path(), drives({robot("r", "deaf"), robot("s", "deaf")}));
  ASSERT_TRUE(first.said("drives"));
  const pid_t left = first.guardian();
  first.signal(SIGKILL);
  first.wait();
  ASSERT_TRUE(was("s", "gone"));
  ASSERT_TRUE(eventually([&] { return !errors().empty(); }));
  const RuntimeFolder elsewhere;
  ::setenv("XDG_RUNTIME_DIR", runtime_.path().c_str(), 1);
  StopMessages unknown = robot("r", "");  // this hub has not found out how it is stopped
  Hub second(elsewhere.path(), [&](Hub& h) {
    auto guardian = GuardianClient::start(kTypes);
    const auto claimed = (*guardian)->claim(std::vector{unknown});
    h.say(claimed.ok() ? "claimed" : claimed.error().message);
    return static_cast<int>(h.order());
  });
  ASSERT_TRUE(second.said("claimed"));
  EXPECT_EQ(times("r", "closed").size(), 1U);  // the first guardian has let go of it, and of nothing else
  EXPECT_TRUE(times("s", "closed").empty());
  // The second one knows from the first how it is stopped.
  second.signal(SIGKILL);
  second.wait();
  EXPECT_TRUE(was("r", "gone", 2));
  let_hear("r");
  EXPECT_TRUE(was("r", "rests"));
  EXPECT_EQ(::kill(left, 0), 0);
  let_hear("s");
  EXPECT_TRUE(was("s", "rests"));
  EXPECT_TRUE(gone(left));
}

TEST_F(Guarded, RobotsOfAHubThatWasKilledWithItsGuardianAreToldOfAndStoppedByWhoeverComesNext) {
  {
    Hub hub(runtime_.path(), drives({robot("r"), robot("deaf", "deaf"), robot("s")}));
    ASSERT_NO_FATAL_FAILURE(kill_both(hub, 3));
    EXPECT_TRUE(gone(hub.guardian()));
  }
  EXPECT_TRUE(times("r", "gone").empty());
  Hub next(runtime_.path(), [](Hub& h) {
    for (const StoppedRobot& robot : stop_abandoned(kTypes, hal::kNsPerSecond)) {
      h.say((robot.confirmed ? "confirmed " : "moves ") + robot.abandoned.holder.robot.robot);
      h.say("text " + robot.abandoned.holder.robot.robot + " " + robot.to_text());
    }
    h.say("done");
    return static_cast<int>(h.order());
  });
  ASSERT_TRUE(next.said("done"));
  EXPECT_TRUE(was("r", "rests") && was("s", "rests"));
  EXPECT_TRUE(next.said("confirmed r") && next.said("confirmed s") && next.said("moves deaf"));
  EXPECT_THAT(next.line("text r "), HasSubstr("may have driven on with its last command since 20"));
  EXPECT_THAT(next.line("text r "), HasSubstr("was stopped now, and has confirmed that"));
  EXPECT_THAT(next.line("text deaf "), HasSubstr("has NOT confirmed that: it does not listen; process "));
  // Its guardian goes on with the one that has not confirmed; nobody is told of again.
  Hub third(runtime_.path(), [](Hub& h) {
    h.say("found " + std::to_string(stop_abandoned(kTypes, hal::kNsPerSecond).size()));
    return static_cast<int>(h.order());
  });
  ASSERT_TRUE(third.said("found 0"));
  EXPECT_TRUE(times("deaf", "rests").empty());
  let_hear("deaf");
  EXPECT_TRUE(was("deaf", "rests"));
  EXPECT_TRUE(eventually([&] { return std::filesystem::is_empty(runtime_.path() / "tandem"); }));
}

TEST_F(Guarded, RobotsOfOneNameThatWereLeftAreStoppedAllAtOnceAndNobodyWaitsForOneThatDoesNotListen) {
  constexpr int kRobots = 20;
  const auto line = [](int i) { return "line" + std::to_string(i); };
  std::vector<pid_t> guardians;
  for (int i = 0; i < kRobots; ++i) {
    StopMessages left = robot(line(i), i % 5 == 0 ? "deaf" : "obeys");
    left.robot = "r";
    Hub hub(runtime_.path(), drives({left}));
    ASSERT_NO_FATAL_FAILURE(kill_both(hub, 1));
    guardians.push_back(hub.guardian());
  }
  for (const pid_t guardian : guardians) ASSERT_TRUE(gone(guardian));
  Hub next(runtime_.path(), [](Hub& h) {
    for (const StoppedRobot& robot : stop_abandoned(kTypes, 600 * hal::kNsPerSecond)) {
      h.say((robot.confirmed ? "confirmed " : "moves ") + robot.abandoned.holder.robot.link);
      h.say("text " + robot.to_text());
    }
    h.say("done");
    return static_cast<int>(h.order());
  });
  for (int i = 0; i < kRobots; ++i) ASSERT_TRUE(i % 5 == 0 || was(line(i), "rests")) << i;
  EXPECT_EQ(next.line("confirmed "), "") << "it waits for the deaf ones";
  for (int i = 0; i < kRobots; i += 5) {
    EXPECT_TRUE(times(line(i), "rests").empty()) << i;
    let_hear(line(i));
  }
  ASSERT_TRUE(next.said("done"));
  for (int i = 0; i < kRobots; ++i) {
    EXPECT_TRUE(was(line(i), "rests")) << i;
    EXPECT_TRUE(next.said("confirmed " + robot(line(i)).link + "\n")) << i;
  }
  EXPECT_THAT(next.line("text "), HasSubstr("robot 'r' on "));
  EXPECT_TRUE(eventually([&] { return std::filesystem::is_empty(runtime_.path() / "tandem"); }));
}

/// Plugs in a folder, and robots that are in them.
class Plugs : public Guarded {
 protected:
  void SetUp() override { ::setenv("XDG_RUNTIME_DIR", runtime_.path().c_str(), 1); }
  fs::path plug(const std::string& number) const { return runtime_.path() / ("plug" + number); }
  void plug_in(const std::string& number) const {
    fs::remove(plug(number));
    std::ofstream(plug(number)) << "";
  }
  std::size_t told(const std::string& number) const { return text_of(plug(number).string() + ".told").size(); }
  /// At once, as the system does it: there is no moment without a link of that name.
  void name(const std::string& alias, const std::string& number) const {
    const fs::path made = runtime_.path() / (alias + ".made");
    fs::create_symlink(plug(number), made);
    fs::rename(made, runtime_.path() / alias);
  }
  /// A robot that its hub has found at a plug, by the plug's own name or another one.
  StopMessages found(const std::string& id, const std::string& path, const std::string& number,
                     const std::string& firmware = "Version 1", const std::string& body = "") const {
    StopMessages robot{id, "plug", "serial:" + (runtime_.path() / path).string(), body, 1};
    robot.identity.link = robot.link;
    robot.identity.device = plug(number).string();
    robot.identity.firmware = firmware;
    robot.identity.session = 1;
    return robot;
  }
  bool said(const std::string& text) const {
    return eventually([&] { return errors().find(text) != std::string::npos; });
  }
  /// Another hub, of another person, in the same folder of locks; its own lines go elsewhere.
  std::unique_ptr<Hub> other_hub(const StopMessages& robot) const {
    return std::make_unique<Hub>(elsewhere_.path(), drives({robot}));
  }
  const RuntimeFolder elsewhere_;
};

TEST_F(Plugs, RobotIsNotLetGoWhenAnotherOneGetsItsPlugAndIsStoppedWhereItsNameLeadsLater) {
  plug_in("4");
  name("a", "4");
  Hub first(runtime_.path(), drives({found("A", "a", "4")}));
  ASSERT_TRUE(first.said("drives"));
  const pid_t left = first.guardian();
  fs::remove(plug("4"));  // pulled out while it drives
  first.signal(SIGKILL);
  first.wait();
  ASSERT_TRUE(said("not stopped yet: 'A'"));
  // Another robot, of the same firmware, gets that plug; the old name leads to it. A living hub drives it.
  std::ofstream(runtime_.path() / "b") << "";
  const auto second = [&] {
    fs::rename(runtime_.path() / "b", plug("4"));  // at once a robot that a hub will claim
    auto hub = other_hub(found("B", "plug4", "4"));
    EXPECT_TRUE(hub->said("drives")) << hub->line("refused ");
    return hub;
  }();
  ASSERT_TRUE(said("'A' on serial:" + (runtime_.path() / "a").string() +
                   " has not confirmed its stop: its link leads to another robot now"));
  const std::size_t told_b = told("4");
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_EQ(told("4"), told_b) << "what is meant for A is not told to B, which a hub drives";
  // B's hub ends; whoever is at the plug may be told to rest, but does not confirm for A.
  second->tell('r');
  second->tell('e');
  EXPECT_EQ(second->wait(), 0);
  EXPECT_TRUE(eventually([&] { return told("4") > told_b; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_THAT(errors(), testing::Not(HasSubstr("confirmed their stop")));
  EXPECT_EQ(::kill(left, 0), 0);
  // A comes back elsewhere, under its name.
  plug_in("9");
  name("a", "9");
  EXPECT_TRUE(eventually([&] { return told("9") > 0; }));
  EXPECT_TRUE(gone(left));
  EXPECT_THAT(errors(), HasSubstr("all robots have confirmed their stop"));
}

TEST_F(Plugs, WhatIsHeardAtAPlugCountsForNobodyWhoseNameLeadsElsewhereMeanwhile) {
  plug_in("4");
  plug_in("9");
  name("a", "4");
  Hub hub(runtime_.path(), drives({found("A", "a", "4", "Version 1", "moves plug9")}));
  ASSERT_TRUE(hub.said("drives"));
  const pid_t left = hub.guardian();
  hub.signal(SIGKILL);
  hub.wait();
  EXPECT_TRUE(gone(left));
  EXPECT_GT(told("4"), 0U);
  EXPECT_GT(told("9"), 0U) << "somebody at the plug that was A's before confirmed its stop";
}

TEST_F(Plugs, RobotIsHandedOverByNameToAHubThatFindsTheVerySame) {
  plug_in("4");
  name("a", "4");
  Hub first(runtime_.path(), drives({found("A", "a", "4", "Version 1", "deaf")}));
  ASSERT_TRUE(first.said("drives"));
  const pid_t left = first.guardian();
  first.signal(SIGKILL);
  first.wait();
  ASSERT_TRUE(said("not stopped yet: 'A'"));
  const auto second = other_hub(found("a1", "plug4", "4"));
  ASSERT_TRUE(second->said("drives")) << second->line("refused ");
  EXPECT_TRUE(gone(left));
  EXPECT_THAT(errors(), HasSubstr("'A' on serial:" + (runtime_.path() / "a").string() + " was handed over to process " +
                                  std::to_string(second->pid()) + ", which drives it as 'a1'"));
  EXPECT_THAT(errors(), testing::Not(HasSubstr("confirmed their stop")));
}

TEST_F(Plugs, TwoHubsOfOneRobotOverTwoPlugsAreToldOfOneAnother) {
  plug_in("4");
  plug_in("5");
  StopMessages one = found("A", "plug4", "4"), other = found("B", "plug5", "5");
  one.identity.address = other.identity.address = "Bluetooth 10:00:E8:12:34:56";
  Hub first(runtime_.path(), drives({one}));
  ASSERT_TRUE(first.said("drives"));
  const auto second = other_hub(other);
  ASSERT_TRUE(second->said("refused "));
  EXPECT_THAT(second->line("refused "),
              HasSubstr("is driven by process " + std::to_string(first.pid()) + ", as 'A'; end that one first"));
  // Where the address is found out later, both drive already.
  Hub third(elsewhere_.path(), [other](Hub& h) {
    auto guardian = GuardianClient::start(kTypes, {nullptr, limits()});
    StopMessages unknown = other;
    unknown.identity = {};
    if (const auto claimed = (*guardian)->claim({&unknown, 1}); !claimed.ok()) h.say(claimed.error().message);
    (*guardian)->watch(other);
    eventually([&] {
      const auto news = (*guardian)->take_news();
      for (const std::string& line : news) h.say("news " + line);
      return !news.empty();
    });
    return 0;
  });
  EXPECT_EQ(third.wait(), 0);
  EXPECT_THAT(third.line("news robot 'B' on "), HasSubstr("has the address of 'A' on " + one.link + ", which process " +
                                                          std::to_string(first.pid()) + " drives"));
}

TEST_F(Plugs, RobotOfOtherFirmwareIsNotTheOneThatWasLeft) {
  plug_in("4");
  Hub first(runtime_.path(), drives({found("A", "plug4", "4", "Version 1", "deaf")}));
  ASSERT_TRUE(first.said("drives"));
  const pid_t left = first.guardian();
  first.signal(SIGKILL);
  first.wait();
  ASSERT_TRUE(said("not stopped yet: 'A'"));
  const auto second = other_hub(found("A", "plug4", "4", "Version 2"));
  ASSERT_TRUE(second->said("drives")) << second->line("refused ");
  EXPECT_TRUE(said("its link leads to another robot now, of process " + std::to_string(second->pid())));
  EXPECT_EQ(::kill(left, 0), 0);
}

TEST_F(Guarded, HubKnowsWhenItsGuardianIsGone) {
  Hub hub(runtime_.path(), drives({robot("r")}));
  ASSERT_TRUE(hub.said("drives"));
  hub.signal_guardian(SIGKILL);
  ASSERT_TRUE(eventually([&] {
    hub.tell('n');
    return !hub.line("news the guardian process is gone").empty();
  }));
}

}  // namespace
}  // namespace tandem::bridges::guardian
