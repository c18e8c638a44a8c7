#include "hal/library_folder.hpp"

#include <dlfcn.h>

namespace tandem::hal {

namespace fs = std::filesystem;

namespace {

/// The file of the shared object that this code is part of; empty: it is part of the program.
fs::path own_library() {
  Dl_info here{};
  if (dladdr(reinterpret_cast<const void*>(&library_folder), &here) == 0 || here.dli_fname == nullptr) return {};
  const fs::path file = here.dli_fname;
  return file.filename().string().find(".so") != std::string::npos ? file : fs::path();
}

}  // namespace

fs::path library_folder() {
  std::error_code error;
  if (const fs::path library = own_library(); !library.empty()) {
    for (const char* folder : {"tandem", "lib"}) {
      const fs::path beside = library.parent_path() / folder;
      if (fs::is_directory(beside, error)) return beside;
    }
    return library.parent_path();
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const fs::path folder = program.parent_path().parent_path() / "lib";
  const fs::path installed = folder / "tandem";
  return fs::is_directory(installed, error) ? installed : folder;
}

}  // namespace tandem::hal
