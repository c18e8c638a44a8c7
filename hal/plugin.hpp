// Plug-ins: what a shared object exports.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/catalog.hpp"
#include "hal/controller.hpp"

namespace tandem::hal {

/// Table that a plug-in exports under the name `tandem_plugin`. Begins with its size; members are only ever appended.
struct PluginInfo {
  std::uint32_t size = sizeof(PluginInfo);
  void (*register_all)(Registrar&) = nullptr;
};

/// The border itself: a surface that every plug-in uses.
struct Border {
  static constexpr std::string_view kCategory = "plug-in";
  static constexpr std::uint32_t kNumber = 7;
  using Crosses = Layouts<PluginInfo, Registrar, CatalogItem, Surface, std::size_t, std::string, std::string_view,
                          std::vector<int>, std::shared_ptr<void>, std::function<void()>>;
};

}  // namespace tandem::hal

/// Exports `register_function(tandem::hal::Registrar&)` from a shared object, and writes into it what it was built
/// against. Once a plug-in.
#define TANDEM_PLUGIN(register_function)                                                                     \
  extern "C" __attribute__((visibility("default"))) const tandem::hal::PluginInfo tandem_plugin;             \
  const tandem::hal::PluginInfo tandem_plugin = {sizeof(tandem::hal::PluginInfo),                            \
                                                 [](tandem::hal::Registrar& registrar) {                     \
                                                   tandem::hal::detail::note_build();                        \
                                                   tandem::hal::detail::note_surface<tandem::hal::Border>(); \
                                                   register_function(registrar);                             \
                                                 }};
