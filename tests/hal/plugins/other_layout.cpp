// As if built with another standard library.
#include "hal/plugin.hpp"

namespace {
void register_all(tandem::hal::Registrar&) {}
}  // namespace

extern "C" __attribute__((visibility("default"))) const tandem::hal::PluginInfo tandem_plugin;
const tandem::hal::PluginInfo tandem_plugin = {tandem::hal::kPluginMagic, tandem::hal::kAbiNumber,
                                               tandem::hal::border_layout() + 1, "some compiler", &register_all};
