#include "app/real/controller_copy.hpp"

#include "app/build_info.hpp"
#include "hal/plugin_note.hpp"
#include "hal/sha256.hpp"

namespace tandem::app {

bridges::peer::ControllerCopy controller_copy(const hal::PluginLoader& loader, const core::ControllerConfig& config,
                                              const hal::ControllerType& type,
                                              const std::vector<hal::SourceFile>& scripts) {
  bridges::peer::ControllerCopy copy;
  copy.label = type.name;
  copy.processor = hal::this_processor();
  copy.release = hal::to_text(hal::kRelease);
  copy.commit = build_info().commit;
  if (const auto file = loader.find(config.library); file.ok()) {
    const auto digest = hal::sha256_of_file(file.value().string());
    copy.library = {file.value().filename().string(), digest.ok() ? digest.value() : ""};
    if (const auto note = hal::read_plugin_note(file.value()); note.ok()) {
      copy.release = hal::to_text(note.value().release);
      for (const hal::Surface& surface : note.value().surfaces) copy.surfaces[surface.name] = surface.number;
    }
  }
  for (const hal::SourceFile& script : scripts) copy.scripts.push_back({script.name, hal::sha256(script.text)});
  return copy;
}

}  // namespace tandem::app
