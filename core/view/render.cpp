#include "core/view/render.hpp"

#include <dlfcn.h>
#include <filesystem>

#include "hal/library_folder.hpp"

namespace tandem::core {
namespace {

struct Renderer {
  bool (*call)(const std::vector<std::string>& svgs, PictureFormat format, std::string& out);
};

/// The renderer, from the folder of the program's own libraries. It stays loaded.
hal::Result<Renderer> load_renderer() {
  const std::filesystem::path file = hal::library_folder() / "render" / "libtandem_render.so";
  void* const library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  void* const symbol = library != nullptr ? dlsym(library, "tandem_render") : nullptr;
  if (symbol != nullptr) return Renderer{reinterpret_cast<decltype(Renderer::call)>(symbol)};
  const char* const why = dlerror();
  return hal::Error{"the renderer of PNG and PDF pictures does not load: " +
                    std::string(why != nullptr ? why : "unknown reason") + "; .svg needs none"};
}

/// Into `out`, whose memory is used again.
hal::Status render_by_library(const std::vector<std::string>& svgs, PictureFormat format, std::string& out) {
  const auto renderer = load_renderer();
  if (!renderer.ok()) return renderer.error();
  if (!renderer.value().call(svgs, format, out)) return hal::Error{out};
  return {};
}

hal::Result<std::string> render_by_library(const std::vector<std::string>& svgs, PictureFormat format) {
  std::string out;
  if (const hal::Status rendered = render_by_library(svgs, format, out); !rendered.ok()) return rendered.error();
  return out;
}

}  // namespace

hal::Status can_render(PictureFormat format) {
  if (format == PictureFormat::Svg) return {};
  const auto renderer = load_renderer();
  return renderer.ok() ? hal::Status{} : hal::Status{renderer.error()};
}

hal::Result<std::string> render(const std::string& svg, PictureFormat format) {
  return format == PictureFormat::Svg ? hal::Result<std::string>{svg} : render_by_library({svg}, format);
}

hal::Status render_pixels(const std::string& svg, std::string& pixels) {
  return render_by_library({svg}, PictureFormat::Pixels, pixels);
}

hal::Result<std::string> render_pages(const std::vector<std::string>& svgs) {
  return render_by_library(svgs, PictureFormat::Pdf);
}

}  // namespace tandem::core
