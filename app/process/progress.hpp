// A progress bar, on a terminal only.
#pragma once
#include <cstdint>

namespace tandem::app {

/// Draws "[####----] 42 %  12.6 s of 30 s, 5 s left" on standard error, a few times a second; nothing where that is no
/// terminal.
class Progress {
 public:
  /// `total_steps` 0: endless, the bar then only counts.
  Progress(std::int64_t total_steps, std::int64_t ticks_per_second);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void step(std::int64_t done);

 private:
  void draw(std::int64_t done, double now_s);

  std::int64_t total_;
  std::int64_t ticks_per_second_;
  bool shown_ = false;
  bool terminal_ = false;
  double began_s_ = 0.0;
  double next_s_ = 0.0;
};

}  // namespace tandem::app
