// Files that a controller runs, such as scripts, as viewers of a run see and change them.
//
// They are the value of a text control (hal/controls.hpp) under a hidden name. A controller that has
// it begins anew, as if it were just made, when the value is changed; it throws where it cannot, and is as before then.
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/controls.hpp"

namespace tandem::hal {

/// The control, which is not listed among those for people.
inline constexpr std::string_view kSourceFilesControl = "*files";

struct SourceFile {
  std::string name;  ///< the same on every machine: as the experiment names it
  std::string path;  ///< that it was read from
  std::string text;
};

/// As one text: "12 19 1042\n" and the three, for each file.
inline std::string packed(const std::vector<SourceFile>& files) {
  std::string all;
  for (const SourceFile& file : files) {
    all += std::to_string(file.name.size()) + " " + std::to_string(file.path.size()) + " " +
           std::to_string(file.text.size()) + "\n" + file.name + file.path + file.text;
  }
  return all;
}

/// Those of a text that `packed` made.
inline std::vector<SourceFile> unpacked(std::string_view all) {
  std::vector<SourceFile> files;
  while (!all.empty()) {
    std::size_t sizes[3] = {};
    for (std::size_t& size : sizes) {
      while (!all.empty() && all.front() >= '0' && all.front() <= '9') {
        size = 10 * size + static_cast<std::size_t>(all.front() - '0');
        all.remove_prefix(1);
      }
      if (!all.empty()) all.remove_prefix(1);
    }
    SourceFile& file = files.emplace_back();
    std::string* const parts[3] = {&file.name, &file.path, &file.text};
    for (std::size_t i = 0; i < 3; ++i) {
      *parts[i] = all.substr(0, sizes[i]);
      all.remove_prefix(parts[i]->size());
    }
  }
  return files;
}

/// Takes the files from the display of its controls.
class SourceFilesTaker : public Controls {
 public:
  /// None: none were shown.
  const std::optional<std::vector<SourceFile>>& files() const noexcept { return files_; }

  bool text(std::string_view name, std::string& value, std::string_view) override {
    if (name == kSourceFilesControl) files_ = unpacked(value);
    return false;
  }
  bool number(std::string_view, double&, const Unit&, Range, std::string_view) override { return false; }
  bool integer(std::string_view, std::int64_t&, Range, std::string_view) override { return false; }
  bool flag(std::string_view, bool&, std::string_view) override { return false; }
  bool choice(std::string_view, std::string&, std::span<const std::string_view>, std::string_view) override {
    return false;
  }
  bool button(std::string_view, std::string_view) override { return false; }

 private:
  std::optional<std::vector<SourceFile>> files_;
};

}  // namespace tandem::hal
