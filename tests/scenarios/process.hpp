// Programs as a user starts them: arguments, a folder, what they print, how they end.
#pragma once
#include <algorithm>
#include <chrono>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <sched.h>
#include <signal.h>
#include <spawn.h>
#include <sstream>
#include <string>
#include <sys/mount.h>
#include <sys/wait.h>
#include <thread>
#include <time.h>
#include <unistd.h>
#include <vector>

#include "tests/checkout.hpp"

namespace tandem::scenarios {

namespace fs = std::filesystem;

inline std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// On the clock of the robots' logs.
inline long long monotonic_ns() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<long long>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

/// Looks at `condition` every few milliseconds until it holds or `seconds` are over.
inline bool eventually(const std::function<bool()>& condition, double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  for (;;) {
    if (condition()) return true;
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// A folder of its own, removed at the end.
class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "tandem_XXXXXX").string();
    path_ = mkdtemp(pattern.data());
  }
  /// A guardian that outlives its hub may still be writing here: what it leaves behind then stays.
  ~Folder() {
    std::error_code error;
    for (int i = 0; i < 100 && fs::exists(path_, error); ++i) fs::remove_all(path_, error);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const fs::path& path() const { return path_; }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }

 private:
  fs::path path_;
};

/// From here on /dev/pts begins with 0, for this program and what it starts. False: this machine does not permit it.
inline bool own_terminals() {
  static const bool own = ::unshare(CLONE_NEWNS) == 0 &&
                          ::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                          ::mount("devpts", "/dev/pts", "devpts", 0, "newinstance,ptmxmode=0666,mode=0620") == 0 &&
                          ::mount("/dev/pts/ptmx", "/dev/ptmx", nullptr, MS_BIND, nullptr) == 0;
  return own;
}

/// What the robots of this process are is nobody else's business: their locks are in a folder of its own, unless the
/// test says where, so that nobody stops what its programs leave behind when they are killed, nor does the next run of
/// the same test; and so are their terminals, or a hub that tries to find a robot again, whose emulator is gone, could
/// write to the terminal or the robot of another test that was given its number meanwhile.
inline void stand_apart() {
  static const Folder folder;
  const char* const set = std::getenv("XDG_RUNTIME_DIR");
  const bool by_ctest = set != nullptr && std::string_view(set).starts_with(test::kBuildDir);
  if (set == nullptr || by_ctest) ::setenv("XDG_RUNTIME_DIR", folder.path().c_str(), 1);
  (void)own_terminals();
}

/// The words that start `tandem`: built for another architecture, it needs an emulator, and so does this test itself.
inline std::vector<std::string> tandem_words() {
  std::vector<std::string> words;
#ifdef TANDEM_EMULATOR
  std::istringstream in(TANDEM_EMULATOR);
  for (std::string word; in >> word;) words.push_back(word);
#endif
  words.push_back(std::string(test::kBuildDir) + "/bin/tandem");
  return words;
}

/// Processes whose environment has `mark`, but for those that are dead and not yet waited for: what a program has
/// started carries what was in its own.
inline std::vector<pid_t> processes_marked(const std::string& mark) {
  std::vector<pid_t> all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc", error)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string text = text_of(entry.path() / "environ");  // empty, where the process is another user's, or dead
    if (text.find(mark) != std::string::npos) all.push_back(std::stoi(name));
  }
  return all;
}

/// What each thread of a process does now, a line each, for the message of a test that waited in vain: its name, state,
/// where in the kernel it sleeps, the signals that wait for it.
inline std::string threads_of(pid_t process) {
  std::string all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator("/proc/" + std::to_string(process) + "/task", error)) {
    const std::string status = text_of(entry.path() / "status");
    std::string line = entry.path().filename().string();
    for (const char* const key : {"Name:", "State:", "SigPnd:", "ShdPnd:", "SigBlk:"}) {
      const std::size_t at = status.find(key);
      if (at != std::string::npos) line += " " + status.substr(at, status.find('\n', at) - at);
    }
    all += line + " wchan " + text_of(entry.path() / "wchan") + " syscall " + text_of(entry.path() / "syscall");
  }
  return all;
}

