// `tandem export --hdf5`: tables of a record as data sets.
#include "app/command/export.hpp"
#include "app/process/terminal.hpp"
#include "core/record/hdf5/hdf5_file.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {

hal::Status write_hdf5(const ExportOptions& options) {
  auto tables = core::RecordTables::open(options);
  if (!tables.ok()) return tables.error();
  auto output = hal::OutputFile::open(options.hdf5, "HDF5 file");
  if (!output.ok()) return output.error();
  if (output.value().part().empty())
    return hal::Error{"cannot write the HDF5 file '" + options.hdf5 + "': it must be a file, no device or pipe"};
  auto file = core::Hdf5File::create(output.value().part());
  if (!file.ok()) return file.error();
  if (const hal::Status written = tables.value().write(*file.value()); !written.ok()) return written;
  if (const hal::Status closed = file.value()->close(); !closed.ok()) return closed;
  for (const std::string& line : tables.value().damage()) say("record '" + options.record + "': " + line);
  return output.value().commit();
}

}  // namespace tandem::app
