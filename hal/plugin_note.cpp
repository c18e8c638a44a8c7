#include "hal/plugin_note.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <elf.h>
#include <fcntl.h>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>

namespace tandem::hal {
namespace {

constexpr std::uint64_t kLongestNotes = 1U << 20;  // of one segment, in bytes
constexpr std::size_t kMostSegments = 4096;
constexpr std::size_t kMostSurfaces = 1000;
constexpr std::string_view kOwner{"Tandem", 7};  // with its zero

/// The numbers of an ELF file of this program's own word length.
#if __SIZEOF_POINTER__ == 8
using Header = Elf64_Ehdr;
using Segment = Elf64_Phdr;
constexpr unsigned char kClass = ELFCLASS64;
#else
using Header = Elf32_Ehdr;
using Segment = Elf32_Phdr;
constexpr unsigned char kClass = ELFCLASS32;
#endif

constexpr unsigned kMachine =
#if defined(__x86_64__)
    EM_X86_64;
#elif defined(__i386__)
    EM_386;
#elif defined(__aarch64__)
    EM_AARCH64;
#elif defined(__arm__)
    EM_ARM;
#elif defined(__riscv)
    EM_RISCV;
#else
    EM_NONE;  // the loader of the system judges it alone
#endif
constexpr unsigned char kByteOrder = __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? ELFDATA2LSB : ELFDATA2MSB;

/// A processor in words.
std::string processor(unsigned machine, unsigned char word_class, unsigned char order) {
  std::string name;
  switch (machine) {
    case EM_X86_64:
      name = "x86-64";
      break;
    case EM_386:
      name = "x86";
      break;
    case EM_AARCH64:
    case EM_ARM:
      name = "ARM";
      break;
    case EM_RISCV:
      name = "RISC-V";
      break;
    case EM_MIPS:
      name = "MIPS";
      break;
    case EM_PPC:
    case EM_PPC64:
      name = "PowerPC";
      break;
    default:
      name = "machine " + std::to_string(machine);
  }
  name += word_class == ELFCLASS64 ? " with 64 bits" : " with 32 bits";
  return order == ELFDATA2MSB ? name + ", big-endian" : name;
}

/// Where the bytes of a file come from.
class Source {
 public:
  virtual ~Source() = default;
  virtual std::uint64_t size() const noexcept = 0;
  /// Fills `to`, all of which lies within the file. @returns false when the system fails
  virtual bool read(std::uint64_t at, std::span<std::byte> to) const = 0;

  bool holds(std::uint64_t at, std::uint64_t bytes) const noexcept { return at <= size() && bytes <= size() - at; }
};

class Memory final : public Source {
 public:
  explicit Memory(std::span<const std::byte> bytes) : bytes_(bytes) {}
  std::uint64_t size() const noexcept override { return bytes_.size(); }
  bool read(std::uint64_t at, std::span<std::byte> to) const override {
    if (!to.empty()) std::memcpy(to.data(), bytes_.data() + at, to.size());
    return true;
  }