/// A running `tandem`. Killed, if need be, when this ends, with all that it has left behind: a guardian goes on until
/// its robots have confirmed their stop, and a test's robots may be gone.
class Tandem {
 public:
  Tandem(std::vector<std::string> arguments, const fs::path& folder) : folder_(folder) {
    stand_apart();
    static int count = 0;
    output_ = folder / ("out" + std::to_string(++count));
    errors_ = folder / ("err" + std::to_string(count));
    const std::vector<std::string> words = tandem_words();
    arguments.insert(arguments.begin(), words.begin(), words.end());
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    mark_ = "TANDEM_TEST_PROCESS=" + std::to_string(getpid()) + "." + std::to_string(count) + ".";
    std::vector<char*> environment;
    for (char** e = environ; *e != nullptr; ++e) environment.push_back(*e);
    environment.push_back(mark_.data());
    environment.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, output_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addopen(&actions, 2, errors_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    if (posix_spawnp(&pid_, argv[0], &actions, nullptr, argv.data(), environment.data()) != 0) pid_ = -1;
    posix_spawn_file_actions_destroy(&actions);
  }
  ~Tandem() {
    if (pid_ > 0 && !ended_) {
      kill(pid_, SIGKILL);  // also where it is stopped
      waitpid(pid_, nullptr, 0);
    }
    end_what_is_left();
  }
  Tandem(const Tandem&) = delete;
  Tandem& operator=(const Tandem&) = delete;

  void signal(int number) const {
    if (pid_ > 0 && !ended_) kill(pid_, number);
  }

  /// Whether it has a handler for this signal by now.
  bool catches(int number) const {
    const std::string status = text_of("/proc/" + std::to_string(pid_) + "/status");
    const std::size_t at = status.find("SigCgt:");
    if (at == std::string::npos) return false;
    return (std::strtoull(status.c_str() + at + 7, nullptr, 16) >> (number - 1) & 1U) != 0;
  }

  /// Whether the system has suspended it.
  bool suspended() const {
    const std::string stat = text_of("/proc/" + std::to_string(pid_) + "/stat");
    const std::size_t end = stat.rfind(')');
    return end != std::string::npos && stat.compare(end, 3, ") T") == 0;
  }

  /// Exit code, or -signal; -1000 when it did not end within `seconds`: by default the time after which it is taken to
  /// hang, which is no promise. With ten processes to each processor a run of 1 s takes half a minute.
  int wait(double seconds = 100.0) {
    if (ended_) return code_;
    int status = 0;
    if (!eventually([&] { return ended_ = waitpid(pid_, &status, WNOHANG) == pid_; }, seconds)) return -1000;
    if (WIFEXITED(status))
      code_ = WEXITSTATUS(status);
    else if (WIFSIGNALED(status))
      code_ = -WTERMSIG(status);
    return code_;
  }
  std::string threads() const { return threads_of(pid_); }
  std::string output() const { return text_of(output_); }
  std::string errors() const { return text_of(errors_); }

  /// The process that stops its robots when it is gone; -1: there is none.
  pid_t guardian() const {
    for (const pid_t process : processes_marked(mark_)) {
      if (text_of("/proc/" + std::to_string(process) + "/comm") == "tandem-guard\n") return process;
    }
    return -1;
  }

 private:
  void end_what_is_left() const {
    const auto none = [this] {
      const auto left = processes_marked(mark_);
      for (const pid_t process : left) kill(process, SIGKILL);
      return left.empty();
    };
    if (!eventually(none, 10.0)) ADD_FAILURE() << "a process of " << mark_ << " cannot be ended";
  }

  fs::path folder_, output_, errors_;
  std::string mark_;
  pid_t pid_ = -1;
  bool ended_ = false;
  int code_ = 0;
};

/// The value behind "key": in flat JSON; empty when it is not there.
inline std::string json_value(const std::string& json, const std::string& key, std::size_t from = 0) {
  const std::string mark = "\"" + key + "\":";
  std::size_t at = json.find(mark, from);
  if (at == std::string::npos) return {};
  at = json.find_first_not_of(' ', at + mark.size());
  if (json[at] == '"') return json.substr(at + 1, json.find('"', at + 1) - at - 1);
  return json.substr(at, json.find_first_of(",}]\n", at) - at);
}

/// An emulated robot with its own log: the witness.
class EmulatedRobot {
 public:
  bool ready() const { return ready_; }
  void signal(int number) const { process_->signal(number); }
  bool suspended() const { return process_->suspended(); }
  /// Its whole lines so far: it may be writing another.
  const std::string& log() const {
    if (!file_.is_open()) file_.open(folder_.path() / "witness.jsonl");
    file_.clear();
    std::ostringstream more;
    more << file_.rdbuf();
    unfinished_ += more.str();
    const std::size_t whole = unfinished_.rfind('\n') + 1;
    log_.append(unfinished_, 0, whole);
    unfinished_.erase(0, whole);
    return log_;
  }
  /// Ends it as a user does, so that its log is whole.
  int end() {
    process_->signal(SIGINT);
    return process_->wait();
  }

