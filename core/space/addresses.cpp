#include "core/space/addresses.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <link.h>

namespace tandem::core {
namespace {

std::string build_id_in(const char* at, const char* past) {
  constexpr std::size_t kAlign = 4;
  const auto aligned = [](std::size_t n) { return (n + kAlign - 1) / kAlign * kAlign; };
  ElfW(Nhdr) note{};
  while (at + sizeof note <= past) {
    std::memcpy(&note, at, sizeof note);
    const char* const id = at + sizeof note + aligned(note.n_namesz);
    if (note.n_type == NT_GNU_BUILD_ID && note.n_namesz == sizeof "GNU" && id + note.n_descsz <= past)
      return {id, note.n_descsz};
    at = id + aligned(note.n_descsz);
  }
  return {};
}

int add_object(dl_phdr_info* object, std::size_t /*size*/, void* all) {
  LoadedObject found{object->dlpi_name, ~std::uint64_t{0}, 0};
  found.identity.erase(0, found.identity.rfind('/') + 1);
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& part = object->dlpi_phdr[i];
    const std::uint64_t begin = object->dlpi_addr + part.p_vaddr;
    if (part.p_type == PT_LOAD) {
      found.begin = std::min<std::uint64_t>(found.begin, begin);
      found.past = std::max<std::uint64_t>(found.past, begin + part.p_memsz);
    } else if (part.p_type == PT_NOTE) {
      const auto* const notes = reinterpret_cast<const char*>(begin);
      found.identity += build_id_in(notes, notes + part.p_memsz);
    }
  }
  static_cast<std::vector<LoadedObject>*>(all)->push_back(std::move(found));
  return 0;
}

}  // namespace

Addresses::Addresses() {
  constexpr std::uint64_t kLargest = 0x10'0000'0000;  // more is set aside, by a sanitizer say, and given to nobody
  std::ifstream maps("/proc/self/maps");
  Range range{};
  char dash = '-';
  std::string permissions, rest;
  while (maps >> std::hex >> range.begin >> dash >> range.past >> permissions && std::getline(maps, rest))
    if (permissions.front() == 'r' && range.past - range.begin <= kLargest) ranges_.push_back(range);
}

bool Addresses::lies_in_memory(std::uint64_t word) const noexcept {
  const auto behind = std::ranges::upper_bound(ranges_, word, {}, &Range::begin);
  return behind != ranges_.begin() && word < std::prev(behind)->past;
}

std::vector<LoadedObject> loaded_objects() {
  std::vector<LoadedObject> all;
  dl_iterate_phdr(&add_object, &all);
  return all;
}

}  // namespace tandem::core
