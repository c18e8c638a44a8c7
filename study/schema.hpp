// Every element of a study file, described once: reading, checking, defaults and the manual come from here.
#pragma once
#include <array>
#include <string>
#include <string_view>

#include "core/config/schema.hpp"

namespace tandem::study::schema {

using core::schema::ElementInfo;
using hal::kAny;
using hal::kNotNegative;
using hal::ParamVisitor;
namespace unit = hal::unit;

struct Root {
  static constexpr ElementInfo kElement{
      "study", "A study, for `tandem sweep`: every experiment with every combination of parameters and every seed.", "",
      "experiment parameter paired latin_hypercube set seeds measures"};
  std::string table;
  bool isolate = false;
  double time_limit_s = 0.0;
  double step_limit_s = 60.0;
  void describe(ParamVisitor& v) {
    v.text("table", table, "Table to write (SQLite); left out: named as the study, ending in .sqlite, in this folder.");
    v.flag("isolate", isolate,
           "Every run in a process and a world of its own: for plug-ins that remember things from run to run.");
    v.number("time_limit", time_limit_s, unit::s, {0.0, 1e9},
             "Real time after which a run is ended and has failed; 0: none.");
    v.number("step_limit", step_limit_s, unit::s, {0.0, 1e6},
             "Real time that one step may take, in whole seconds; a run with a longer one has failed; 0: any.");
  }
};

struct Experiment {
  static constexpr ElementInfo kElement{"experiment", "An experiment file; several are compared.", "file"};
  std::string file, name;
  void describe(ParamVisitor& v) {
    v.text("file", file, "Relative to the working directory, or else to the folder of the study.");
    v.text("name", name, "In the table; left out: the file's name.");
  }
};

struct Parameter {
  static constexpr ElementInfo kElement{"parameter", "A setting of the experiments that is varied.", "path"};
  std::string path, name, values, from, to, step;
  std::int64_t count = 0;
  std::string scale = "linear";
  bool whole = false;
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 2> kScales = {"linear", "log"};
    v.text("path", path, "As `--set` of `tandem run` names it, in every experiment.");
    v.text("name", name, "Of its column in the table; left out: the last part of the path.");
    v.text("values", values, "A list, separated by commas, or by semicolons where values hold commas.");
    v.text("from", from, "First value of a range, \"10 cm\".");
    v.text("to", to, "Last value of a range.");
    v.text("step", step, "Between the values of a range.");
    v.integer("count", count, {0, 1e9}, "How many values a range has, instead of a step.");
    v.choice("scale", scale, kScales, "log: the values of a range grow by a factor.");
    v.flag("whole", whole, "Rounds the values of a range to whole numbers.");
  }
};

struct Paired {
  static constexpr ElementInfo kElement{
      "paired", "Parameters whose lists go together: first with first, second with second.", "", "parameter"};
  void describe(ParamVisitor&) {}
};

struct LatinHypercube {
  static constexpr ElementInfo kElement{
      "latin_hypercube",
      "Points drawn so that each parameter has one value in each of as many equal parts of its range.", "points",
      "parameter"};
  std::int64_t points = 0, seed = 1;
  void describe(ParamVisitor& v) {
    v.integer("points", points, {1, 1e7}, "How many.");
    v.integer("seed", seed, {0, 9.2e18}, "Of the draw.");
  }
};

struct Set {
  static constexpr ElementInfo kElement{"set", "A setting that is the same in all runs.", "path value"};
  std::string path, value;
  void describe(ParamVisitor& v) {
    v.text("path", path, "As `--set` of `tandem run` names it, in every experiment.");
    v.text("value", value, "Its value; {run} and {seed} in it stand for those of the run.");
  }
};

struct Seeds {
  static constexpr ElementInfo kElement{"seeds", "Seeds of the runs; left out: 1 alone."};
  std::int64_t first = 1, count = 0;
  std::string values;
  void describe(ParamVisitor& v) {
    v.integer("first", first, {1, 9.2e18}, "The first of `count` seeds that follow one another.");
    v.integer("count", count, {0, 1e7}, "How many.");
    v.text("values", values, "A list instead.");
  }
};

struct Measures {
  static constexpr ElementInfo kElement{
      "measures", "What the table keeps of what hooks measure; left out: all, at the end of the run.", "", "measure"};
  std::string names = "*";
  double every_s = 0.0;
  void describe(ParamVisitor& v) {
    v.text("names", names, "Separated by commas; '*' stands for any text.");
    v.number("every", every_s, unit::s, {0.0, 1e9},
             "Virtual time between samples over the run; 0: only the values at its end.");
  }
};

struct Measure {
  static constexpr ElementInfo kElement{"measure", "A measure made of what controllers publish.", "name published"};
  std::string name, published;
  std::string over = "mean";
  void describe(ParamVisitor& v) {
    static constexpr std::array<std::string_view, 4> kWays = {"mean", "sum", "min", "max"};
    v.text("name", name, "In the table.");
    v.text("published", published, "Name of the published value.");
    v.choice("over", over, kWays, "Of the robots whose controllers publish it.");
  }
};

}  // namespace tandem::study::schema
