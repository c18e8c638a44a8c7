// Results of batches: files of checksummed blocks, one for each process that makes a batch, in a folder that all see.
#pragma once
#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "study/sweep/message.hpp"
#include "study/sweep/sweep.hpp"

namespace tandem::study {

/// Written by one process. What `add` has returned from outlives the process, whatever ends it.
class ResultsWriter {
 public:
  /// Begins a file of its own for this batch. Error: the folder cannot be written.
  static hal::Result<ResultsWriter> open(const std::string& folder, std::size_t batch);
  ResultsWriter(ResultsWriter&& other) noexcept;
  ResultsWriter& operator=(ResultsWriter&&) = delete;
  ResultsWriter(const ResultsWriter&) = delete;
  ResultsWriter& operator=(const ResultsWriter&) = delete;
  ~ResultsWriter();

  /// Error: the disk is full or gone.
  hal::Status add(std::span<const FinishedRun> runs);

 private:
  ResultsWriter(std::string path, int fd) : path_(std::move(path)), fd_(fd) {}
  hal::Status write(std::string_view bytes) const;

  std::string path_;
  int fd_;
};

/// Reads what all processes have written into a folder, while they go on. What is damaged or not whole yet is left out.
class ResultsReader {
 public:
  explicit ResultsReader(std::string folder) : folder_(std::move(folder)) {}

  /// What has come since the last call. A run that several processes made comes several times.
  std::vector<ToldOutcome> look();

 private:
  std::string folder_;
  std::map<std::string, std::size_t> read_;  // bytes, by file
};

}  // namespace tandem::study
