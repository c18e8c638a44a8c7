#include "bridges/footbot/guardian.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <map>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bridges/aseba/message_link_text.hpp"

namespace tandem::bridges::footbot {
namespace {

/// Lines on the pipe: "+LINK" begins anew what is to be said there, "=LINK TYPE BYTES" adds a message in hexadecimal
/// digits, "-LINK" forgets it. Links hold no blanks that matter here: the last two blanks count.
std::string text_of(const std::string& link, const LastWords& words) {
  std::string line = "=" + link + " " + std::to_string(words.type) + " ";
  std::array<char, 3> digits{};
  for (const std::uint8_t byte : words.payload) {
    std::snprintf(digits.data(), digits.size(), "%02x", byte);
    line += digits.data();
  }
  return line;
}

using Watched = std::map<std::string, std::vector<LastWords>>;

void obey(const std::string& line, Watched& watched) {
  const std::string rest = line.substr(1);
  if (line[0] == '+') {
    watched[rest].clear();
  } else if (line[0] == '-') {
    watched.erase(rest);
  } else {
    const std::size_t last = rest.rfind(' ');
    const std::size_t first = last == 0 || last == std::string::npos ? last : rest.rfind(' ', last - 1);
    if (first == std::string::npos) return;
    LastWords words;
    words.type = static_cast<std::uint16_t>(std::strtoul(rest.c_str() + first, nullptr, 10));
    for (std::size_t i = last + 1; i + 1 < rest.size(); i += 2) {
      words.payload.push_back(static_cast<std::uint8_t>(std::strtoul(rest.substr(i, 2).c_str(), nullptr, 16)));
    }
    watched[rest.substr(0, first)].push_back(std::move(words));
  }
}

void pause_ms(long milliseconds) {
  const timespec t{milliseconds / 1000, milliseconds % 1000 * 1'000'000};
  ::nanosleep(&t, nullptr);
}

/// Says everything several times: nobody acknowledges it. Tries some seconds to reach the robot.
void stop_robot(const std::string& link_text, const std::vector<LastWords>& words) {
  const auto opener = aseba::message_link_opener(link_text);
  if (!opener || words.empty()) return;
  int said = 0;
  for (int attempt = 0; attempt < 20 && said < 4; ++attempt) {
    const auto link = opener.value()();
    while (link.ok() && link.value()->state() == aseba::Carrier::Up && said < 4) {
      for (const LastWords& w : words) (void)link.value()->send(w.type, w.payload);
      for (int i = 0; i < 5; ++i) link.value()->wait(10 * hal::kNsPerMs);  // what is queued leaves
      if (link.value()->state() == aseba::Carrier::Up) ++said;
    }
    if (said < 4) pause_ms(100);
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
  for (const auto& [link, words] : watched) stop_robot(link, words);
  ::_exit(0);
}

}  // namespace

hal::Result<Guardian> Guardian::start() {
  std::array<int, 2> ends{};
  const auto failed = [] {
    return hal::Error{std::string("no guardian process can be made (") + std::strerror(errno) +
                      "): a foot-bot would drive on if this program were killed"};
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
  ::close(pipe_);  // robots that were not released are now stopped
  ::waitpid(child_, nullptr, 0);
}

void Guardian::watch(const std::string& link, const std::vector<LastWords>& words) {
  std::string lines = "+" + link + "\n";
  for (const LastWords& w : words) lines += text_of(link, w) + "\n";
  say(lines);
}

void Guardian::release(const std::string& link) {
  say("-" + link + "\n");
}

void Guardian::say(const std::string& lines) {
  for (std::size_t at = 0; at < lines.size();) {
    const ssize_t n = ::write(pipe_, lines.data() + at, lines.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return;  // the guardian is gone
    at += static_cast<std::size_t>(n);
  }
}

}  // namespace tandem::bridges::footbot
