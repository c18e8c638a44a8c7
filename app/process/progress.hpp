// How far something long is: a progress bar on a terminal, else now and then a line.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace tandem::app {

/// "1.2 s", "12 s", "3 minutes", "2.5 hours"
std::string duration_text(double seconds);

/// Draws "[####----] 42 %  film: 12.6 of 30.0 s, 5 s left" on standard error, a few times a second. Where that is no
/// terminal: the line "film: 42 %, about 5 s left" after 2 s, 4 s, 8 s, …, or nothing without such a name.
class Progress {
 public:
  /// `total` 0: endless, the bar then only counts. So many steps are one `unit`: `per_unit`, as ticks in a second.
  Progress(std::int64_t total, std::int64_t per_unit, std::string name = {}, std::string unit = "s");
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `more` stands behind: ", 3 failed". The time left follows from the steps since the first call.
  void step(std::int64_t done, std::string_view more = {});

 private:
  void draw(std::int64_t done, double now_s, std::string_view more);
  double part_of(std::int64_t done) const;
  std::string left(double part, double now_s, std::string_view about) const;
  std::string amount(std::int64_t count) const;

  std::int64_t total_, per_unit_;
  std::string name_, unit_;
  bool shown_ = false;
  bool terminal_ = false;
  double began_s_ = 0.0, began_part_ = -1.0;
  double next_s_ = 0.0;
};

}  // namespace tandem::app
