#include "hal/library_folder.hpp"

namespace tandem::hal {

namespace fs = std::filesystem;

fs::path library_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const fs::path folder = program.parent_path().parent_path() / "lib";
  const fs::path installed = folder / "tandem";
  return fs::is_directory(installed, error) ? installed : folder;
}

}  // namespace tandem::hal
