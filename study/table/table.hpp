// The table of a study: every run with its settings, seed, fingerprint and measures.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "study/run_row.hpp"

namespace tandem::study {

/// What a table is of.
struct TableHead {
  std::string study;                  ///< the whole file
  std::string file;                   ///< its name
  std::vector<std::string> settings;  ///< names of the columns for varied parameters
  std::int64_t runs = 0;              ///< that the study has
};

/// Program and files that runs were made with.
struct Version {
  std::string program;
  std::vector<std::pair<std::string, std::string>> files;  ///< name and SHA-256
  bool operator==(const Version&) const = default;
};

/// A run that the table has.
struct KnownRun {
  std::int64_t run = 0;
  std::string experiment;
  std::uint64_t seed = 0;
  std::vector<std::string> settings;  ///< numbers as `same_setting` compares them
  bool done = false;
};

/// Whether a value of a table and one of a study mean the same.
bool same_setting(const std::string& in_table, const std::string& in_study);

/// A table that is being written, by one process alone: an SQLite database with the tables runs, measures, samples,
/// times, versions and study, and the view results. What `add` has returned from outlives the process, whatever ends
/// it.
class Table {
 public:
  /// Opens or begins the table. Errors: another sweep writes it; it is none; the disk is full.
  static hal::Result<std::unique_ptr<Table>> open(const std::string& path);
  ~Table();
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  /// Nothing for a table that was not begun yet.
  std::optional<TableHead> head();
  /// Begins the table; columns are those of `head`.
  hal::Status begin(const TableHead& head);
  /// Notes that the study has changed but for its columns.
  hal::Status renew(const TableHead& head);

  /// The last one; nothing when there is none.
  std::optional<Version> version();
  /// @returns its number; that of the last one when it is the same.
  hal::Result<std::int64_t> add_version(const Version& version);

  std::vector<KnownRun> known();
  /// All of them or, with an error, none. A run that is there already is replaced.
  hal::Status add(std::span<const RunRow> rows);
  /// Makes the view `results` of runs, final measures and times, and leaves one file. Call at the end.
  hal::Status finish();
  /// In a forked process: only the parent keeps others from writing.
  void leave_to_parent() noexcept;

  struct Impl;

 private:
  explicit Table(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Writes `path`: a line a run, by number; with samples a second file ".samples.csv": a line a run and sample.
/// @returns the files
hal::Result<std::vector<std::string>> export_csv(const std::string& table, const std::string& path);

}  // namespace tandem::study
