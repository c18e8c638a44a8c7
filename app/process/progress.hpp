// How far something long is: a progress bar on a terminal, else now and then a line.
#pragma once
#include <cstdint>
#include <string>

namespace tandem::app {

/// Draws "[####----] 42 %  12.6 s of 30 s, 5 s left" on standard error, a few times a second. Where that is no
/// terminal: "film: 42 %, 5 s left" after 2 s, 4 s, 8 s, …, or nothing without such a name.
class Progress {
 public:
  /// `total_steps` 0: endless, the bar then only counts.
  Progress(std::int64_t total_steps, std::int64_t ticks_per_second, std::string name = {});
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void step(std::int64_t done);

 private:
  void draw(std::int64_t done, double now_s);
  double part_of(std::int64_t done) const;
  double left_s(double part, double now_s);

  std::int64_t total_;
  std::int64_t ticks_per_second_;
  bool shown_ = false;
  bool terminal_ = false;
  std::string name_;
  double began_s_ = 0.0, began_part_ = -1.0;
  double next_s_ = 0.0;
};

}  // namespace tandem::app
