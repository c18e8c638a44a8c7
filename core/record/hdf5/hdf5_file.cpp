#include "core/record/hdf5/hdf5_file.hpp"

#include <dlfcn.h>
#include <filesystem>

#include "hal/library_folder.hpp"

namespace tandem::core {

hal::Result<std::unique_ptr<Hdf5File>> Hdf5File::create(const std::string& path) {
  const std::filesystem::path library = hal::library_folder() / "hdf5" / "libtandem_hdf5.so";
  void* const loaded = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  void* const symbol = loaded != nullptr ? dlsym(loaded, "tandem_hdf5_create") : nullptr;
  if (symbol == nullptr) {
    const char* const why = dlerror();
    return hal::Error{"the library for HDF5 files does not load: " + std::string(why != nullptr ? why : "unknown") +
                      "; --csv needs none"};
  }
  std::unique_ptr<Hdf5File> file;
  std::string error;
  const auto call = reinterpret_cast<bool (*)(const std::string&, std::unique_ptr<Hdf5File>&, std::string&)>(symbol);
  if (!call(path, file, error)) return hal::Error{error};
  return file;
}

}  // namespace tandem::core
