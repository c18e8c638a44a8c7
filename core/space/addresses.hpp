// Addresses of this process: which words may be some, and which objects of the program lie there.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tandem::core {

/// The program, or a library that it has loaded, where it lies in memory.
struct LoadedObject {
  std::string identity;  ///< name of its file and build id [elf(5), NT_GNU_BUILD_ID]: the same in every process
  std::uint64_t begin = 0, past = 0;
};
/// The program is the first.
std::vector<LoadedObject> loaded_objects();

/// The memory that this process can read at present [proc(5), /proc/self/maps]: a word that lies in it may be an
/// address.
class Addresses {
 public:
  Addresses();
  static constexpr std::uint64_t kLeast = 0x10000, kMost = 0x7fff'ffff'ffffULL;
  bool may_be(std::uint64_t word) const noexcept { return word >= kLeast && word <= kMost && lies_in_memory(word); }

 private:
  bool lies_in_memory(std::uint64_t word) const noexcept;

  struct Range {
    std::uint64_t begin, past;
  };
  std::vector<Range> ranges_;  // in rising order
};

}  // namespace tandem::core
