// Programs that a test in the guest runs beside itself.
#pragma once
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace tandem::bridges {

/// Runs a shell command to its end. Returns its output; exit codes other than 0 are added in a line.
inline std::string shell(const std::string& command) {
  std::string output;
  FILE* pipe = ::popen(("{ " + command + "; } 2>&1").c_str(), "r");
  if (pipe == nullptr) return "cannot start a shell";
  std::array<char, 4096> buffer{};
  while (const std::size_t n = ::fread(buffer.data(), 1, buffer.size(), pipe)) output.append(buffer.data(), n);
  const int status = ::pclose(pipe);
  if (status != 0) output += "exit status " + std::to_string(status) + " of: " + command + "\n";
  return output;
}

/// A command that runs until this object ends; its output goes to a file.
class Background {
 public:
  explicit Background(const std::string& command) : path_("/run/output" + std::to_string(::getpid()) + next()) {
    child_ = ::fork();
    if (child_ != 0) return;
    ::setpgid(0, 0);
    const std::string line = "exec " + command + " >" + path_ + " 2>&1";
    ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    ::_exit(127);
  }
  ~Background() { end(); }
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  void end() {
    if (child_ <= 0) return;
    ::kill(child_, SIGTERM);
    int status = 0;
    ::waitpid(child_, &status, 0);
    child_ = -1;
  }
  std::string output() const {
    std::ifstream in(path_);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// Waits until the output holds `text`, at most `seconds`.
  bool says(const std::string& text, int seconds = 20) const {
    for (int i = 0; i < seconds * 100; ++i) {
      if (output().find(text) != std::string::npos) return true;
      ::usleep(10'000);
    }
    return false;
  }
  /// Does `act` again and again until the output holds `text`: nobody knows when a command begins to listen.
  template <class Act>
  bool says_after(Act act, const std::string& text) const {
    for (int i = 0; i < 60; ++i) {
      act();
      if (says(text, 1)) return true;
    }
    return false;
  }

 private:
  static std::string next() {
    static int number = 0;
    return "_" + std::to_string(number++);
  }
  std::string path_;
  pid_t child_ = -1;
};

}  // namespace tandem::bridges
