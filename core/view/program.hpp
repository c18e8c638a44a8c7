// Another program, run as a child that is fed through a pipe: ffmpeg, povray.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <sys/types.h>
#include <vector>

#include "hal/result.hpp"

namespace tandem::core {

/// Where PATH has it; empty: nowhere.
std::string find_program(std::string_view name);

/// A child in a process group of its own, so that Ctrl-C does not reach it. What it prints is kept for messages. The
/// caller's process must ignore SIGPIPE.
class Program {
 public:
  /// Error: it cannot be started.
  static hal::Result<std::unique_ptr<Program>> start(const std::string& path,
                                                     const std::vector<std::string>& arguments);
  /// Ends it when `finish` was not called.
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// Errors: it ended; it took nothing for a minute. It is then over, and the message has its last words.
  hal::Status feed(std::string_view data);
  /// Tells it that nothing more comes, and waits for its end. Error: as above, or its exit code is not 0.
  hal::Status finish();

 private:
  Program() = default;
  hal::Error over(std::string_view what);
  int wait() noexcept;

  std::string name_;
  pid_t pid_ = -1;
  int in_ = -1, errors_ = -1;
};

}  // namespace tandem::core
