// Shared objects, fed with anything that a file may hold.
//
// Two uses of one input: its bytes as a file; and its bytes written over places of a whole small one, so that most
// files are nearly right. The promises: no crash, no undefined behaviour; what is understood is bounded and readable,
// and what is not has a message.
#include "hal/plugin_note.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <elf.h>
#include <vector>

namespace {

using namespace tandem::hal;

#if __SIZEOF_POINTER__ == 8
using Header = Elf64_Ehdr;
using Segment = Elf64_Phdr;
#else
using Header = Elf32_Ehdr;
using Segment = Elf32_Phdr;
#endif

void expect(bool condition) {
  if (!condition) std::abort();
}

void read(const std::vector<std::byte>& file) {
  const auto note = parse_plugin_note(file);
  if (!note.ok()) return expect(!note.error().message.empty());
  expect(note.value().surfaces.size() <= 1000);
  for (const Surface& s : note.value().surfaces) expect(!s.name.empty() && s.name.size() <= 24);
  (void)misfit(note.value(), note.value().surfaces);
}

void append(std::vector<std::byte>& file, const void* from, std::size_t size) {
  const auto* bytes = static_cast<const std::byte*>(from);
  file.insert(file.end(), bytes, bytes + size);
}

void append_note(std::vector<std::byte>& file, std::uint32_t type, std::uint32_t size) {
  const std::uint32_t words[] = {7, size, type};
  append(file, words, sizeof words);
  append(file, "Tandem\0", 8);
  for (std::uint32_t i = 0; i < size; ++i) file.push_back(static_cast<std::byte>('a' + i % 26));
}

/// A header, two segments, and notes of both types.
std::vector<std::byte> whole_file() {
  Header header{};
  std::memcpy(header.e_ident, ELFMAG, SELFMAG);
  header.e_ident[EI_CLASS] = __SIZEOF_POINTER__ == 8 ? ELFCLASS64 : ELFCLASS32;
  header.e_ident[EI_DATA] = ELFDATA2LSB;
  header.e_type = ET_DYN;
#if defined(__x86_64__)
  header.e_machine = EM_X86_64;
#elif defined(__aarch64__)
  header.e_machine = EM_AARCH64;
#elif defined(__arm__)
  header.e_machine = EM_ARM;
#endif
  header.e_phoff = sizeof(Header);
  header.e_phentsize = sizeof(Segment);
  header.e_phnum = 2;
  std::vector<std::byte> notes;
  append_note(notes, detail::kBuildNote, 24);
  append_note(notes, detail::kSurfaceNote, 40);
  append_note(notes, detail::kSurfaceNote, 40);
  Segment segments[2] = {};
  segments[0].p_type = PT_LOAD;
  segments[1].p_type = PT_NOTE;
  segments[1].p_offset = sizeof header + sizeof segments;
  segments[1].p_filesz = notes.size();
  segments[0].p_filesz = segments[1].p_offset + notes.size();
  std::vector<std::byte> file;
  append(file, &header, sizeof header);
  append(file, segments, sizeof segments);
  append(file, notes.data(), notes.size());
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::byte> bytes(size);
  if (size > 0) std::memcpy(bytes.data(), data, size);
  read(bytes);

  static const std::vector<std::byte> kWhole = whole_file();
  expect(parse_plugin_note(kWhole).ok());
  std::vector<std::byte> file = kWhole;
  for (std::size_t i = 0; i + 2 < size && i < 60; i += 3) {  // place, value
    const std::size_t at = (std::size_t{data[i]} | std::size_t{data[i + 1]} << 8) % file.size();
    file[at] = static_cast<std::byte>(data[i + 2]);
  }
  if (size > 3) file.resize(file.size() - std::min<std::size_t>(file.size(), data[size - 1] % 64U));
  read(file);
  return 0;
}
