#include "app/pictures/register.hpp"

#include "app/command/command.hpp"
#include "app/command/listing.hpp"
#include "app/pictures/pictures_part.hpp"
#include "app/run/run_module.hpp"
#include "core/view/layers/layer.hpp"
#include "core/view/layers/layers.hpp"

namespace tandem::app {
namespace {

/// A layer, and what of it there is to see.
bool describe_layer(const hal::Catalog& catalog, const std::string& name) {
  const auto* const type = catalog.find<core::LayerType>(name);
  if (type == nullptr) return false;
  const std::string_view shows = type->draws ? (type->panels ? "a drawing and a panel" : "a drawing") : "a panel";
  fmt::print("layer {}: {}{}\n  shows {}{}\n", name, printable(type->summary), from(catalog, type), shows,
             type->draws ? "; in pictures: --picture-layers " + name : "");
  return true;
}

constexpr Listing kLayers = {"layers", [](const hal::Catalog& c) { list_entries<core::LayerType>(c, "layers"); },
                             &describe_layer};
constexpr RunModule kPictures = {"pictures", &picture_files, nullptr, &open_pictures, &add_pictures};

}  // namespace

void register_pictures(hal::Registrar& registrar) {
  core::register_layers(registrar);
  registrar.add(picture_command);
  registrar.add(film_command);
  registrar.add(kLayers);
  registrar.add(kPictures);
}

}  // namespace tandem::app
