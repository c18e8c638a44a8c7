// Messages of a run: the first few on the terminal, all of them in a file that was asked for.
#pragma once
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "hal/log.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {

/// May be used from any thread.
class RunLog {
 public:
  /// `path` empty: no file. Error: it cannot be written.
  static hal::Result<std::unique_ptr<RunLog>> open(const std::string& path);

  /// Must not outlive this.
  hal::Log log();
  /// Takes an entry into the file alone.
  void keep(std::string_view text);
  /// Who gets every message as well; empty: nobody. Is called on the thread that has the message.
  void tell_also(std::function<void(std::string_view)> listener);
  /// The results are written: an error from here on is of a controller or hook that is destroyed.
  void results_done();
  bool over() const;
  /// Errors since `results_done`.
  int late_errors() const;
  /// Puts the file in its place and tells how many messages the terminal did not get. Error: the disk is full or gone.
  hal::Status close();

 private:
  void write(hal::Severity severity, std::string_view text);
  void write_file(hal::Severity severity, std::string_view entry);

  mutable std::mutex lock_;
  std::function<void(std::string_view)> listener_;
  std::optional<hal::OutputFile> file_;
  hal::Status written_;
  int count_ = 0, late_errors_ = 0;
  bool over_ = false;
};

}  // namespace tandem::app
