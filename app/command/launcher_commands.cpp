#include "app/command/launcher_commands.hpp"

#include <array>
#include <string>

namespace tandem::app {
namespace {

/// All that the launcher is told: an option or two of its own, and words for what it calls.
struct Launcher {
  std::string preset;
  bool yes = false;
  std::vector<std::string> words;

  void describe_own(hal::CommandLine& line) {
    line.option("--preset", preset, "What is built: release, or for debugging, sanitizers or robots' boards")
        .one_of({"release", "debug", "asan", "tsan", "armel", "arm64"});
    line.flag("--yes", yes, "Install missing packages without asking");
  }
};

struct Build : Launcher {
  void describe(hal::CommandLine& line) {
    line.word("target", words, "What to build; default: all");
    describe_own(line);
  }
};

struct Test : Launcher {
  void describe(hal::CommandLine& line) {
    line.footer("Further options are those of ctest.");
    describe_own(line);
  }
};

struct Docs : Launcher {
  void describe(hal::CommandLine& line) { line.word("folder", words, "Where to; default: build/docs").folder(); }
};

struct Format : Launcher {
  bool check = false;
  void describe(hal::CommandLine& line) { line.flag("--check", check, "Only say which files differ"); }
};

struct Package : Launcher {
  void describe(hal::CommandLine& line) {
    line.word("folder", words, "Where to; default: build/release/packages").folder();
  }
};

struct Python : Launcher {
  bool wheel = false;
  void describe(hal::CommandLine& line) {
    line.flag("--wheel", wheel, "Make a wheel of the package tandem, in this folder");
    line.word("file", words, "As Python takes them: a script and its words").file();
  }
};

hal::Result<int> run_nothing(const Launcher& /*unused*/) {
  return hal::Error{"this is a command of the launcher at the top of a checkout"};
}

constexpr std::string_view kGroup = "Launcher";

constexpr std::array<hal::CommandType, 6> kCommands = {
    hal::command_type<Build, run_nothing>("build", "Only build.", kGroup),
    hal::command_type<Docs, run_nothing>("docs", "Make the documentation a site that can be searched.", kGroup),
    hal::command_type<Format, run_nothing>("format", "Rewrite every source file in the project's style.", kGroup),
    hal::command_type<Package, run_nothing>("package", "Make Debian packages.", kGroup),
    hal::command_type<Python, run_nothing>("python", "Run the machine's Python with `import tandem`.", kGroup),
    hal::command_type<Test, run_nothing>("test", "Build and run the whole test suite.", kGroup),
};

}  // namespace

std::span<const hal::CommandType> launcher_commands() {
  return kCommands;
}

}  // namespace tandem::app