  struct Wheels {
    long long t_ns;
    int left, right;
  };
  /// Every wheel command that the firmware obeyed, as it received it.
  std::vector<Wheels> wheels() const {
    read_events();
    return wheels_;
  }
  /// Since when its wheels have been commanded to stand, by the last such command; -1: they are not.
  long long stands_since() const {
    long long since = -1;
    for (const Wheels& w : wheels()) {
      if (w.left != 0 || w.right != 0)
        since = -1;
      else if (since < 0)
        since = w.t_ns;
    }
    return since;
  }

  /// A turn of its program that began too late, and by how much.
  struct Late {
    long long t_ns;
    double by_ms;
  };
  std::vector<Late> lates() const {
    read_events();
    return lates_;
  }
  /// How long its program was kept from running between these times, by its own log; and what it does not tell of (20
  /// ms). A verdict on what the robot should have done by then adds it to what is promised.
  long long late_ns(long long from_ns, long long until_ns) const {
    long long sum_ns = kUntold_ns;
    for (const Late& late : lates()) {
      const auto by_ns = static_cast<long long>(late.by_ms * 1e6);
      sum_ns += std::max(0LL, std::min(late.t_ns, until_ns) - std::max(late.t_ns - by_ns, from_ns));
    }
    return sum_ns;
  }

  /// When a fault, as written, began or ended ("begin", "end"), for the last time; -1: it has not.
  long long fault_ns(const std::string& fault, const std::string& phase) const {
    const std::string mark = "\"fault\":\"" + fault + "\",\"phase\":\"" + phase + "\"";
    const std::string& all = log();
    const std::size_t at = all.rfind(mark);
    return at == std::string::npos ? -1 : std::stoll(json_value(all, "t_ns", all.rfind('\n', at) + 1));
  }
  bool moves() const {
    read_events();
    return !wheels_.empty() && (wheels_.back().left != 0 || wheels_.back().right != 0);
  }
  bool has_moved() const {
    read_events();
    for (const Wheels& w : wheels_) {
      if (w.left != 0 || w.right != 0) return true;
    }
    return false;
  }

