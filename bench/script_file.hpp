// The script of `tandem bench lua`, in a file while that runs: what ARGoS' users write for diffusion, with globals and
// locals of the file that differ from robot to robot.
#pragma once
#include <string>

namespace tandem::bench {

class ScriptFile {
 public:
  ScriptFile();
  ~ScriptFile();
  ScriptFile(const ScriptFile&) = delete;
  ScriptFile& operator=(const ScriptFile&) = delete;

  /// Empty: it could not be written.
  const std::string& path() const noexcept { return path_; }

 private:
  std::string path_;
};

}  // namespace tandem::bench
