// A program on a terminal of its own: what a person would see on the screen, and keys.
#pragma once
#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include "tests/scenarios/process.hpp"

namespace tandem::scenarios {

/// The part of a terminal that `tandem` uses: places, erasing, looks, another screen.
class Screenful {
 public:
  Screenful(int columns, int lines) : columns_(columns), lines_(lines) { clear(); }
  void resize(int columns, int lines) {
    columns_ = columns;
    lines_ = lines;
    clear();
  }
  void take(std::string_view bytes) {
    for (const char c : bytes) put(c);
  }
  /// Whether the other screen is up, whether the cursor is shown.
  bool other() const { return other_; }
  bool cursor() const { return cursor_; }
  bool strange() const { return strange_; }  ///< something came that it does not know
  bool colors() const { return colors_; }
  std::string line(int i) const { return rows_.at(static_cast<std::size_t>(i)); }
  std::string text() const {
    std::string all;
    for (const std::string& row : rows_) all += row + "\n";
    return all;
  }
  std::string before;  ///< what was printed while the other screen was not up

 private:
  void clear() { rows_.assign(static_cast<std::size_t>(lines_), ""); }
  void put(char c) {
    if (!sequence_.empty() || c == '\033') {
      sequence_ += c;
      const bool ends = sequence_.size() > 2 && c >= '@' && c <= '~';
      if (ends || sequence_.size() > 20) obey(std::exchange(sequence_, {}));
      return;
    }
    if (!other_) {
      before += c;
      return;
    }
    if (static_cast<unsigned char>(c) < 0x20) {
      strange_ = true;
      return;
    }
    std::string& row = rows_[row_];
    if ((static_cast<unsigned char>(c) & 0xC0U) != 0x80U) {  // the first byte of a character
      if (column_ >= columns_) strange_ = true;              // it would wrap
      // Rows are always drawn from their beginning: what was there is replaced.
      if (column_ == 0) row.clear();
      ++column_;
    }
    row += c;
  }
  void obey(const std::string& s) {
    const std::string arguments = s.substr(2, s.size() - 3);
    switch (s.back()) {
      case 'H':
        row_ = std::min<std::size_t>(static_cast<std::size_t>(std::stoi(arguments)) - 1, rows_.size() - 1);
        if (std::stoi(arguments) > lines_) strange_ = true;
        column_ = 0;
        break;
      case 'K':
        if (column_ == 0) rows_[row_].clear();
        break;
      case 'J':
        if (other_) clear();
        break;
      case 'm':
        if (arguments.size() == 2) colors_ = true;
        break;
      case 'h':
      case 'l':
        if (arguments == "?1049") other_ = s.back() == 'h';
        if (arguments == "?25") cursor_ = s.back() == 'h';
        break;
      default:
        strange_ = true;
    }
  }

  int columns_, lines_;
  std::vector<std::string> rows_;
  std::size_t row_ = 0;
  int column_ = 0;
  bool other_ = false, cursor_ = true, strange_ = false, colors_ = false;
  std::string sequence_;
};

/// `tandem` in the foreground of a terminal. Killed when this ends.
class OnTerminal {
 public:
  OnTerminal(const std::vector<std::string>& arguments, const fs::path& folder, int columns = 80, int lines = 24,
             const std::vector<std::pair<std::string, std::string>>& environment = {})
      : screen(columns, lines) {
    winsize size{};
    size.ws_col = static_cast<unsigned short>(columns);
    size.ws_row = static_cast<unsigned short>(lines);
    stand_apart();
    int slave = -1;
    if (openpty(&master_, &slave, nullptr, nullptr, &size) != 0) return;
    tcgetattr(slave, &fresh_);
    std::vector<std::string> words = tandem_words();
    words.insert(words.end(), arguments.begin(), arguments.end());
    pid_ = fork();
    if (pid_ == 0) {
      setsid();
      ioctl(slave, TIOCSCTTY, 0);
      for (const int descriptor : {0, 1, 2}) dup2(slave, descriptor);
      close(slave);
      close(master_);
      if (chdir(folder.c_str()) != 0) _exit(99);
      setenv("TERM", "xterm", 1);
      for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
      std::vector<char*> argv;
      for (std::string& word : words) argv.push_back(word.data());
      argv.push_back(nullptr);
      execv(argv[0], argv.data());
      _exit(98);
    }
    slave_ = slave;  // so that the terminal outlives the program
    fcntl(master_, F_SETFL, O_NONBLOCK);
  }
  ~OnTerminal() {
    if (pid_ > 0 && !ended_) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
    close(slave_);
    close(master_);
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  /// The terminal is gone, as when ssh is closed.
  void hang_up() {
    for (int* const end : {&slave_, &master_}) close(std::exchange(*end, -1));
  }
  void type(std::string_view keys) { (void)!write(master_, keys.data(), keys.size()); }
  void signal(int number) const { kill(pid_, number); }
  pid_t pid() const { return pid_; }
  void resize(int columns, int lines) {
    read_all();
    winsize size{};
    size.ws_col = static_cast<unsigned short>(columns);
    size.ws_row = static_cast<unsigned short>(lines);
    ioctl(master_, TIOCSWINSZ, &size);
    screen.resize(columns, lines);
  }
  void read_all() {
    char bytes[4096];
    for (;;) {
      const ssize_t n = read(master_, bytes, sizeof bytes);
      if (n <= 0) return;
      screen.take({bytes, static_cast<std::size_t>(n)});
    }
  }
  /// Whether the screen comes to show all of these.
  bool shows(const std::vector<std::string>& parts, double seconds = 20.0) {
    return eventually(
        [&] {
          read_all();
          const std::string text = screen.text();
          return screen.other() && std::all_of(parts.begin(), parts.end(), [&](const std::string& part) {
                   return text.find(part) != std::string::npos;
                 });
        },
        seconds);
  }
  /// Whether the terminal is as it was: keys are shown, lines are whole, the cursor stands.
  bool restored() {
    read_all();
    termios now{};
    tcgetattr(slave_, &now);
    return now.c_lflag == fresh_.c_lflag && now.c_cc[VQUIT] == fresh_.c_cc[VQUIT] && !screen.other() && screen.cursor();
  }
  bool suspended() const {
    const std::string stat = text_of("/proc/" + std::to_string(pid_) + "/stat");
    const std::size_t end = stat.rfind(')');
    return end != std::string::npos && stat.compare(end, 3, ") T") == 0;
  }
  /// Exit code, or -signal; -1000 when it did not end within `seconds`.
  int wait(double seconds = 30.0) {
    int status = 0;
    const bool done = eventually(
        [&] {
          read_all();
          return ended_ || (ended_ = waitpid(pid_, &status, WNOHANG) == pid_);
        },
        seconds);
    if (!done) {
      ADD_FAILURE() << "it goes on:\n" << threads_of(pid_) << screen.text();
      return -1000;
    }
    read_all();
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  Screenful screen;

 private:
  int master_ = -1, slave_ = -1;
  termios fresh_{};
  pid_t pid_ = -1;
  bool ended_ = false;
};

}  // namespace tandem::scenarios