 private:
  std::span<const std::byte> bytes_;
};

class File final : public Source {
 public:
  explicit File(const std::filesystem::path& path) : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    struct stat state {};
    if (fd_ >= 0 && ::fstat(fd_, &state) == 0 && S_ISREG(state.st_mode))
      size_ = static_cast<std::uint64_t>(std::max<off_t>(0, state.st_size));
  }
  ~File() override {
    if (fd_ >= 0) ::close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  bool open() const noexcept { return fd_ >= 0; }
  std::uint64_t size() const noexcept override { return size_; }
  bool read(std::uint64_t at, std::span<std::byte> to) const override {
    for (std::size_t done = 0; done < to.size();) {
      const ssize_t n = ::pread(fd_, to.data() + done, to.size() - done, static_cast<off_t>(at + done));
      if (n == 0 || (n < 0 && errno != EINTR)) return false;
      if (n > 0) done += static_cast<std::size_t>(n);
    }
    return true;
  }

 private:
  int fd_;
  std::uint64_t size_ = 0;
};

template <class T>
std::optional<T> value_at(const Source& source, std::uint64_t at) {
  T value{};
  if (!source.holds(at, sizeof value)) return std::nullopt;
  if (!source.read(at, std::as_writable_bytes(std::span(&value, 1)))) return std::nullopt;
  return value;
}

std::uint32_t word_at(std::span<const std::byte> bytes, std::size_t at) noexcept {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

/// The characters up to a zero, and only those that people can read.
std::string text_of(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte b : bytes) {
    const char c = static_cast<char>(b);
    if (c == '\0') break;
    text += c < ' ' || c > '~' ? '?' : c;
  }
  return text;
}

/// Takes over one note of ours. @returns false when it is damaged
bool take(std::uint32_t type, std::span<const std::byte> text, PluginNote& note, bool& built) {
  if (type == detail::kBuildNote && text.size() >= 16) {
    const Release release{word_at(text, 0), word_at(text, 4), word_at(text, 8)};
    const std::uint32_t library = word_at(text, 12);
    if (built && (release != note.release || library != note.standard_library)) return false;
    built = true;
    note.release = release;
    note.standard_library = library;
    note.compiler = text_of(text.subspan(16));
    return true;
  }
  if (type == detail::kSurfaceNote && text.size() == 40) {
    const Surface surface{text_of(text.subspan(16)), word_at(text, 0),
                          word_at(text, 4) | std::uint64_t{word_at(text, 8)} << 32, word_at(text, 12)};
    if (surface.name.empty()) return false;
    if (std::find(note.surfaces.begin(), note.surfaces.end(), surface) == note.surfaces.end())
      note.surfaces.push_back(surface);
    return note.surfaces.size() <= kMostSurfaces;
  }
  return false;
}

/// Takes over all of our notes of one segment. @returns false when one is damaged
bool take_all(std::span<const std::byte> segment, PluginNote& note, bool& built) {
  const auto padded = [](std::uint64_t n) { return (n + 3) & ~std::uint64_t{3}; };
  for (std::size_t at = 0; segment.size() - at >= 12;) {
    const std::uint64_t owner = word_at(segment, at), text = word_at(segment, at + 4);
    const std::uint32_t type = word_at(segment, at + 8);
    const std::size_t left = segment.size() - at - 12;
    if (padded(owner) > left || text > left - padded(owner)) return true;  // others' notes may be aligned otherwise
    const auto content = segment.subspan(at + 12);
    if (owner == kOwner.size() && std::memcmp(content.data(), kOwner.data(), kOwner.size()) == 0 &&
        !take(type, content.subspan(static_cast<std::size_t>(padded(owner)), static_cast<std::size_t>(text)), note,
              built))
      return false;
    at += 12 + static_cast<std::size_t>(std::min<std::uint64_t>(padded(owner) + padded(text), left));
  }
  return true;
}

/// Whether names of the namespace `argos` are among the symbols.
bool names_argos(const Source& source) {
  constexpr std::string_view kMangled = "N5argos";
  constexpr std::size_t kPiece = 1U << 16;
  std::vector<std::byte> bytes(kPiece + kMangled.size());
  for (std::uint64_t at = 0; at < source.size(); at += kPiece) {
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), source.size() - at));
    if (!source.read(at, std::span(bytes).first(size))) return false;
    if (std::string_view(reinterpret_cast<const char*>(bytes.data()), size).find(kMangled) != std::string_view::npos)
      return true;
  }
  return false;
}

Error damaged() {
  return Error{"is no whole shared object: it was cut off or damaged; build it again"};
}