 protected:
  EmulatedRobot(const Folder& folder, const std::string& robot, const std::string& link,
                const std::vector<std::string>& more)
      : folder_(folder) {
    std::vector<std::string> arguments = {"emulate", robot, "--link", link, "--log", "witness.jsonl"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    process_ = std::make_unique<Tandem>(arguments, folder.path());
    ready_ = eventually([&] { return process_->errors().find("Ctrl-C ends it") != std::string::npos; }, 10.0);
  }
  std::string errors() const { return process_->errors(); }

 private:
  static constexpr long long kUntold_ns = 20'000'000;

  /// Takes over what the log tells since the last time.
  void read_events() const {
    const std::string& all = log();
    while (read_ < all.size()) {
      const std::size_t end = all.find('\n', read_);
      const std::string line = all.substr(read_, end - read_);
      read_ = end + 1;
      if (line.find("\"event\":\"wheels\"") != std::string::npos)
        wheels_.push_back({std::stoll(json_value(line, "t_ns")), std::stoi(json_value(line, "left")),
                           std::stoi(json_value(line, "right"))});
      if (line.find("\"event\":\"late\"") != std::string::npos)
        lates_.push_back({std::stoll(json_value(line, "t_ns")), std::stod(json_value(line, "by_ms"))});
    }
  }

  const Folder& folder_;
  // The log, and what was taken from it: it is long, and asked for every few milliseconds.
  mutable std::ifstream file_;
  mutable std::string log_, unfinished_;
  mutable std::size_t read_ = 0;  // of `log_`
  mutable std::vector<Wheels> wheels_;
  mutable std::vector<Late> lates_;
  std::unique_ptr<Tandem> process_;
  bool ready_ = false;
};

/// Whether the robot stood within what is promised after `from_ns`; its program's own lateness does not count.
inline testing::AssertionResult stood_within(long long promised_ns, const EmulatedRobot& robot, long long from_ns,
                                             long long stood_ns) {
  const long long late_ns = robot.late_ns(from_ns, stood_ns);
  if (stood_ns >= from_ns && stood_ns - from_ns <= promised_ns + late_ns) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "after " << (stood_ns - from_ns) / 1'000'000
                                     << " ms, of which its program was late " << late_ns / 1'000'000
                                     << " ms; promised are " << promised_ns / 1'000'000 << " ms";
}

/// Whether a robot is told to stand by now, or within 250 ms: a person's stop has just been answered.
inline testing::AssertionResult stands_at_once(const EmulatedRobot& robot) {
  const long long answered_ns = monotonic_ns();
  if (!eventually([&] { return robot.stands_since() > 0; }, 20.0)) return testing::AssertionFailure() << "it moves";
  const long long stood_ns = std::max(answered_ns, robot.stands_since());
  return stood_within(250'000'000, robot, answered_ns, stood_ns);
}

/// Whether the one robot of this hub stands until a person re-arms it, and goes on then. `moves`: by its own log.
inline testing::AssertionResult waits_for_a_person(const Tandem& hub, const std::function<bool()>& moves) {
  if (!eventually([&] { return hub.errors().find("waits to be re-armed") != std::string::npos; }, 30.0))
    return testing::AssertionFailure() << "it waits for nobody: " << hub.errors();
  if (eventually(moves, 1.5)) return testing::AssertionFailure() << "it goes on by itself: " << hub.errors();
  const auto goes_on = [&] {
    hub.signal(SIGUSR1);
    return eventually(moves, 0.5);
  };
  if (!eventually(goes_on, 20.0)) return testing::AssertionFailure() << "re-armed, it stands: " << hub.errors();
  return testing::AssertionSuccess();
}

/// On a pseudo-terminal "ep0" in `folder`.
class EmulatedEpuck : public EmulatedRobot {
 public:
  explicit EmulatedEpuck(const Folder& folder, const std::vector<std::string>& more = {})
      : EmulatedRobot(folder, "epuck", "pty:ep0", more) {}
};

/// Behind an adapter on a pseudo-terminal "fb0" in `folder`, or behind a port of its own.
class EmulatedFootbot : public EmulatedRobot {
 public:
  explicit EmulatedFootbot(const Folder& folder, const std::vector<std::string>& more = {},
                           const std::string& link = "pty:fb0")
      : EmulatedRobot(folder, "footbot", link, more) {}
  /// What a host gives as its link.
  std::string link() const {
    const std::string text = errors();
    const std::size_t at = text.find("--link ") + 7;
    return text.substr(at, text.find(';', at) - at);
  }
};

/// On a network; this program must be in one that is its own.
class EmulatedEyebot : public EmulatedRobot {
 public:
  static constexpr const char* kLink = "lcm:udpm://239.255.76.67:7667?ttl=0";
  explicit EmulatedEyebot(const Folder& folder, const std::vector<std::string>& more = {})
      : EmulatedRobot(folder, "eyebot", kLink, more) {}

  /// Lines of the log about this event that hold all of `parts`.
  std::vector<std::string> lines(const std::string& event, const std::vector<std::string>& parts = {}) const {
    std::vector<std::string> all;
    std::istringstream in(log());
    for (std::string line; std::getline(in, line);) {
      bool fits = json_value(line, "event") == event;
      for (const std::string& part : parts) fits = fits && line.find(part) != std::string::npos;
      if (fits) all.push_back(line);
    }
    return all;
  }
  /// "off idle takeoff …", as they changed from `t_ns` on.
  std::string modes(long long since_ns = 0) const {
    std::string all;
    for (const std::string& line : lines("mode")) {
      if (std::stoll(json_value(line, "t_ns")) >= since_ns) all += json_value(line, "to") + " ";
    }
    return all;
  }
  std::string mode() const {
    const auto all = lines("mode");
    return all.empty() ? "off" : json_value(all.back(), "to");
  }
};

}  // namespace tandem::scenarios
