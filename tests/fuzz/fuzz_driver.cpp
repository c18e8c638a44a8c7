// Runs a fuzz target without a fuzzer: the inputs kept in a folder, then a fixed number of generated ones, the same
// ones every time. Arguments: how many, the folder; both may be left out. A file instead of a folder: that input alone.
//
// Input n is made of short runs of random bytes, small numbers and repeats, so that op codes, lengths and texts all
// occur. With a clang build and TANDEM_FUZZ the same entry function is driven by libFuzzer instead.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

/// SplitMix64 [Steele et al. 2014].
std::uint64_t mix(std::uint64_t x) noexcept {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

void make_input(std::uint64_t number, std::vector<std::uint8_t>& input) {
  std::uint64_t random = mix(number);
  const std::size_t size = random % 7 == 0 ? random / 7 % 400 : random / 7 % 60;
  input.clear();
  while (input.size() < size) {
    random = mix(random);
    const std::size_t run = 1 + (random >> 8) % 6;
    for (std::size_t i = 0; i < run && input.size() < size; ++i) {
      const std::uint64_t bits = mix(random + i);
      switch (random % 4) {
        case 0:
          input.push_back(static_cast<std::uint8_t>(bits));
          break;
        case 1:
          input.push_back(static_cast<std::uint8_t>(bits % 12));
          break;
        case 2:
          input.push_back(static_cast<std::uint8_t>(random >> 16));
          break;
        default:
          input.push_back(i % 2 == 0 ? static_cast<std::uint8_t>(bits % 10) : static_cast<std::uint8_t>(bits >> 8));
          break;
      }
    }
  }
}

std::size_t replay(const std::filesystem::path& kept) {
  std::vector<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(kept, none)) files.push_back(entry.path());
  if (std::filesystem::is_regular_file(kept, none)) files.push_back(kept);
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& path : files) {
    std::ifstream in(path, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    std::fprintf(stderr, "%s\n", path.filename().c_str());
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }
  return files.size();
}

}  // namespace

int main(int count, char** arguments) {
  const std::uint64_t inputs = count > 1 ? std::strtoull(arguments[1], nullptr, 10) : 1'000'000;
  if (count > 2) std::printf("%zu kept inputs\n", replay(arguments[2]));
  const char* keep = std::getenv("TANDEM_FUZZ_KEEP");  // a file for each input before it is tried
  std::vector<std::uint8_t> input;
  std::uint64_t bytes = 0;
  for (std::uint64_t i = 0; i < inputs; ++i) {
    make_input(i, input);
    bytes += input.size();
    if (keep != nullptr)  // so that what ends the program can be replayed
      std::ofstream(keep, std::ios::binary)
          .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
    LLVMFuzzerTestOneInput(input.data(), input.size());
  }
  std::printf("%llu inputs, %llu bytes\n", static_cast<unsigned long long>(inputs),
              static_cast<unsigned long long>(bytes));
  return 0;
}
