// What `tandem export` is asked for.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/command.hpp"
#include "hal/result.hpp"

namespace tandem::app {

struct ExportOptions {
  std::string record;
  std::string csv;                          ///< file, or "-"; empty: only say what the record holds
  std::string hdf5;                         ///< file; empty: none
  std::string stream;                       ///< which of its tables; empty: in CSV "pose", in HDF5 all
  std::vector<std::string> fields;          ///< of HDF5: only these; empty: all
  std::vector<std::string> entities;        ///< ids, or patterns with '*'; empty: all
  std::optional<std::int64_t> from, until;  ///< ticks, both included
  std::int64_t every = 1;                   ///< of the ticks that are there

  bool wants(std::int64_t tick) const;
  bool wants(const std::string& id) const;

  void describe(hal::CommandLine& line);
};

/// All tables that are asked for, as an HDF5 file.
hal::Status write_hdf5(const ExportOptions& options);

}  // namespace tandem::app
