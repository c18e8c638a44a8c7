// Tables as an HDF5 file.
#pragma once
#include <memory>
#include <string>

#include "core/record/table_sink.hpp"

namespace tandem::core {

/// Errors name what cannot be written and why.
class Hdf5File : public TableSink {
 public:
  /// Overwrites the file. Error: it cannot be written; the library does not load.
  static hal::Result<std::unique_ptr<Hdf5File>> create(const std::string& path);
  virtual hal::Status close() = 0;
};

}  // namespace tandem::core
