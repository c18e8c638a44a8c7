// Messages of a run: the first few on the terminal, those about real robots by a budget of their own, and all of them
// in a file that was asked for.
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/outputs/robot_lines.hpp"
#include "app/outputs/roll_lines.hpp"
#include "hal/log.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {

/// May be used from any thread.
class RunLog {
 public:
  /// Has the file besides; `path` empty: none. Before any message. Error: it cannot be written.
  hal::Status open(const std::string& path);

  /// Must not outlive this, as the next.
  hal::Log log();
  /// For what is about real robots: never silent on the terminal, whatever else was said.
  hal::Log robots();
  /// For messages too many for people: the file gets them alone; they count among those that the terminal did not get.
  /// Without a file it drops everything.
  hal::Log excess();
  /// Takes an entry into the file alone.
  void keep(std::string_view text);
  /// The real robots as they are now: to be called often. On a terminal the list stands under everything else, without
  /// one it is told as it changes.
  void show_robots(const std::vector<core::RollRow>& roll);
  /// Tells what is still to be told of them, and takes their list away.
  void end_robots();
  ~RunLog() { end_robots(); }
  RunLog() = default;
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;
  /// Gets every message as well; may be empty. Is called on the thread that has the message.
  void tell_also(std::function<void(std::string_view)> listener);
  /// The results are written: an error from here on is of a controller or hook that is destroyed.
  void results_done();
  bool over() const;
  /// Errors since `results_done`.
  int late_errors() const;
  /// Puts the file in its place and tells how many messages the terminal did not get. Error: the disk is full or gone.
  hal::Status close();

 private:
  void write(hal::Severity severity, std::string_view text, bool about_robots);
  void write_excess(hal::Severity severity, std::string_view text);
  void write_file(hal::Severity severity, std::string_view entry);
  void tell_robots(bool all);

  mutable std::mutex lock_;
  std::function<void(std::string_view)> listener_;
  std::optional<hal::OutputFile> file_;
  hal::Status written_;
  int count_ = 0, late_errors_ = 0;
  std::size_t excess_ = 0;
  bool over_ = false;
  RobotLines robot_lines_;
  RollTeller roll_teller_;
};

}  // namespace tandem::app
