// How fast Python drives worlds.
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <unistd.h>

#include "bench/bench.hpp"

namespace tandem::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = R"(import sys
try:
    from tandem.bench import main
except ImportError as error:
    print(f"tandem bench: {sys.executable} has no module tandem, which ./tandem bench python of Tandem's sources builds, "
          f"and the package python3-tandem has: {error}", file=sys.stderr)
    sys.exit(3)
sys.exit(main())
)";

/// The module that was built with this program comes before others.
void put_built_module_on_path() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path built = program.parent_path().parent_path() / "python";
  if (error || !fs::exists(built / "tandem" / "_tandem.so", error)) return;
  const char* const before = std::getenv("PYTHONPATH");
  const std::string path = built.string() + (before == nullptr || *before == '\0' ? "" : ":" + std::string(before));
  setenv("PYTHONPATH", path.c_str(), 1);
}

}  // namespace

/// Returns only where there is no Python to become.
hal::Result<int> bench_python(const Call& call) {
  put_built_module_on_path();
  const char* const named = std::getenv("TANDEM_PYTHON");
  const std::string python = named == nullptr || *named == '\0' ? "/usr/bin/python3" : named;
  const BenchOptions& o = call.options;
  std::vector<std::string> words = {
      python, "-c", kProgram, "--ticks", std::to_string(o.ticks), "--runs", std::to_string(o.repeat_or(600))};
  if (!o.robots.empty()) words.emplace_back("--robots");
  for (const std::int64_t n : o.robots) words.push_back(std::to_string(n));
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  execvp(python.c_str(), argv.data());
  return hal::Error{"cannot start '" + python + "': " + std::strerror(errno) +
                    "; TANDEM_PYTHON names the Python that the module was built for"};
}

}  // namespace tandem::bench
