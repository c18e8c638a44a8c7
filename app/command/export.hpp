// Options of `tandem export`.
#pragma once
#include <string>

#include "core/record/record_tables.hpp"
#include "hal/command.hpp"
#include "hal/result.hpp"

namespace tandem::app {

/// `stream` empty: in CSV "pose"; `fields` are of HDF5.
struct ExportOptions : core::TableChoice {
  std::string csv;     ///< file, or "-"; all empty: only say what the record holds
  std::string hdf5;    ///< file; empty: none
  std::string report;  ///< file, or "-"; empty: none
  std::string dump;    ///< the same

  void describe(hal::CommandLine& line);
};

/// All tables that are asked for, as an HDF5 file.
hal::Status write_hdf5(const ExportOptions& options);

}  // namespace tandem::app
