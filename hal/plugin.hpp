// Plug-ins: what a shared object exports, and the check that both sides were built alike.
#pragma once
#include <cstdint>
#include <string>

#include "hal/catalog.hpp"
#include "hal/controller.hpp"

namespace tandem::hal {

/// Raised whenever a type that crosses the plug-in border changes.
inline constexpr std::uint32_t kAbiNumber = 5;
inline constexpr std::uint32_t kPluginMagic = 0x544E444D;  // "TNDM"

/// The first thing that the loader looks at; its layout never changes.
struct PluginInfo {
  std::uint32_t magic;
  std::uint32_t abi;
  std::uint64_t layout;  ///< sizes of the types that cross the border, mixed
  const char* compiler;  ///< for the message when the rest does not fit
  void (*register_all)(Registrar&);
};

/// Differs between builds whose standard library or settings lay types out differently.
constexpr std::uint64_t border_layout() noexcept {
  return sizeof(std::string) * 1'000'003ULL + sizeof(std::shared_ptr<void>) * 10'007ULL +
         sizeof(ControllerType) * 101ULL + sizeof(PortType) * 7ULL + sizeof(Robot) * 31ULL +
         sizeof(CatalogItem) * 3ULL + sizeof(void*);
}

}  // namespace tandem::hal

/// Exports `register_function(tandem::hal::Registrar&)` from a shared object. Once a plug-in.
#define TANDEM_PLUGIN(register_function)                                                             \
  extern "C" __attribute__((visibility("default"))) const tandem::hal::PluginInfo tandem_plugin;     \
  const tandem::hal::PluginInfo tandem_plugin = {tandem::hal::kPluginMagic, tandem::hal::kAbiNumber, \
                                                 tandem::hal::border_layout(), __VERSION__, &(register_function)};
