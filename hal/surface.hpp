// Surfaces: what two separately built libraries must agree about for the entries of one category of the catalog.
//
// A surface has a number, raised by hand when the meaning of what crosses changes, and a digest of the layouts that
// cross with its entries, which changes by itself. `Registrar::add` writes the surface of what it adds into the object
// file, into the section .note.tandem, so that a program can judge a library without running any of it
// (hal/plugin_note.hpp reads what is written here).
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace tandem::hal {

/// Of this program and these headers; raised with the project's version in CMakeLists.txt.
struct Release {
  std::uint32_t major_number = 0, minor_number = 0, patch = 0;
  bool operator==(const Release&) const = default;
};
inline constexpr Release kRelease{0, 1, 0};

namespace detail {
constexpr std::uint64_t mixed(std::uint64_t digest, std::uint64_t value) noexcept {  // FNV-1a, byte by byte
  for (int i = 0; i < 8; ++i) digest = (digest ^ ((value >> (8 * i)) & 0xFFU)) * 1'099'511'628'211ULL;
  return digest;
}
}  // namespace detail

/// The classes that cross the border with a surface's entries: handed to its functions, or read by both sides. One of
/// them may itself be such a list.
template <class... T>
struct Layouts {
  static constexpr std::uint64_t digest() noexcept {
    std::uint64_t all = 14'695'981'039'346'656'037ULL;
    ((all = with<T>(all)), ...);
    return all;
  }

 private:
  template <class Class>
  static constexpr std::uint64_t with(std::uint64_t all) noexcept {
    if constexpr (requires { Class::digest(); })
      return detail::mixed(all, Class::digest());
    else
      return detail::mixed(detail::mixed(all, sizeof(Class)), alignof(Class));
  }
};

/// One surface, as one side knows it. Both sides have the same name, number and digest; a table may be shorter where
/// the plug-in was built before something was appended to it.
struct Surface {
  static constexpr std::size_t kLongestName = 23;

  std::string name;          ///< the category: "device"
  std::uint32_t number = 0;  ///< of `T::kNumber`
  std::uint64_t digest = 0;  ///< of `T::Crosses`
  std::uint32_t size = 0;    ///< of the table, in bytes
  bool operator==(const Surface&) const = default;
};

/// Of entries of class `T`: its category, and, where it says so, `static constexpr std::uint32_t kNumber` (else 1) and
/// `using Crosses = Layouts<…>`. Members are only ever appended to `T`, and zero says that there is no such; anything
/// else raises `kNumber`. A class that cannot be copied byte by byte says `static constexpr bool kWhole = true`: its
/// size is part of its form.
template <class T>
struct SurfaceOf {
  static constexpr std::string_view kName = T::kCategory;
  static constexpr std::uint32_t kNumber = [] {
    if constexpr (requires { T::kNumber; })
      return std::uint32_t{T::kNumber};
    else
      return std::uint32_t{1};
  }();
  static constexpr std::uint64_t kDigest = [] {
    std::uint64_t digest = Layouts<>::digest();
    if constexpr (requires { typename T::Crosses; }) digest = T::Crosses::digest();
    if constexpr (requires { T::kWhole; }) digest = detail::mixed(digest, sizeof(T));
    return detail::mixed(digest, alignof(T));
  }();
  static constexpr std::uint32_t kSize = sizeof(T);
  static_assert(kName.size() <= Surface::kLongestName);

  static Surface value() { return {std::string(kName), kNumber, kDigest, kSize}; }
};

namespace detail {
// The form of the notes, which never changes: ELF notes of the owner "Tandem" in words of 4 bytes.
inline constexpr std::uint32_t kBuildNote = 1;    ///< release, standard library, then the compiler's own words
inline constexpr std::uint32_t kSurfaceNote = 2;  ///< number, digest (low, high), size of the table, name of 24 bytes

template <std::uint32_t kValue>
struct Word {
  static constexpr std::uint32_t value = kValue;
};

/// Four characters of a name as they lie in memory.
template <class T, std::size_t kIndex>
constexpr std::uint32_t name_word() noexcept {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t at = 4 * kIndex + i;
    const std::uint32_t c = at < SurfaceOf<T>::kName.size() ? static_cast<unsigned char>(SurfaceOf<T>::kName[at]) : 0U;
    word |= c << (__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__ ? 8 * i : 24 - 8 * i);
  }
  return word;
}

/// Name and form of the standard library.
constexpr std::uint32_t standard_library() noexcept {
  std::uint32_t form = 0;
#ifdef __GLIBCXX__
  form |= 1U;
#if _GLIBCXX_USE_CXX11_ABI
  form |= 2U;
#endif
#ifdef _GLIBCXX_DEBUG
  form |= 4U;
#endif
#else
  form |= 8U;
#endif
  return form;
}

/// Writes the surface of `T` into the object file that calls this. Costs nothing when it runs.
template <class T>
inline void note_surface() noexcept {
  using S = SurfaceOf<T>;
  asm volatile(
      ".pushsection .note.tandem,\"a\",%%note\n\t"
      ".balign 4\n\t"
      ".4byte 7, 40, %c0\n\t"
      ".asciz \"Tandem\"\n\t"
      ".balign 4\n\t"
      ".4byte %c1, %c2, %c3, %c4, %c5, %c6, %c7, %c8, %c9, %c10\n\t"
      ".popsection" ::"i"(Word<kSurfaceNote>::value),
      "i"(Word<S::kNumber>::value), "i"(Word<static_cast<std::uint32_t>(S::kDigest)>::value),
      "i"(Word<static_cast<std::uint32_t>(S::kDigest >> 32)>::value), "i"(Word<S::kSize>::value),
      "i"(Word<name_word<T, 0>()>::value), "i"(Word<name_word<T, 1>()>::value), "i"(Word<name_word<T, 2>()>::value),
      "i"(Word<name_word<T, 3>()>::value), "i"(Word<name_word<T, 4>()>::value), "i"(Word<name_word<T, 5>()>::value));
}

/// Writes what built the object file that calls this.
inline void note_build() noexcept {
  asm volatile(
      ".pushsection .note.tandem,\"a\",%%note\n\t"
      ".balign 4\n\t"
      ".4byte 7, 8f - 7f, %c0\n\t"
      ".asciz \"Tandem\"\n\t"
      ".balign 4\n"
      "7:\n\t"
      ".4byte %c1, %c2, %c3, %c4\n\t"
#ifdef __clang__
      ".asciz \"" __VERSION__
      "\"\n\t"
#else
      ".asciz \"GCC " __VERSION__
      "\"\n\t"
#endif
      ".balign 4\n"
      "8:\n\t"
      ".popsection" ::"i"(Word<kBuildNote>::value),
      "i"(Word<kRelease.major_number>::value), "i"(Word<kRelease.minor_number>::value),
      "i"(Word<kRelease.patch>::value), "i"(Word<standard_library()>::value));
}
}  // namespace detail

}  // namespace tandem::hal
