// Where tables of a record go: an HDF5 file, arrays of numpy.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace tandem::core {

enum class TableType : std::uint8_t { F32, F64, I64 };

/// Groups, data sets whose first dimension grows, texts beside them. Paths are absolute; groups on the way are made.
class TableSink {
 public:
  virtual ~TableSink() = default;

  /// An empty data set, with rows of this shape ({}: of one value each).
  virtual hal::Status add(const std::string& path, TableType type, const std::vector<std::size_t>& row) = 0;
  /// Appends rows to it; they are converted to its type.
  virtual hal::Status append(const std::string& path, const double* values, std::size_t rows) = 0;
  /// A data set of texts (UTF-8).
  virtual hal::Status add_texts(const std::string& path, const std::vector<std::string>& texts) = 0;
  /// A text beside a data set or group.
  virtual hal::Status describe(const std::string& path, const std::string& name, const std::string& text) = 0;
};

}  // namespace tandem::core
