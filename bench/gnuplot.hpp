// Figures of benchmarks as scripts for gnuplot.
#pragma once
#include <string>

#include "bench/figure.hpp"
#include "core/view/gnuplot.hpp"

namespace tandem::bench {

/// The script that writes the figure to gnuplot's standard output.
std::string gnuplot_script(const Figure& figure, core::FigureFormat format);

}  // namespace tandem::bench