Result<PluginNote> parse(const Source& source) {
  std::array<unsigned char, EI_NIDENT> ident{};
  if (!source.holds(0, ident.size()) || !source.read(0, std::as_writable_bytes(std::span(ident))) ||
      std::memcmp(ident.data(), ELFMAG, SELFMAG) != 0)
    return Error{"is no shared object: name the file that the linker made, lib….so"};
  const bool native = ident[EI_CLASS] == kClass && ident[EI_DATA] == kByteOrder;
  const auto header = value_at<Header>(source, 0);
  if (!header) return damaged();
  const unsigned machine =  // stands at the same place in files of 32 and of 64 bits
      ident[EI_DATA] == kByteOrder ? header->e_machine
                                   : static_cast<unsigned>(header->e_machine >> 8 | (header->e_machine & 0xFF) << 8);
  if (!native || (kMachine != EM_NONE && machine != kMachine))
    return Error{"is for another processor (" + processor(machine, ident[EI_CLASS], ident[EI_DATA]) +
                 "); this program runs on " + processor(kMachine, kClass, kByteOrder) + ". Build it for this one"};
  if (header->e_type != ET_DYN) return Error{"is no shared object: name the file that the linker made, lib….so"};
  if (header->e_phentsize != sizeof(Segment) || header->e_phnum == 0 || header->e_phnum > kMostSegments)
    return damaged();

  PluginNote note;
  bool built = false;
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < header->e_phnum; ++i) {
    const std::uint64_t place = std::uint64_t{header->e_phoff} + i * sizeof(Segment);
    if (place < header->e_phoff) return damaged();
    const auto segment = value_at<Segment>(source, place);
    if (!segment) return damaged();
    if (segment->p_type == PT_LOAD && !source.holds(segment->p_offset, segment->p_filesz)) return damaged();
    if (segment->p_type != PT_NOTE) continue;
    if (segment->p_filesz > kLongestNotes || !source.holds(segment->p_offset, segment->p_filesz)) return damaged();
    bytes.resize(static_cast<std::size_t>(segment->p_filesz));
    if (!source.read(segment->p_offset, bytes)) return damaged();
    if (!take_all(bytes, note, built))
      return Error{"has a damaged note .note.tandem; build it again, all of it with one compiler and one Tandem"};
  }
  if (!built && names_argos(source))
    return Error{
        "was built for ARGoS 3, not against Tandem. Build it again: in its build folder, "
        "CMAKE_PREFIX_PATH=PREFIX cmake --fresh …, where PREFIX is lib/tandem of an installation or build/release/lib "
        "of "
        "a checkout; and link it with argos3core_simulator (docs/from-argos-cpp.md)"};
  if (!built)
    return Error{
        "is not a Tandem plug-in, or one of before 0.1.0: it has no note .note.tandem. A plug-in has "
        "TANDEM_PLUGIN(…) in one of its sources (hal/plugin.hpp)"};
  return note;
}

std::string library_text(std::uint32_t form) {
  if ((form & 1U) == 0) return "another standard library than libstdc++";
  std::string text = "libstdc++";
  if ((form & 2U) == 0) text += " with its old strings (_GLIBCXX_USE_CXX11_ABI=0)";
  if ((form & 4U) != 0) text += " in its debug mode (_GLIBCXX_DEBUG)";
  return text;
}

std::string digest_text(std::uint64_t digest) {
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(digest));
  return text.data();
}

/// "device 3 (layout 0123456789abcdef)"
std::string text_of(const Surface& surface) {
  return surface.name + " " + std::to_string(surface.number) + " (layout " + digest_text(surface.digest) + ")";
}

}  // namespace

std::string this_processor() {
  return processor(kMachine, kClass, kByteOrder);
}

bool PluginNote::uses(std::string_view surface) const noexcept {
  return std::any_of(surfaces.begin(), surfaces.end(), [&](const Surface& s) { return s.name == surface; });
}

Result<PluginNote> read_plugin_note(const std::filesystem::path& file) {
  const File source(file);
  if (!source.open()) return Error{std::string("cannot be read: ") + std::strerror(errno)};
  return parse(source);
}

Result<PluginNote> parse_plugin_note(std::span<const std::byte> file) {
  return parse(Memory(file));
}

std::string misfit(const PluginNote& note, std::span<const Surface> here) {
  std::string all;
  const auto add = [&all](const std::string& what) { all += "\n  " + what; };
  if (note.standard_library != detail::standard_library())
    add("it uses " + library_text(note.standard_library) + "; this program uses " +
        library_text(detail::standard_library()));
  for (const Surface& surface : note.surfaces) {
    const auto known = std::find_if(here.begin(), here.end(), [&](const Surface& s) { return s.name == surface.name; });
    if (known == here.end()) {
      add("it uses " + text_of(surface) + "; this program has no such surface");
    } else if (surface.number != known->number || surface.digest != known->digest) {
      add("it uses " + text_of(surface) + "; here is " + text_of(*known));
    } else if (surface.size > known->size) {
      add("it uses " + text_of(surface) + " with a table of " + std::to_string(surface.size) +
          " bytes, as a later release has it; here it has " + std::to_string(known->size));
    }
  }
  if (all.empty()) return all;
  return "was built against Tandem " + to_text(note.release) + " by " + note.compiler +
         " and does not fit this program, which is Tandem " + to_text(kRelease) + ":" + all;
}

std::string to_text(const Release& release) {
  return std::to_string(release.major_number) + "." + std::to_string(release.minor_number) + "." +
         std::to_string(release.patch);
}

}  // namespace tandem::hal
