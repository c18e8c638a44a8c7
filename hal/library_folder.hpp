// Folder of the libraries that come with this program.
#pragma once
#include <filesystem>

namespace tandem::hal {

/// Beside the program's own folder: lib/tandem where it is installed, else lib, as in a build folder. Where this code
/// is part of a shared object that another program uses: tandem or lib in the folder of that, or else that folder.
/// Empty: the system does not tell where the program is.
std::filesystem::path library_folder();

}  // namespace tandem::hal
