// `tandem plugin new`: a folder with a plug-in to begin with, made from one of the examples.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fmt/format.h>

#include "app/command/command.hpp"
#include "app/lab/plugin_templates.hpp"
#include "app/module/module_table.hpp"
#include "app/process/terminal.hpp"
#include "hal/output_file.hpp"

namespace tandem::app {
namespace {

namespace fs = std::filesystem;

/// An example, and the names that it registers: a new plug-in has names of its own for them.
struct Kind {
  std::string_view name;
  std::string_view example;
  std::string_view what;
  std::array<std::string_view, 4> registers;
};
constexpr std::array<Kind, 11> kKinds = {{
    {"device",
     "temperature",
     "a field, a sensor of it, a robot with that sensor, and a controller",
     {"temperature", "thermometer", "gardener", "seek_warmth"}},
    {"actuator",
     "lift",
     "an actuator with state that physics knows, its robot, and a controller",
     {"lift", "lifting", "porter", "carry"}},
    {"controller", "waltz", "a controller", {"waltz"}},
    {"hook", "doorman", "a hook", {"doorman"}},
    {"engine", "river", "a physics engine", {"river"}},
    {"medium", "chirp", "a medium, what speaks and hears in it, and a controller", {"chirps", "chirper", "gather"}},
    {"observer", "spread", "an observer", {"spread"}},
    {"part", "stillness", "a part that joins runs", {"stillness"}},
    {"layer", "crowd", "a layer with a panel", {"crowd"}},
    {"bridge",
     "buggy",
     "a robot with its bridge, its stopper, its emulator, and a controller",
     {"buggy", "buggy_puppet", "patrol"}},
    {"command", "census", "a command of `tandem`", {"census"}},
}};

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// Names must do for files, targets, XML elements and namespaces.
bool usable(const std::string& name) {
  constexpr std::size_t kLongest = 40;
  constexpr std::array<std::string_view, 6> kTargets = {"all", "clean", "help", "install", "package", "test"};
  const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && name.size() <= kLongest && name.front() >= 'a' && name.front() <= 'z' &&
         std::all_of(name.begin(), name.end(), fits) &&
         std::find(kTargets.begin(), kTargets.end(), name) == kTargets.end();
}

/// The example's text with the names of the new plug-in.
std::string renamed(std::string_view text, const Kind& kind, const std::string& name) {
  std::string out(text);
  const std::string example(kind.example);
  replace_all(out, "lib" + example, "lib" + name);
  for (const std::string ending : {".csv", ".hpp"}) replace_all(out, "\"" + example + ending, "\"" + name + ending);
  const bool alone = kind.registers[1].empty() || kind.name == "bridge";  // what it registers has the plug-in's name
  for (const std::string_view word : kind.registers) {
    if (word.empty()) continue;
    const std::string from(word);
    const std::string to = alone && from == example ? name : name + "_" + from;
    replace_all(out, "\"" + from + "\"", "\"" + to + "\"");
    for (const char* end : {" ", "/", ">"}) {
      replace_all(out, "<" + from + end, "<" + to + end);
      replace_all(out, "</" + from + end, "</" + to + end);
    }
  }
  return out;
}

std::string cmake_of(const std::string& name, const std::string& sources) {
  return fmt::format(
      R"(# cmake -B build -DTandem_DIR=<checkout of Tandem>/cmake && cmake --build build && ctest --test-dir build
cmake_minimum_required(VERSION 3.25)
project({0} LANGUAGES CXX)
find_package(Tandem REQUIRED)
enable_testing()

tandem_plugin(NAME {0} SOURCES {1})

add_test(NAME runs COMMAND ${{Tandem_PROGRAM}} run ${{CMAKE_CURRENT_SOURCE_DIR}}/{0}.xml --quiet
  WORKING_DIRECTORY ${{CMAKE_CURRENT_BINARY_DIR}})
add_test(NAME conforms COMMAND ${{Tandem_PROGRAM}} plugin check $<TARGET_FILE:{0}>)
set_tests_properties(runs PROPERTIES ENVIRONMENT TANDEM_PLUGIN_PATH=${{CMAKE_BINARY_DIR}}/..)
)",
      name, sources);
}

std::string readme_of(const std::string& name, const Kind& kind) {
  return fmt::format(R"(# {0}

A plug-in for Tandem: {1}.

```sh
cmake -B build -DTandem_DIR=~/tandem/cmake      # where Tandem is checked out, or installed: PREFIX/lib/cmake/Tandem
cmake --build build
ctest --test-dir build --output-on-failure
~/tandem/tandem run {0}.xml
~/tandem/tandem plugin check build/lib{0}.so
```

`docs/plugins.md` of Tandem explains what is in the sources.
)",
                     name, kind.what);
}

