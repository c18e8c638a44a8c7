#include "controllers/lua_controller/sources.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <stdexcept>

#include "hal/input_file.hpp"

namespace tandem::controllers::lua {
namespace {

constexpr std::size_t kLargestScript = std::size_t{64} << 20;

bool in_word(char c) noexcept {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// The texts behind a function's name: `require "a"`, `require("a")`. In a comment, too: one more than there need be.
std::vector<std::string> called_with(std::string_view text, std::string_view function) {
  std::vector<std::string> all;
  for (std::size_t at = text.find(function); at != std::string_view::npos; at = text.find(function, at + 1)) {
    if (at > 0 && in_word(text[at - 1])) continue;
    std::size_t i = at + function.size();
    while (i < text.size() && (std::isspace(static_cast<unsigned char>(text[i])) != 0 || text[i] == '(')) ++i;
    if (i >= text.size() || (text[i] != '"' && text[i] != '\'')) continue;
    const std::size_t end = text.find(text[i], i + 1);
    if (end != std::string_view::npos) all.emplace_back(text.substr(i + 1, end - i - 1));
  }
  return all;
}

/// Files that the text may run, by their names beneath the folder; of several in one list, the first that is there.
std::vector<std::vector<std::string>> named_in(std::string_view text) {
  std::vector<std::vector<std::string>> all;
  for (std::string& module : called_with(text, "require")) {
    std::replace(module.begin(), module.end(), '.', '/');
    all.push_back({module + ".lua", module + "/init.lua"});
  }
  for (std::string& file : called_with(text, "dofile")) all.push_back({std::move(file)});
  return all;
}

}  // namespace

bool read_beneath(const std::string& script, const std::string& name, std::string& path, std::string& text) {
  namespace fs = std::filesystem;
  std::error_code bad;
  const fs::path folder = fs::weakly_canonical(fs::absolute(script, bad).parent_path(), bad);
  const fs::path file = fs::weakly_canonical(folder / name, bad);
  const auto [end, unused] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  if (bad || end != folder.end()) return false;
  auto all = hal::read_whole_file(file, "the script", kLargestScript);
  if (!all.ok()) return false;
  path = name_beneath(script, file.lexically_relative(folder).string());
  text = std::move(all).value();
  return true;
}

std::string name_beneath(std::string_view written, std::string_view name) {
  const std::size_t slash = written.rfind('/');
  return std::string(slash == std::string_view::npos ? std::string_view() : written.substr(0, slash + 1)) +
         std::string(name);
}

std::vector<hal::SourceFile> read_sources(const std::string& path, const std::string& written,
                                          const std::vector<hal::SourceFile>& given) {
  const auto find_in = [](const std::vector<hal::SourceFile>& files, const std::string& name) {
    return std::find_if(files.begin(), files.end(), [&](const hal::SourceFile& file) { return file.name == name; });
  };
  std::vector<hal::SourceFile> files(1);
  if (const auto there = find_in(given, written); there != given.end()) {
    files[0] = {written, path, there->text};
  } else {
    auto text = hal::read_whole_file(path, "cannot read its script", kLargestScript);
    if (!text.ok()) throw std::runtime_error(text.error().message);
    files[0] = {written, path, std::move(text).value()};
  }
  for (std::size_t i = 0; i < files.size(); ++i) {
    for (const std::vector<std::string>& names : named_in(files[i].text)) {
      for (const std::string& name : names) {
        hal::SourceFile file{name_beneath(written, name), name_beneath(path, name), {}};
        if (find_in(files, file.name) != files.end()) break;
        const auto there = find_in(given, file.name);
        if (there != given.end()) {
          file.text = there->text;
        } else if (!read_beneath(path, name, file.path, file.text)) {
          continue;
        }
        files.push_back(std::move(file));
        break;
      }
    }
  }
  return files;
}

}  // namespace tandem::controllers::lua
