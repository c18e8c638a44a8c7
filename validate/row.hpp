// Values of a validation report: parts, each with tables of rows and figures; a row may have a contract.
#pragma once
#include <string>
#include <vector>

namespace tandem::validate {

/// Told: the row has no contract, it is only reported. NotMade: what it needs is not there; counts as not met.
enum class Verdict { Told, Met, NotMet, NotMade };

struct Row {
  std::vector<std::string> cells;  ///< one a column of its table
  std::string contract = {};       ///< what must hold, in words; empty: nothing
  Verdict verdict = Verdict::Told;
};

struct Table {
  std::string title;
  std::string text;                  ///< how it was measured, and against what; may be empty
  std::vector<std::string> columns;  ///< without those of contract and verdict, which every table has
  std::vector<Row> rows;
};

/// A figure as a gnuplot script without a terminal, which is set when it is drawn.
struct Figure {
  std::string name;  ///< of its file, without an ending
  std::string caption;
  std::string script;
};

struct Part {
  std::string title;
  std::string text;
  std::vector<Table> tables = {};
  std::vector<Figure> figures = {};
  double seconds = 0.0;  ///< that it took
};

/// How thoroughly: everything, or what takes less than a minute.
enum class Depth { Full, Short };

inline Verdict verdict_of(bool met) noexcept {
  return met ? Verdict::Met : Verdict::NotMet;
}

}  // namespace tandem::validate
