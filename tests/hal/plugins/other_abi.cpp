// As if built against the headers of another release.
#include "hal/plugin.hpp"

namespace {
void register_all(tandem::hal::Registrar&) {}
}  // namespace

extern "C" __attribute__((visibility("default"))) const tandem::hal::PluginInfo tandem_plugin;
const tandem::hal::PluginInfo tandem_plugin = {tandem::hal::kPluginMagic, tandem::hal::kAbiNumber + 1,
                                               tandem::hal::border_layout(), "some compiler", &register_all};
