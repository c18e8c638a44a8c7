#include "app/build_info.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gnu/libc-version.h>
#include <link.h>
#include <sys/utsname.h>

#include "hal/plugin_note.hpp"

extern const char* const kTandemCommit;  // written by every build: cmake/write_commit.cmake

namespace tandem::app {
namespace {

namespace fs = std::filesystem;

/// As Linux names it; boards' kernels have other words for it than desktops'.
std::string processor_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    for (const char* key : {"model name", "Processor", "cpu model", "Hardware"}) {
      if (!line.starts_with(key)) continue;
      const std::size_t begin = line.find_first_not_of(" \t", colon + 1);
      if (begin != std::string::npos) return line.substr(begin);
    }
  }
  utsname name{};
  return uname(&name) == 0 ? name.machine : "unknown";
}

std::string system_name() {
  utsname name{};
  const std::string kernel =
      uname(&name) == 0 ? std::string(name.sysname) + " " + name.release + " " + name.machine : "unknown";
  return kernel + ", glibc " + gnu_get_libc_version();
}

int note_library(dl_phdr_info* info, std::size_t /*size*/, void* out) {
  const std::string path = info->dlpi_name == nullptr ? "" : info->dlpi_name;
  if (path.find(".so") == std::string::npos) return 0;
  std::error_code error;
  const fs::path file = fs::canonical(path, error);  // libode.so.8 -> libode.so.8.1.0
  const std::string name = fs::path(path).filename().string();
  auto& all = *static_cast<std::vector<std::pair<std::string, std::string>>*>(out);
  all.emplace_back(name.substr(0, name.find(".so")), error ? path : file.string());
  return 0;
}

}  // namespace

const BuildInfo& build_info() {
  static const BuildInfo info = [] {
    BuildInfo b;
    b.version = hal::to_text(hal::kRelease);
    b.commit = kTandemCommit;
#ifdef __clang__
    b.compiler = "Clang " __clang_version__;
#else
    b.compiler = "GCC " __VERSION__;
#endif
    b.build = TANDEM_BUILD;
    b.processor = processor_name();
    b.system = system_name();
    b.compiled_in = {TANDEM_HEADER_LIBRARIES};
    dl_iterate_phdr(&note_library, &b.shared);
    std::sort(b.shared.begin(), b.shared.end());
    return b;
  }();
  return info;
}

std::string version_text() {
  const BuildInfo& info = build_info();
  if (info.commit.empty()) return info.version;
  return info.version + " (" + info.commit.substr(0, 12) +
         (info.commit.find(' ') != std::string::npos ? ", with changes" : "") + ")";
}

hal::Json to_json(const BuildInfo& info) {
  hal::Json json{{"version", info.version}, {"commit", info.commit},       {"compiler", info.compiler},
                 {"build", info.build},     {"processor", info.processor}, {"system", info.system}};
  hal::Json& libraries = json["libraries"] = hal::Json::object();
  for (const auto& [name, version] : info.compiled_in) libraries[name] = version;
  for (const auto& [name, file] : info.shared) libraries[name] = file;
  return json;
}

}  // namespace tandem::app