constexpr std::string_view kWorkflow = R"(# Builds the plug-in against Tandem, runs its experiment and judges it.
# The repository variable TANDEM_REPOSITORY says where Tandem is, as OWNER/NAME.
name: build
on: [push, pull_request]
jobs:
  build:
    runs-on: ubuntu-latest
    container: debian:12
    steps:
      - uses: actions/checkout@v4
      - uses: actions/checkout@v4
        with:
          repository: ${{ vars.TANDEM_REPOSITORY }}
          path: tandem
      - run: apt-get update && apt-get install -y --no-install-recommends git
      - run: ./tandem/tandem build --yes tandem
        env: { CI: true }
      - run: cmake -B build -DTandem_DIR=$PWD/tandem/cmake
      - run: cmake --build build
      - run: ctest --test-dir build --output-on-failure
)";

std::vector<std::string> plugin_kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

struct PluginNewOptions {
  std::string name;
  std::string kind = "device";

  void describe(hal::CommandLine& line) {
    line.word("name", name, "Of the folder and the library: a to z, 0 to 9 and _").required();
    line.option("--kind", kind, "What it begins with").show_default().one_of(plugin_kinds());
  }
};

int plugin_new(const PluginNewOptions& options) {
  const std::string& name = options.name;
  if (!usable(name))
    return complain(kWrongUsage, fmt::format("'{}' is no name for a plug-in: it begins with a letter, has letters a to "
                                             "z, digits and _, at most 40, and is no target of CMake's own",
                                             name));
  const auto kind = std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& k) { return k.name == options.kind; });
  if (kind == kKinds.end()) return complain(kWrongUsage, "there is no kind '" + options.kind + "'");
  const fs::path folder = name;
  std::error_code error;
  if (fs::exists(fs::symlink_status(folder, error)))
    return complain(kBadInput, fmt::format("'{}' is there already; choose another name, or take it away", name));

  std::vector<std::pair<fs::path, std::string>> files;
  std::string sources;
  for (const hal::CarriedFile& file : plugin_templates()) {
    const bool own = file.name.starts_with(kind->example) &&
                     (file.name[kind->example.size()] == '.' || file.name[kind->example.size()] == '_');
    if (!own) continue;
    const std::string path = name + std::string(file.name.substr(kind->example.size()));
    files.emplace_back(path, renamed(file.text, *kind, name));
    if (path.ends_with(".cpp")) sources += (sources.empty() ? "" : " ") + path;
  }
  files.emplace_back("CMakeLists.txt", cmake_of(name, sources));
  files.emplace_back("README.md", readme_of(name, *kind));
  files.emplace_back(".gitignore", "build/\n");
  files.emplace_back(fs::path(".github") / "workflows" / "build.yml", std::string(kWorkflow));

  fs::create_directories(folder / ".github" / "workflows", error);
  if (error) return complain(kBadInput, fmt::format("cannot make the folder '{}': {}", name, error.message()));
  for (const auto& [path, text] : files) {
    const hal::Status written = hal::write_whole_file((folder / path).string(), "plug-in", text);
    if (!written.ok()) return complain(kFailedRunning, written.error().message);
  }
  fmt::print(
      "{}: {}. Then:\n  cd {}\n  cmake -B build -DTandem_DIR=…/cmake && cmake --build build && ctest "
      "--test-dir build\n",
      name, kind->what, name);
  return kDone;
}

}  // namespace

constinit const hal::CommandType plugin_new_command = module_command<PluginNewOptions, plugin_new>("plugin new");

}  // namespace tandem::app
