// LCM's own recorder, run beside a test: it hears what the test says on the network, and knows nothing of our code.
#pragma once
#include <cerrno>
#include <chrono>
#include <csignal>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include "bridges/lcm/lcm_link.hpp"
#include "tests/bridges/lcm/event_log.hpp"

namespace tandem::bridges::lcm_bus {

/// Records channels of one regular expression from LCM's own group into a file that ends with it.
class Witness {
 public:
  explicit Witness(const std::string& channels) : path_("/tmp/tandem_witness_" + std::to_string(::getpid()) + ".lcm") {
    ::unlink(path_.c_str());
    child_ = ::fork();
    if (child_ != 0) return;
    const std::string all = "(" + channels + "|witness/.*)";
    const std::string url = "--lcm-url=" + std::string(kDefaultLcmUrl);  // there is no short form in 1.3.1
    ::execlp("lcm-logger", "lcm-logger", "-q", url.c_str(), "-c", all.c_str(), path_.c_str(), nullptr);
    ::_exit(127);
  }
  ~Witness() {
    stop();
    ::unlink(path_.c_str());
  }
  Witness(const Witness&) = delete;
  Witness& operator=(const Witness&) = delete;

  /// Speaks to it until it records. False: it does not.
  bool wait_until_it_hears(LcmLink& link) { return wait_for("witness/hello", link); }
  /// False: it did not hear that channel. Speaks to it meanwhile: it writes out what it heard when it hears more.
  bool wait_for(const std::string& channel, LcmLink& link) {
    for (int i = 0; i < 600; ++i) {
      (void)link.publish("witness/hello", {});
      if (has(channel)) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }
  std::vector<LoggedEvent> events() const { return read_event_log(path_); }
  /// Ends the recorder when it has heard all that was said before: it drops what still waits when it is told to end.
  std::vector<LoggedEvent> end(LcmLink& link) {
    for (int i = 0; i < 600 && !has("witness/end"); ++i) {
      (void)link.publish("witness/end", {});
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    stop();
    return events();
  }

 private:
  void stop() {
    if (child_ > 0) {
      ::kill(child_, SIGINT);
      while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) continue;
      child_ = -1;
    }
  }
  bool has(const std::string& channel) const {
    for (const LoggedEvent& e : events()) {
      if (e.channel == channel) return true;
    }
    return false;
  }

  std::string path_;
  pid_t child_ = -1;
};

}  // namespace tandem::bridges::lcm_bus
