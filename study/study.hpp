// Studies as they are read from a file: experiments, varied settings, seeds, measures.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/config/reader.hpp"
#include "core/scenario/element.hpp"

namespace tandem::study {

struct ExperimentChoice {
  std::string name;  ///< in the table
  std::string file;
  int line = 0;
};

/// A setting with the values that it takes, each as it is written after "path=".
struct Parameter {
  std::string name;  ///< of its column
  std::string path;
  std::vector<std::string> values;
  int line = 0;
};

/// Parameters that are varied together; all have as many values. One alone, a paired list, or a Latin hypercube.
struct Axis {
  std::vector<Parameter> parameters;
  std::size_t size() const noexcept { return parameters.empty() ? 0 : parameters.front().values.size(); }
};

struct Constant {
  std::string path, value;
  int line = 0;
};

enum class Over { Mean, Sum, Min, Max };

/// A measure made of a value that controllers publish.
struct PublishedMeasure {
  std::string name, published;
  Over over = Over::Mean;
};

struct Study {
  std::string name;  ///< of its file, without folder and ending
  std::string file;
  std::string text;  ///< of the whole file
  std::string table;
  bool isolate = false;
  double time_limit_s = 0.0;   ///< 0: none
  double step_limit_s = 60.0;  ///< of one step; 0: none
  std::vector<ExperimentChoice> experiments;
  std::vector<Axis> axes;
  std::vector<Constant> constants;
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> measures;  ///< names or patterns with '*'
  double sample_every_s = 0.0;        ///< 0: at the end alone
  std::vector<PublishedMeasure> published;

  /// All parameters, in the order of the file: the columns of the table.
  std::vector<const Parameter*> parameters() const;
};

/// Reads a study; all problems are collected with their lines. Nothing is returned when there is an error among them.
/// Experiments are not opened.
std::optional<Study> read_study(const std::string& path, core::Problems& problems);
std::optional<Study> read_study_text(const std::string& text, const std::string& path, core::Problems& problems);

/// The manual of every element of a study file.
std::vector<core::ElementManual> study_manuals();

}  // namespace tandem::study
