// ASEBA's own simulated robots: asebaplayground (Debian package aseba), on a screen that nobody sees.
#pragma once
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tandem::test {

inline bool installed(const std::string& program) {
  const char* path = std::getenv("PATH");
  const std::string folders = path == nullptr ? "" : path;
  for (std::size_t at = 0; at <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', at), folders.size());
    if (::access((folders.substr(at, end - at) + "/" + program).c_str(), X_OK) == 0) return true;
    at = end + 1;
  }
  return false;
}

inline std::uint16_t free_port() {
  const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof address;
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), size) != 0) return 0;
  ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(fd);
  return ntohs(address.sin_port);
}

/// A program that runs until this object ends.
class Program {
 public:
  explicit Program(const std::string& command) : child_(::fork()) {
    if (child_ != 0) return;
    const std::string line = "exec " + command + " >/dev/null 2>&1";
    ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    ::_exit(127);
  }
  ~Program() {
    ::kill(child_, SIGKILL);
    int status = 0;
    ::waitpid(child_, &status, 0);
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

 private:
  pid_t child_;
};

/// The simulator with one robot in a square of walls. `robot` is its element without the port.
class Playground {
 public:
  /// A program that is needed and not there; empty: none.
  static std::string missing() {
    for (const char* program : {"asebaplayground", "asebaswitch", "Xvfb"}) {
      if (!installed(program)) return program;
    }
    return "";
  }

  Playground(const std::string& robot, double side_cm)
      : folder_(std::filesystem::temp_directory_path() / ("tandem_playground_" + std::to_string(::getpid()))),
        port_(free_port()) {
    std::filesystem::create_directories(folder_);
    const std::string side = std::to_string(side_cm);
    std::ofstream(folder_ / "e.playground")
        << "<!DOCTYPE aseba-playground><aseba-playground><color name=\"wall\" r=\"0.9\" g=\"0.9\" b=\"0.9\"/>"
           "<world w=\"" +
               side + "\" h=\"" + side + "\" color=\"wall\"/><robot " + robot + " port=\""
        << port_ << "\"/></aseba-playground>";
    const std::string number = (folder_ / "display").string();
    screen_ = std::make_unique<Program>("Xvfb -displayfd 3 -nolisten tcp 3>" + number);
    for (int i = 0; i < 1000 && display_.empty(); ++i) {
      std::ifstream(number) >> display_;
      ::usleep(20'000);
    }
    if (has_screen()) start();
  }
  ~Playground() {
    stop();
    screen_.reset();
    std::filesystem::remove_all(folder_);
  }
  Playground(const Playground&) = delete;
  Playground& operator=(const Playground&) = delete;

  bool has_screen() const { return !display_.empty(); }
  void start() {
    process_ =
        std::make_unique<Program>("env DISPLAY=:" + display_ + " HOME=" + folder_.string() +
                                  " LIBGL_ALWAYS_SOFTWARE=1 asebaplayground " + (folder_ / "e.playground").string());
  }
  void stop() { process_.reset(); }
  /// Waits until it listens, without connecting: it serves one host at a time, and forgets the first for the second.
  bool listens() const {
    char wanted[16];
    std::snprintf(wanted, sizeof wanted, ":%04X ", static_cast<unsigned>(port_));
    for (int i = 0; i < 1000; ++i, ::usleep(20'000)) {
      for (const char* table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
        std::ifstream in(table);
        for (std::string line; std::getline(in, line);) {
          const std::size_t at = line.find(wanted);
          // local address, then the other's, then the state: 0A listens
          if (at != std::string::npos && line.find(" 0A ") != std::string::npos && at < line.find(" 0A ")) return true;
        }
      }
    }
    return false;
  }
  std::uint16_t port() const { return port_; }
  std::string link() const { return "tcp:127.0.0.1:" + std::to_string(port_); }

 private:
  std::filesystem::path folder_;
  std::uint16_t port_;
  std::string display_;
  std::unique_ptr<Program> screen_;
  std::unique_ptr<Program> process_;
};

}  // namespace tandem::test
