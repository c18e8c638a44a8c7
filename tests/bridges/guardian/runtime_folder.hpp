// A folder for locks that no other test uses.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>

namespace tandem::bridges::guardian {

/// As long as it lives, locks are made here.
class RuntimeFolder {
 public:
  RuntimeFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "guardian_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
    ::setenv("XDG_RUNTIME_DIR", path_.c_str(), 1);
  }
  /// A guardian that outlives its hub may still be writing here: what it leaves behind then stays.
  ~RuntimeFolder() {
    std::error_code error;
    for (int i = 0; i < 100 && std::filesystem::exists(path_, error); ++i) std::filesystem::remove_all(path_, error);
  }
  RuntimeFolder(const RuntimeFolder&) = delete;
  RuntimeFolder& operator=(const RuntimeFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace tandem::bridges::guardian
