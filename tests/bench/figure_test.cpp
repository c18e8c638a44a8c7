#include "bench/figure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/gnuplot.hpp"
#include "tests/bench/lines.hpp"

namespace tandem::bench {
namespace {

using testing::ElementsAre;

std::vector<std::string> titles_of(const Figure& figure) {
  std::vector<std::string> titles;
  for (const FigurePanel& p : figure.panels) titles.push_back(p.title);
  return titles;
}

TEST(Figure, HasACurveForEachNumberOfThreads) {
  const Figure f = figure_of({line_of(100, 2, 6.0), line_of(1, 2, 1.0), line_of(100, 0, 5.0), line_of(1, 0, 2.0)});
  EXPECT_EQ(f.legend, "threads");
  EXPECT_THAT(f.labels, ElementsAre("P = 0", "P = 2"));
  EXPECT_THAT(titles_of(f), ElementsAre("kinematics2d, A1"));
  ASSERT_EQ(f.panels[0].curves.size(), 2U);
  const FigureCurve& first = f.panels[0].curves[0];
  EXPECT_EQ(first.label, 0U);
  ASSERT_EQ(first.points.size(), 2U);
  EXPECT_EQ(first.points[0].robots, 1.0);
  EXPECT_EQ(first.points[0].wall.median, 2.0);
  EXPECT_EQ(first.points[1].wall.median, 5.0);
  EXPECT_EQ(first.points[1].speedup.median, 2.0);
  EXPECT_EQ(f.wall_axis, "wall time [s]");
  EXPECT_EQ(f.real_time, 60.0);
  EXPECT_EQ(f.real_time_mark, "real time, T = 60 s");
}

TEST(Figure, ShowsMediansOfRepeats) {
  const Figure f = figure_of({line_of(10, 0, 5.0), line_of(10, 0, 1.0), line_of(10, 0, 2.0), line_of(20, 0, 8.0)});
  ASSERT_EQ(f.panels.size(), 1U);
  ASSERT_EQ(f.panels[0].curves.size(), 1U);
  const Spread wall = f.panels[0].curves[0].points.at(0).wall;
  EXPECT_EQ(wall.median, 2.0);
  EXPECT_EQ(wall.smallest, 1.0);
  EXPECT_EQ(wall.largest, 5.0);
  ASSERT_FALSE(f.notes.empty());
  EXPECT_NE(f.notes[0].find("medians of 1 to 3 runs"), std::string::npos) << f.notes[0];
  EXPECT_EQ(f.notes[1], "Test Processor 1, 4 cores");
}

TEST(Figure, OfOneNumberOfThreadsHasACurveForEachPartitionAndAPanelForEachEngine) {
  std::vector<ResultLine> lines;
  for (const char* engine : {"kinematics2d", "dynamics2d", "dynamics3d"}) {
    for (const char* partition : {"A16", "A2", "A1"}) lines.push_back(on(engine, partition, line_of(10, 2, 1.0)));
  }
  const Figure f = figure_of(lines);
  EXPECT_EQ(f.legend, "partition");
  EXPECT_THAT(f.labels, ElementsAre("A1", "A2", "A16"));
  EXPECT_THAT(titles_of(f), ElementsAre("kinematics2d, P = 2", "dynamics2d, P = 2", "dynamics3d, P = 2"));
  EXPECT_EQ(f.columns, 2U);
  EXPECT_EQ(f.lines, 2U);
  EXPECT_EQ(f.panels[2].column, 0U);
  EXPECT_EQ(f.panels[2].line, 1U);
}

TEST(Figure, OfOneSplitAndNumberOfThreadsHasACurveForEachEngine) {
  const Figure f =
      figure_of({on("particle3d", "A4", line_of(10, 2, 1.0)), on("dynamics2d", "A4", line_of(10, 2, 1.0))});
  EXPECT_EQ(f.legend, "engine");
  EXPECT_THAT(f.labels, ElementsAre("particle3d", "dynamics2d"));
  EXPECT_THAT(titles_of(f), ElementsAre("A4, P = 2"));
}

TEST(Figure, LaysOutEnginesDownAndPartitionsAcross) {
  std::vector<ResultLine> lines;
  for (const std::int64_t threads : {0, 2}) {
    for (const char* partition : {"A1", "A2", "A4"})
      lines.push_back(on("kinematics2d", partition, line_of(10, threads, 1.0)));
    lines.push_back(on("dynamics2d", "A4", line_of(10, threads, 1.0)));  // A1 and A2 were not measured
  }
  const Figure f = figure_of(lines);
  EXPECT_THAT(titles_of(f), ElementsAre("kinematics2d, A1", "kinematics2d, A2", "kinematics2d, A4", "dynamics2d, A4"));
  EXPECT_EQ(f.columns, 3U);
  EXPECT_EQ(f.lines, 2U);
  EXPECT_EQ(f.panels[3].column, 2U);
  EXPECT_EQ(f.panels[3].line, 1U);
}

TEST(Figure, IsRelativeToSimulatedTimeWhereRunsDifferInLength) {
  ResultLine shorter = line_of(100'000, 0, 30.0);
  shorter.virtual_s = 6.0;
  const Figure f = figure_of({line_of(10'000, 0, 30.0), shorter});
  EXPECT_EQ(f.wall_axis, "wall time / simulated time");
  EXPECT_EQ(f.real_time, 1.0);
  const auto& points = f.panels.at(0).curves.at(0).points;
  EXPECT_EQ(points.at(0).wall.median, 0.5);
  EXPECT_EQ(points.at(1).wall.median, 5.0);
}

TEST(FigureScript, LetsNoTextOutOfItsQuotes) {
  ResultLine line = line_of(10, 0, 1.0);
  line.engine = "x'\nsystem('touch owned')\n`touch owned`";
  line.cpu_model = "it's";
  const std::string script = gnuplot_script(figure_of({line}), core::FigureFormat::Svg);
  EXPECT_EQ(script.find('`'), std::string::npos);
  EXPECT_EQ(script.find("\nsystem"), std::string::npos);
  EXPECT_NE(script.find("'it s, 4 cores'"), std::string::npos);
  EXPECT_NE(script.find("'x  system( touch owned )  touch owned , A1'"), std::string::npos) << script;
}

TEST(FigureFormat, IsChosenByTheEnding) {
  EXPECT_EQ(core::figure_format("a/b.svg").value(), core::FigureFormat::Svg);
  EXPECT_EQ(core::figure_format("b.c.png").value(), core::FigureFormat::Png);
  for (const char* path : {"a.jpg", "svg", "a.svg/b", "", ".png"}) {
    ASSERT_FALSE(core::figure_format(path).ok()) << path;
    EXPECT_NE(core::figure_format(path).error().message.find(".svg, .png or .pdf"), std::string::npos);
  }
}

}  // namespace
}  // namespace tandem::bench
