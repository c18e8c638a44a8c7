// Another program, run as a child: gnuplot, sbatch; ffmpeg and povray, at the other end of a pipe.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <sys/types.h>
#include <vector>

#include "hal/result.hpp"

namespace tandem::hal {

/// Where PATH has it; empty: nowhere.
std::string find_program(std::string_view name);

/// What a program that has ended said.
struct ProgramEnd {
  int code = 0;        ///< its exit code; 128 and more: the signal that ended it
  std::string output;  ///< all of it
  std::string errors;  ///< the first 2,000 bytes
};

/// Runs a program to its end, with `input` behind its standard input. Error: it cannot be started.
Result<ProgramEnd> run_program(const std::string& path, const std::vector<std::string>& arguments,
                               std::string_view input = {});

/// A child in a process group of its own, so that Ctrl-C does not reach it. What it prints is kept for messages. The
/// caller's process must ignore SIGPIPE.
class Program {
 public:
  /// One that is fed. Error: it cannot be started.
  static Result<std::unique_ptr<Program>> start(const std::string& path, const std::vector<std::string>& arguments);
  /// One that is heard: `output` is what it writes to its standard output. Error: as above.
  static Result<std::unique_ptr<Program>> start_source(const std::string& path,
                                                       const std::vector<std::string>& arguments);
  /// Ends it when `finish` was not called.
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  /// For poll and read; does not block. Of one that is fed: -1.
  int output() const noexcept { return heard_ ? pipe_ : -1; }
  /// Of one that is fed. Errors: it ended; it took nothing for a minute. It is then over, and the message has its last
  /// words.
  Status feed(std::string_view data);
  /// Closes the pipe, and waits for its end. Error: as above, or its exit code is not 0.
  Status finish();

 private:
  Program() = default;
  static Result<std::unique_ptr<Program>> start(const std::string& path, const std::vector<std::string>& arguments,
                                                bool heard);
  Error over(std::string_view what);
  int wait() noexcept;

  std::string name_;
  pid_t pid_ = -1;
  bool heard_ = false;
  int pipe_ = -1, errors_ = -1;
};

}  // namespace tandem::hal
