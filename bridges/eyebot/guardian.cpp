#include "bridges/eyebot/guardian.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <map>
#include <sstream>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace tandem::bridges::eyebot {
namespace {

constexpr std::int32_t kFarAhead = 1'000'000'000;  // of whatever the hub has said last

/// Lines on the pipe: "+NAME HUB SESSION LAND URL", or with '-' to forget it. Only the URL may hold blanks.
std::string line_of(char sign, const LastWords& w) {
  return sign + w.name + " " + w.hub + " " + std::to_string(w.session) + (w.land ? " 1 " : " 0 ") + w.url + "\n";
}

using Watched = std::map<std::string, LastWords>;

void obey(const std::string& line, Watched& watched) {
  std::istringstream text(line.substr(1));
  LastWords w;
  int land = 0;
  text >> w.name >> w.hub >> w.session >> land;
  text.get();
  std::getline(text, w.url);
  w.land = land != 0;
  if (line[0] == '+') {
    watched[w.name + " " + w.url] = w;
  } else {
    watched.erase(w.name + " " + w.url);
  }
}

/// Speaks to one robot in its hub's name.
class Stand final : private Outbox {
 public:
  explicit Stand(const LastWords& words)
      : inbox_(std::make_shared<Inbox>()),
        driver_(settings_for(words), *inbox_, *this),
        farewell_(farewell_for(words)) {
    auto opened = lcm_bus::LcmLink::open(words.url);
    if (!opened.ok()) return;
    const auto deliver = [inbox = inbox_, name = words.name](const lcm_bus::LcmMessage& m) {
      if (const auto topic = topic_of(name, m.channel)) inbox->deliver(*topic, m.data, m.received_ns);
    };
    if (!opened.value()->subscribe("eyebot/" + words.name + "/[a-z_]+", deliver).ok()) return;
    if (opened.value()->start().ok()) link_ = std::move(opened).value();
  }

  bool done() noexcept { return !link_ || farewell_.step(driver_, lcm_bus::monotonic_ns()); }

 private:
  static DriverSettings settings_for(const LastWords& words) {
    DriverSettings s;
    s.robot.id = s.name = words.name;
    s.hub = words.hub;
    s.session = words.session;
    s.first_seq = kFarAhead;
    s.controlled = true;
    return s;
  }
  static FarewellSettings farewell_for(const LastWords& words) {
    FarewellSettings s;
    s.land = words.land;
    s.find_ns = 3 * hal::kNsPerSecond;
    return s;
  }
  bool publish(const std::string& channel, std::span<const std::byte> data) noexcept override {
    return link_ && link_->publish(channel, data);
  }

  std::shared_ptr<Inbox> inbox_;
  EyebotDriver driver_;
  Farewell farewell_;
  std::shared_ptr<lcm_bus::LcmLink> link_;
};

void bring_down(const Watched& watched) {
  std::vector<std::unique_ptr<Stand>> stands;
  for (const auto& [key, words] : watched) stands.push_back(std::make_unique<Stand>(words));
  for (bool all = false; !all;) {
    all = true;
    for (const auto& stand : stands) all = stand->done() && all;
    const timespec pause{0, static_cast<long>(20 * hal::kNsPerMs)};
    ::nanosleep(&pause, nullptr);
  }
}

[[noreturn]] void guard(int pipe) {
  // Ctrl-C goes to the whole group; the guardian outlives it until the hub has ended.
  for (const int s : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGPIPE}) ::signal(s, SIG_IGN);
  ::setsid();
  ::prctl(PR_SET_NAME, "tandem-guard");
  Watched watched;
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t n = ::read(pipe, buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(n));
    for (std::size_t end; (end = text.find('\n')) != std::string::npos; text.erase(0, end + 1)) {
      if (end > 0) obey(text.substr(0, end), watched);
    }
  }
  bring_down(watched);
  ::_exit(0);
}

}  // namespace

hal::Result<Guardian> Guardian::start() {
  std::array<int, 2> ends{};
  const auto failed = [] {
    return hal::Error{std::string("no guardian process can be made (") + std::strerror(errno) +
                      "): an eye-bot would hover for 10 s before it lands if this program were killed"};
  };
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return failed();
  const pid_t child = ::fork();
  if (child < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    return failed();
  }
  if (child == 0) {
    ::close(ends[1]);
    guard(ends[0]);
  }
  ::close(ends[0]);
  return Guardian(ends[1], child);
}

Guardian::Guardian(Guardian&& other) noexcept : pipe_(other.pipe_), child_(other.child_) {
  other.pipe_ = -1;
  other.child_ = -1;
}

Guardian::~Guardian() {
  if (pipe_ < 0) return;
  ::close(pipe_);  // robots that were not released are now brought down
  ::waitpid(child_, nullptr, 0);
}

void Guardian::watch(const LastWords& words) {
  say(line_of('+', words));
}

void Guardian::release(const LastWords& words) {
  say(line_of('-', words));
}

void Guardian::say(const std::string& line) {
  for (std::size_t at = 0; at < line.size();) {
    const ssize_t n = ::write(pipe_, line.data() + at, line.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;  // the guardian is gone
    at += static_cast<std::size_t>(n);
  }
}

}  // namespace tandem::bridges::eyebot
