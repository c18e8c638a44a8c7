// Reads what a library says of itself, from its file alone: nothing of the library runs.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "hal/result.hpp"
#include "hal/surface.hpp"

namespace tandem::hal {

/// Contents of the section .note.tandem of a shared object.
struct PluginNote {
  Release release;
  std::uint32_t standard_library = 0;  ///< as `detail::standard_library` gives it
  std::string compiler;
  std::vector<Surface> surfaces;  ///< that it uses, the border among them; each once

  bool uses(std::string_view surface) const noexcept;
};

/// Error: it cannot be read, is no shared object, is one for another processor, has no note, or one that is damaged.
/// The message follows the library's name.
Result<PluginNote> read_plugin_note(const std::filesystem::path& file);
/// The same of the bytes of a file, which may be anything.
Result<PluginNote> parse_plugin_note(std::span<const std::byte> file);

/// Why a library with this note cannot be used by a program that knows the surfaces `here`: all that does not fit, what
/// the library has and what there is here. Empty: it can.
std::string misfit(const PluginNote& note, std::span<const Surface> here);

/// The processor that this program was compiled for: "x86-64 with 64 bits".
std::string this_processor();

/// "0.1.0"
std::string to_text(const Release& release);

}  // namespace tandem::hal
