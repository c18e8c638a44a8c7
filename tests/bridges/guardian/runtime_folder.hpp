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
  ~RuntimeFolder() { std::filesystem::remove_all(path_); }
  RuntimeFolder(const RuntimeFolder&) = delete;
  RuntimeFolder& operator=(const RuntimeFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace tandem::bridges::guardian
