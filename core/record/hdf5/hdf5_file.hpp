// An HDF5 file that grows: groups, data sets whose first dimension is extended, texts beside them.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace tandem::core {

enum class Hdf5Type : std::uint8_t { F32, F64, I64 };

/// Paths are absolute; groups on the way are made. Errors name what cannot be written and why.
class Hdf5File {
 public:
  /// Overwrites the file. Error: it cannot be written; the library does not load.
  static hal::Result<std::unique_ptr<Hdf5File>> create(const std::string& path);
  virtual ~Hdf5File() = default;

  /// An empty data set, with rows of this shape ({}: of one value each).
  virtual hal::Status add(const std::string& path, Hdf5Type type, const std::vector<std::size_t>& row) = 0;
  /// Appends rows to it; they are converted to its type.
  virtual hal::Status append(const std::string& path, const double* values, std::size_t rows) = 0;
  /// A data set of texts (UTF-8).
  virtual hal::Status add_texts(const std::string& path, const std::vector<std::string>& texts) = 0;
  /// A text beside a data set or group.
  virtual hal::Status describe(const std::string& path, const std::string& name, const std::string& text) = 0;
  virtual hal::Status close() = 0;
};

}  // namespace tandem::core
