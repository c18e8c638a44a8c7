// Output files: written beside their place and renamed when they are complete.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "hal/result.hpp"

namespace tandem::hal {

/// A file that is being written. `FILE.part` grows in the folder of FILE; `commit` renames it. Until then an older FILE
/// stays as it was, and whoever is killed leaves the part. "-" is standard output; it, devices and pipes are written
/// directly.
class OutputFile {
 public:
  /// Opens for `what`, e.g. "report", as messages call it. Errors, each with path and reason: no such folder, no
  /// permission, a folder of that name, another process that writes the same file.
  static Result<OutputFile> open(const std::string& path, std::string_view what);
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;
  /// Without `commit` the part is removed, unless `keep_part` was called.
  ~OutputFile();

  /// Appends. Error: the disk is full or gone; the part then ends with the last whole line that was written.
  Status write(std::string_view text);
  /// Closes and renames. Error: as `write`; the old file stays.
  Status commit();
  /// From here on a file that is not committed leaves its part.
  void keep_part() noexcept { keep_part_ = true; }

  const std::string& path() const noexcept { return path_; }
  /// What `commit` renames, and to what; both empty where the file is written directly.
  const std::string& part() const noexcept { return part_; }
  const std::string& target() const noexcept { return target_; }
  /// -1 once it is closed. For programs that write into it, and for signal handlers.
  int descriptor() const noexcept { return fd_; }

 private:
  OutputFile() = default;
  Error failed(int error) const;
  void abandon() noexcept;

  std::string path_, what_, part_, target_;
  int fd_ = -1;
  bool keep_part_ = false;
};

/// Opens, writes and commits.
Status write_whole_file(const std::string& path, std::string_view what, std::string_view text);

}  // namespace tandem::hal
