// Results of a benchmark as a figure: wall time above, speed-up below, against the number of robots. The form is that
// of figures 6 to 8 of Pinciroli et al. (2012), section 4.
#pragma once
#include <string>
#include <vector>

#include "bench/result_line.hpp"
#include "bench/spread.hpp"

namespace tandem::bench {

struct FigurePoint {
  double robots = 0.0;
  Spread wall;     ///< in the figure's unit
  Spread speedup;  ///< processor time / wall time
};

struct FigureCurve {
  std::size_t label = 0;            ///< index into Figure::labels
  std::vector<FigurePoint> points;  ///< by rising number of robots
};

/// Two diagrams above one another.
struct FigurePanel {
  std::string title;
  std::size_t column = 0, line = 0;
  std::vector<FigureCurve> curves;
};

struct Figure {
  std::string legend;               ///< what tells the curves apart: "threads P"
  std::vector<std::string> labels;  ///< one a curve, the same in all panels
  std::vector<FigurePanel> panels;  ///< one for what else was varied: engines, partitions
  std::size_t columns = 1, lines = 1;
  std::string wall_axis;           ///< what the upper axis says, with its unit
  double real_time = 1.0;          ///< where wall time equals simulated time, in that unit
  std::string real_time_mark;      ///< what the line there says
  std::vector<std::string> notes;  ///< lines at the foot: what was run where, how often
};

/// Curves stand for what was varied: numbers of threads; where there is one of these, partitions; else engines. The
/// rest has panels of its own. Wall time is in seconds, or relative to the simulated time where runs differ in length.
/// `lines` hold at least one, and are alike (`check_alike`).
Figure figure_of(const std::vector<ResultLine>& lines);

}  // namespace tandem::bench
